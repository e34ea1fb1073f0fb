// SPDX-License-Identifier: GPL-2.0-or-later
// The messages that a program knows, by number and by name (F7, F8).
#pragma once

#include <map>
#include <memory>
#include <string_view>
#include <variant>

#include "base/result.hh"
#include "clients/nml/message/heads.hh"
#include "messages/declarations/describe.hh"

namespace mw::nml {

/// A message in parts, wherever they are kept. The parts are changed by reading only.
struct MessageView {
    messages::Object head;
    messages::Object body;
};
template <class Head, class Body>
MessageView view(Head &head, Body &body) {
    return {messages::object(head), messages::object(body)};
}
template <template <class> class Typed, class Body>
MessageView view(Typed<Body> &message) {
    return view(message.head, message.body);
}

/// What a vocabulary knows about one kind of message.
struct MessageKind {
    const messages::Declaration *declaration = nullptr;
    Base base = Base::PLAIN;
    std::uint32_t shape = 0;
    std::shared_ptr<void> (*make)() = nullptr;  ///< the body with its default values

    const messages::Declaration *head() const;
    /// The legacy name where it has one.
    const char *name() const { return *declaration->nml != '\0' ? declaration->nml : declaration->name; }
};

/// A message of any kind.
class Message {
  public:
    explicit Message(const MessageKind &kind);

    const MessageKind &kind() const { return *kind_; }
    int number() const { return kind_->declaration->number; }
    MessageView view();

    /// Null when it is of another kind.
    template <class Body>
    Body *get() {
        return kind_->declaration == &messages::DECLARATION<Body> ? static_cast<Body *>(body_.get())
                                                                  : nullptr;
    }
    CommandHead *command_head() { return std::get_if<CommandHead>(&head_); }
    StatusHead *status_head() { return std::get_if<StatusHead>(&head_); }

  private:
    const MessageKind *kind_;
    std::variant<PlainHead, CommandHead, StatusHead> head_;
    std::shared_ptr<void> body_;
};

class Vocabulary {
  public:
    /// Every command and numbered status of src/messages/declarations.
    static Vocabulary standard();

    /// An error when it has no number or number or name are taken.
    template <class Body>
    Result<> add(Base base) {
        return add({&messages::DECLARATION<Body>, base, 0,
                    []() -> std::shared_ptr<void> { return std::make_shared<Body>(); }});
    }

    /// Null when there is none. Kinds stay where they are as long as the vocabulary does.
    const MessageKind *find(int number) const;
    const MessageKind *find(std::string_view name) const;
    Result<Message> make(int number) const;
    const std::map<int, MessageKind> &kinds() const { return kinds_; }

  private:
    Result<> add(MessageKind kind);

    std::map<int, MessageKind> kinds_;
};

}  // namespace mw::nml
