// SPDX-License-Identifier: GPL-2.0-or-later
// Typed values of an INI file for scripts (inivalue, Python): more tolerant than the machine's reader
// (ini_reader.hh), with a message for each tolerated error.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/ini/ini_file.hh"

namespace mw::ini {

/// Each function returns the value, or nothing if the value has another type. Lines "file:line: warning: ..."
/// or "error:" are appended to `messages`. Whole numbers may have a sign and a prefix 0x, 0o or 0b. Text
/// after a number is ignored with a warning; a negative value of an unsigned number wraps with a warning.
std::optional<bool> script_bool(const IniEntry &entry, std::string &messages);
std::optional<std::int64_t> script_signed(const IniEntry &entry, std::string &messages);
std::optional<std::uint64_t> script_unsigned(const IniEntry &entry, std::string &messages);
std::optional<double> script_real(const IniEntry &entry, std::string &messages);

/// "file:line: ", or "file: " without a line.
std::string script_place(const SourcePlace &place);

}  // namespace mw::ini
