// SPDX-License-Identifier: GPL-2.0-or-later
// Every message, by number and by name; commands to and from bytes, JSON and text.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

/// In the order of the variant.
std::span<const Declaration *const> command_declarations();
/// The status of a machine, its parts, the tool table.
std::span<const Declaration *const> status_declarations();

/// Of a command or a status; null when there is none.
const Declaration *find_declaration(int number);
const Declaration *find_declaration(std::string_view name);

/// The command with its default values; an error names what there is not.
Result<Command> make_command(int number);
Result<Command> make_command(std::string_view name);

/// What is in the variant.
Object object(Command &command);
ConstObject object(const Command &command);

/// As check() of the message in it.
Result<> check(const Command &command);

std::string encode(const Command &command);
/// One whole message; its values are checked.
Result<Command> decode_command(std::string_view bytes);
std::string to_json(const Command &command);
Result<Command> command_from_json(std::string_view json);
std::string to_text(const Command &command);

/// Of sizes and fields of every message: two programs whose layouts differ must not share memory.
std::uint64_t layout_hash();

}  // namespace mw::messages
