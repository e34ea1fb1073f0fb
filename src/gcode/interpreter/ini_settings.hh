// SPDX-License-Identifier: GPL-2.0-or-later
// The interpreter's settings as an INI file has them.
#pragma once

#include <optional>
#include <string_view>

#include "base/ini/ini_reader.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode {

/// Reads the keys of gcode/interpreter/ini_keys.hh. Values of a wrong form are reported to the reader's sink
/// with their place.
Settings settings_from_ini(ini::IniReader &ini);

/// The value of #<_ini[section]key>: programs have no case, so upper case is looked for; nothing when there
/// is no such key or its value is not a number.
std::optional<double> ini_number(const ini::IniFile &ini, std::string_view section, std::string_view key);

}  // namespace mw::gcode
