// SPDX-License-Identifier: GPL-2.0-or-later
// Every message, by number and by name. Converts commands to and from bytes, JSON and text.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

/// Declarations of the commands, in the order of the variant.
std::span<const Declaration *const> command_declarations();
/// Declarations of the status of a machine, its parts, and the tool table.
std::span<const Declaration *const> status_declarations();

/// Declaration of a command or a status; null when there is none.
const Declaration *find_declaration(int number);
const Declaration *find_declaration(std::string_view name);

/// A command with its default values. An error names the unknown number or name.
Result<Command> make_command(int number);
Result<Command> make_command(std::string_view name);

/// The message in the variant.
Object object(Command &command);
ConstObject object(const Command &command);

/// As check(), for the message in the command.
Result<> check(const Command &command);

std::string encode(const Command &command);
/// Decodes one complete message and checks its values.
Result<Command> decode_command(std::string_view bytes);
std::string to_json(const Command &command);
Result<Command> command_from_json(std::string_view json);
std::string to_text(const Command &command);

/// Hash of the sizes and fields of all messages. Two programs with different hashes must not share memory.
std::uint64_t layout_hash();

}  // namespace mw::messages
