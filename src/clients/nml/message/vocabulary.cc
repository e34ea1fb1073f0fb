// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/message/vocabulary.hh"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "clients/nml/message/format.hh"
#include "clients/nml/message/wire_table.hh"
#include "messages/declarations/status_list.hh"

namespace mw::nml {
namespace {

/// Separate tests check the table and the declarations, so adding them cannot fail.
template <class Body>
void add_other(Vocabulary &vocabulary, Base base) {
    const int number = messages::DECLARATION<Body>.number;
    if (number != 0 && vocabulary.find(number) == nullptr) {
        MessageKind kind;
        kind.number = number;
        kind.declaration = &messages::DECLARATION<Body>;
        kind.base = base;
        kind.make = make_body<Body>;
        if constexpr (AlternativeOf<Body, messages::CommandVariant>) {
            kind.convert = convert_body<Body>;
        }
        static_cast<void>(vocabulary.add(kind));
    }
}

template <class... Body>
void add_commands(Vocabulary &vocabulary, std::type_identity<std::variant<Body...>>) {
    (add_other<Body>(vocabulary, Base::COMMAND), ...);
}

template <class... Body>
void add_statuses(Vocabulary &vocabulary, messages::TypeList<Body...>) {
    (add_other<Body>(vocabulary, Base::STATUS), ...);
}

}  // namespace

const messages::Declaration *MessageKind::head() const {
    switch (base) {
    case Base::COMMAND: return &messages::DECLARATION<CommandHead>;
    case Base::STATUS: return &messages::DECLARATION<StatusHead>;
    case Base::PLAIN: break;
    }
    return &messages::DECLARATION<PlainHead>;
}

Message::Message(const MessageKind &kind) : kind_(&kind), body_(kind.make()) {
    switch (kind.base) {
    case Base::COMMAND: head_ = CommandHead{}; break;
    case Base::STATUS: head_ = StatusHead{}; break;
    case Base::PLAIN: break;
    }
}

MessageView Message::view() {
    return {std::visit([](auto &head) { return messages::object(head); }, head_),
            {kind_->declaration, body_.get()}};
}

Result<messages::Command> Message::command() const {
    if (kind_->rejection != nullptr) {
        return fail(kind_->rejection);
    }
    return kind_->convert != nullptr ? Result<messages::Command>(kind_->convert(body_.get()))
                                     : fail(fmt::format("{} is no command of this machine", kind_->name()));
}

Vocabulary Vocabulary::standard() {
    Vocabulary vocabulary;
    for (const MessageKind &kind : wire_messages()) {
        static_cast<void>(vocabulary.add(kind));
    }
    add_commands(vocabulary, std::type_identity<messages::CommandVariant>{});
    add_statuses(vocabulary, messages::StatusList{});
    return vocabulary;
}

Result<> Vocabulary::add(MessageKind kind) {
    const messages::Declaration &declaration = *kind.declaration;
    if (kind.number <= 0) {
        return fail(fmt::format("{} has no number and cannot be a message", declaration.name));
    }
    const MessageKind *other = find(kind.number);
    for (const char *name : {declaration.name, kind.wire_name}) {
        other = other == nullptr && *name != '\0' ? find(std::string_view(name)) : other;
    }
    if (other != nullptr) {
        return fail(fmt::format("{} ({}) cannot be added: there is {} ({})", declaration.name, kind.number,
                                other->declaration->name, other->number));
    }
    kind.shape = shape_of(*kind.head(), declaration);
    kinds_.emplace(kind.number, kind);
    return {};
}

const MessageKind *Vocabulary::find(int number) const {
    const auto found = kinds_.find(number);
    return found == kinds_.end() ? nullptr : &found->second;
}

const MessageKind *Vocabulary::find(std::string_view name) const {
    const auto found = std::find_if(kinds_.begin(), kinds_.end(), [name](const auto &entry) {
        const MessageKind &kind = entry.second;
        return name == kind.declaration->name || (!name.empty() && name == kind.wire_name);
    });
    return found == kinds_.end() ? nullptr : &found->second;
}

Result<Message> Vocabulary::make(int number) const {
    const MessageKind *kind = find(number);
    return kind != nullptr ? Result<Message>(Message(*kind))
                           : fail(fmt::format("there is no message {}", number));
}

}  // namespace mw::nml
