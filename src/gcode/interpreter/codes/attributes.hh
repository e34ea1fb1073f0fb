// SPDX-License-Identifier: GPL-2.0-or-later
// The state by the attribute names of scripts. Lengths in program units, angles in degrees.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/codes/code_parts.hh"
#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::gcode::detail {

/// Objects that attributes read and change.
struct AttributeSources {
    State &state;
    ReturnValue &returned;
    ScriptLevels &script_levels;
    const CodeParts &parts;
    int running_remaps = 0;
};

/// Nothing when there is no such name.
std::optional<ScriptValue> attribute(std::string_view name, const AttributeSources &sources);
/// An error when the attribute is read-only, or the value is not finite.
Result<> set_attribute(std::string_view name, const ScriptValue &value, const AttributeSources &sources);
std::vector<std::string_view> attribute_names();

}  // namespace mw::gcode::detail
