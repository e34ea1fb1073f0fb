// SPDX-License-Identifier: GPL-2.0-or-later
// Tools: T, M6, M61, G43 to G49. All codes: false after setting the fault.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// The word T.
bool select_tool(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                 State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// M6. The program waits for the changer after it.
bool change_tool(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                 Parameters &parameters, State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// M61.
bool set_tool_number(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// G43 (from the table), G43.1 (from the words), G43.2 (added to the current offset), G49 (none).
bool set_tool_offset(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

/// Index of a tool in the table.
bool find_tool(const ToolTable &tools, int toolno, std::uint32_t column, int &index, Fault &fault);
/// Loads the tool at `index` into the spindle; index 0 of a table without random pockets means none.
void load_tool(const ToolTable &tools, ToolModes &tool, int index);
/// As above, for the index in the modes; none when the table has no such index.
void load_tool_at_index(const ToolTable &tools, ToolModes &tool);
/// Changes the tool offset; the machine does not move.
void move_by_tool_offset(State &state, const Pose &offset);
/// Sets and announces the offset; `code`: ten times the G code that is active from now on.
void apply_tool_offset(State &state, CanonQueue &canon, const Pose &offset, int code);

}  // namespace mw::gcode::detail
