// SPDX-License-Identifier: GPL-2.0-or-later
// Typed values of an INI file as scripts read them (inivalue, Python): more forgiving than the machine's own
// reader (ini_reader.hh), and with a message for whatever is forgiven.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/ini/ini_file.hh"

namespace mw::ini {

/// Each answers the value, or nothing when it is another type's. Lines "file:line: warning: ..." or "error:"
/// are appended to `messages`. Whole numbers may have a sign and a prefix 0x, 0o or 0b; what follows a number
/// is left out with a warning, and a minus before an unsigned one wraps round with a warning.
std::optional<bool> script_bool(const IniEntry &entry, std::string &messages);
std::optional<std::int64_t> script_signed(const IniEntry &entry, std::string &messages);
std::optional<std::uint64_t> script_unsigned(const IniEntry &entry, std::string &messages);
std::optional<double> script_real(const IniEntry &entry, std::string &messages);

/// "file:line: ", without the line when there is none.
std::string script_place(const SourcePlace &place);

}  // namespace mw::ini
