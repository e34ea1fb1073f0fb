// SPDX-License-Identifier: GPL-2.0-or-later
// The messages that a program knows, by number and by name (F7, F8).
#pragma once

#include <map>
#include <memory>
#include <string_view>
#include <variant>

#include "base/result.hh"
#include "clients/nml/message/heads.hh"
#include "messages/declarations/command.hh"

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
    int number = 0;
    const char *wire_name = "";  ///< LinuxCNC's name, or empty
    const messages::Declaration *declaration = nullptr;
    Base base = Base::PLAIN;
    std::uint32_t shape = 0;
    std::shared_ptr<void> (*make)() = nullptr;  ///< the body with its default values
    /// The machine's command for a body. Null: the machine has none.
    messages::Command (*convert)(const void *body) = nullptr;
    /// Why the machine rejects the message; its fields are not read. Null: it does not.
    const char *rejection = nullptr;

    const messages::Declaration *head() const;
    /// LinuxCNC's name where it has one.
    const char *name() const { return *wire_name != '\0' ? wire_name : declaration->name; }
};
template <class Body>
std::shared_ptr<void> make_body() {
    return std::make_shared<Body>();
}
template <class Body>
messages::Command convert_body(const void *body) {
    return *static_cast<const Body *>(body);
}

/// A message of any kind.
class Message {
  public:
    explicit Message(const MessageKind &kind);

    const MessageKind &kind() const { return *kind_; }
    int number() const { return kind_->number; }
    MessageView view();
    /// The machine's command; an error with the reason when it has none.
    Result<messages::Command> command() const;

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
    /// LinuxCNC's messages (wire_table.hh), and every other command and numbered status of
    /// src/messages/declarations.
    static Vocabulary standard();

    /// An error when it has no number, or when number or name are taken. Texts show `wire_name` instead
    /// of the name of the declaration.
    template <class Body>
    Result<> add(Base base, const char *wire_name = "") {
        MessageKind kind;
        kind.number = messages::DECLARATION<Body>.number;
        kind.wire_name = wire_name;
        kind.declaration = &messages::DECLARATION<Body>;
        kind.base = base;
        kind.make = make_body<Body>;
        return add(kind);
    }
    Result<> add(MessageKind kind);

    /// Null when there is none. Kinds stay where they are as long as the vocabulary does.
    const MessageKind *find(int number) const;
    const MessageKind *find(std::string_view name) const;
    Result<Message> make(int number) const;
    const std::map<int, MessageKind> &kinds() const { return kinds_; }

  private:
    std::map<int, MessageKind> kinds_;
};

}  // namespace mw::nml
