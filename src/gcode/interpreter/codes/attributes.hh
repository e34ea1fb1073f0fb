// SPDX-License-Identifier: GPL-2.0-or-later
// The state by the attribute names of scripts. Lengths in program units, angles in degrees.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode::detail {

/// Objects that attributes read and change.
struct AttributeSources {
    State &state;
    ReturnValue &returned;
    Awaited &awaited;
    ScriptLevels &script_levels;
    const BlockPlace &place;
    const World &world;
    const ToolTable &tools;
    int running_remaps = 0;
    bool is_task = false;
};

/// Nothing when there is no such name.
std::optional<ScriptValue> attribute(std::string_view name, const AttributeSources &sources);
/// An error when the attribute is read-only, or the value is not finite.
Result<> set_attribute(std::string_view name, const ScriptValue &value, const AttributeSources &sources);
std::vector<std::string_view> attribute_names();

}  // namespace mw::gcode::detail
