// SPDX-License-Identifier: GPL-2.0-or-later
// The tool in the spindle and its offset.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"

namespace mw::gcode::detail {

/// The number of a tool, 0 or more. False after setting the fault.
bool tool_number(const BlockValues &values, char word, int &toolno);
/// Index of the tool that `word` names. False after setting the fault.
bool find_tool(const BlockValues &values, char word, int toolno, const ToolTable &tools, int &index);
/// Loads the tool at `index` into the spindle; index 0 of a table without random pockets means none.
void load_tool(const ToolTable &tools, ToolModes &tool, int index);
/// As above, for the index in the modes; none when the table has no such index.
void load_tool_at_index(const ToolTable &tools, ToolModes &tool);
/// Changes the tool offset; the machine does not move.
void move_by_tool_offset(State &state, const Pose &offset);
/// Sets and announces the offset; `code` is active from now on.
void apply_tool_offset(State &state, CanonQueue &canon, const Pose &offset, GCode code);

}  // namespace mw::gcode::detail
