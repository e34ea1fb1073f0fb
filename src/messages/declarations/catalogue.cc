// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/catalogue.hh"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "messages/declarations/binary.hh"
#include "messages/declarations/check.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/status_list.hh"
#include "messages/declarations/text.hh"

namespace mw::messages {
namespace {

/// Functions that create and access an alternative of the variant.
struct Alternative {
    const Declaration *declaration;
    Command (*make)();
    const void *(*data)(const Command &command);
};

template <std::size_t I>
constexpr Alternative alternative() {
    using T = std::variant_alternative_t<I, CommandVariant>;
    return {&DECLARATION<T>, [] { return Command(T{}); },
            [](const Command &command) -> const void * { return std::get_if<I>(&command); }};
}

template <std::size_t... I>
constexpr auto all_alternatives(std::index_sequence<I...>) {
    return std::array{alternative<I>()...};
}
constexpr auto ALTERNATIVES =
    all_alternatives(std::make_index_sequence<std::variant_size_v<CommandVariant>>());

constexpr auto COMMANDS = [] {
    std::array<const Declaration *, ALTERNATIVES.size()> all{};
    std::transform(ALTERNATIVES.begin(), ALTERNATIVES.end(), all.begin(),
                   [](const Alternative &a) { return a.declaration; });
    return all;
}();

template <class... Status>
constexpr auto all_declarations(TypeList<Status...>) {
    return std::array{&DECLARATION<Status>...};
}
constexpr auto STATUSES = all_declarations(StatusList{});

template <class Wanted>
const Alternative *find_alternative(const Wanted &isWanted) {
    const auto found = std::find_if(ALTERNATIVES.begin(), ALTERNATIVES.end(),
                                    [&](const Alternative &a) { return isWanted(*a.declaration); });
    return found == ALTERNATIVES.end() ? nullptr : &*found;
}

template <class Wanted>
const Declaration *find(const Wanted &isWanted) {
    if (const Alternative *command = find_alternative(isWanted)) {
        return command->declaration;
    }
    const auto found =
        std::find_if(STATUSES.begin(), STATUSES.end(), [&](const Declaration *d) { return isWanted(*d); });
    return found == STATUSES.end() ? nullptr : *found;
}

void mix(std::uint64_t &hash, std::uint64_t value) {
    constexpr std::uint64_t FNV_PRIME = 1099511628211ULL;
    for (int i = 0; i < 8; ++i) {
        hash = (hash ^ ((value >> (8 * i)) & 0xffU)) * FNV_PRIME;
    }
}

void mix_fields(std::uint64_t &hash, const Declaration &declaration) {
    mix(hash, static_cast<std::uint64_t>(declaration.number));
    for (const Field &field : declaration.fields) {
        const Type &type = field.type;
        for (const char *c = field.name; *c != '\0'; ++c) {
            mix(hash, static_cast<unsigned char>(*c));
        }
        mix(hash, static_cast<std::uint64_t>(type.kind));
        mix(hash, type.bytes);
        mix(hash, type.count);
        mix(hash, type.stride);
        mix(hash, type.capacity);
        if (type.parts != nullptr) {
            mix_fields(hash, *type.parts);
        }
    }
}

}  // namespace

std::span<const Declaration *const> command_declarations() {
    return COMMANDS;
}

std::span<const Declaration *const> status_declarations() {
    return STATUSES;
}

const Declaration *find_declaration(int number) {
    return number == 0 ? nullptr : find([number](const Declaration &d) { return d.number == number; });
}

const Declaration *find_declaration(std::string_view name) {
    return find([name](const Declaration &d) { return name == d.name; });
}

Result<Command> make_command(int number) {
    const Alternative *found =
        find_alternative([number](const Declaration &d) { return d.number == number; });
    if (found == nullptr) {
        return fail(fmt::format("there is no command {}", number));
    }
    return found->make();
}

Result<Command> make_command(std::string_view name) {
    const Alternative *found = find_alternative([name](const Declaration &d) { return name == d.name; });
    if (found == nullptr) {
        return fail(fmt::format("there is no command '{}'", name));
    }
    return found->make();
}

ConstObject object(const Command &command) {
    const Alternative &alternative = ALTERNATIVES[command.index()];
    return {alternative.declaration, alternative.data(command)};
}

Object object(Command &command) {
    const Alternative &alternative = ALTERNATIVES[command.index()];
    return {alternative.declaration, const_cast<void *>(alternative.data(command))};
}

Result<> check(const Command &command) {
    return check(object(command));
}

std::string encode(const Command &command) {
    std::string bytes;
    encode(object(command), bytes);
    return bytes;
}

Result<Command> decode_command(std::string_view bytes) {
    const auto head = read_head(bytes);
    if (!head.has_value()) {
        return std::unexpected(head.error());
    }
    auto command = make_command(head->number);
    if (!command.has_value()) {
        return command;
    }
    auto status = decode(bytes, object(*command));
    status = status.has_value() ? check(*command) : status;
    return status.has_value() ? std::move(command) : std::unexpected(status.error());
}

std::string to_json(const Command &command) {
    return to_json(object(command));
}

Result<Command> command_from_json(std::string_view json) {
    const auto name = json_name(json);
    if (!name.has_value()) {
        return std::unexpected(name.error());
    }
    auto command = make_command(*name);
    if (!command.has_value()) {
        return command;
    }
    const Object target = object(*command);
    if (*name != target.declaration->name) {
        return fail(fmt::format("'{}' is called '{}' in JSON", *name, target.declaration->name));
    }
    auto status = from_json(json, target);
    status = status.has_value() ? check(*command) : status;
    return status.has_value() ? std::move(command) : std::unexpected(status.error());
}

std::string to_text(const Command &command) {
    return to_text(object(command));
}

std::uint64_t layout_hash() {
    constexpr std::uint64_t FNV_START = 14695981039346656037ULL;
    std::uint64_t hash = FNV_START;
    for (const Declaration *declaration : COMMANDS) {
        mix_fields(hash, *declaration);
    }
    for (const Declaration *declaration : STATUSES) {
        mix_fields(hash, *declaration);
    }
    mix(hash, sizeof(MachineStatus));
    return hash;
}

}  // namespace mw::messages
