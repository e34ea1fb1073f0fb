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

/// References to the parts of a message. Only reading changes the parts.
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

/// Data of one type of message in a vocabulary.
struct MessageKind {
    int number = 0;
    const char *wire_name = "";  ///< LinuxCNC's name, or empty
    const messages::Declaration *declaration = nullptr;
    Base base = Base::PLAIN;
    std::uint32_t shape = 0;
    std::shared_ptr<void> (*make)() = nullptr;  ///< creates the body with its default values
    /// Converts a body to the machine's command. Null: the machine has no such command.
    messages::Command (*convert)(const void *body) = nullptr;
    /// The reason why the machine rejects the message, whose fields are then not read. Null: it is not
    /// rejected.
    const char *rejection = nullptr;

    const messages::Declaration *head() const;
    /// LinuxCNC's name, if it has one, else the declaration's name.
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

/// A message of any type.
class Message {
  public:
    explicit Message(const MessageKind &kind);

    const MessageKind &kind() const { return *kind_; }
    int number() const { return kind_->number; }
    MessageView view();
    /// The machine's command; an error with the reason if it has none.
    Result<messages::Command> command() const;

    /// Null if the message is of another type.
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
    /// LinuxCNC's messages (wire_table.hh), and all other commands and numbered statuses of
    /// src/messages/declarations.
    static Vocabulary standard();

    /// An error if the message has no number, or its number or name is in use. Texts contain `wire_name`
    /// instead of the name of the declaration.
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

    /// Null if there is none. The address of a type is valid as long as the vocabulary.
    const MessageKind *find(int number) const;
    const MessageKind *find(std::string_view name) const;
    Result<Message> make(int number) const;
    const std::map<int, MessageKind> &kinds() const { return kinds_; }

  private:
    std::map<int, MessageKind> kinds_;
};

}  // namespace mw::nml
