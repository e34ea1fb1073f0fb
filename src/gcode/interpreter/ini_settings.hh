// SPDX-License-Identifier: GPL-2.0-or-later
// The interpreter's settings from an INI file.
#pragma once

#include <optional>
#include <string_view>

#include "base/ini/ini_reader.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode {

/// Reads the keys of gcode/interpreter/ini_keys.hh. Invalid values are reported to the reader's sink with
/// their position.
Settings settings_from_ini(ini::IniReader &ini);

/// The value of #<_ini[section]key>: names in programs have no case, so the upper-case key is searched;
/// nothing when the key does not exist or its value is not a number.
std::optional<double> ini_number(const ini::IniFile &ini, std::string_view section, std::string_view key);

}  // namespace mw::gcode
