// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of all codes by file, and their effects besides modes (State) and canon calls.
#pragma once

#include "gcode/interpreter/codes/code_parts.hh"

namespace mw::gcode::detail {

// modes/modes.cc: F, G17 to G21, G7 and G8, G61 to G64, G90 to G99.
CodeFunction set_feed, set_units, select_plane, set_distance_mode, set_centre_distance_mode,
    set_diameter_mode, set_feed_mode, set_retract_mode, set_path_control;
// modes/restore_modes.cc: M70 to M73. Changes saved modes, and with M72 parameters.
CodeFunction keep_modes;

// moves/moves.cc: G0, G1, G80, G33 and G33.1; G38.2 to G38.5, which change parameters and wait.
CodeFunction move_straight, cancel_motion, move_with_spindle, move_probe;
/// G53 has no action. It changes the coordinates of the block's move.
CodeFunction note_machine_coordinates;
// moves/arcs.cc: G2 and G3.
CodeFunction move_along_arc;
// moves/splines.cc: G5, G5.1; G5.2 and G5.3, which change the control points.
CodeFunction move_along_cubic, move_along_quadratic, add_nurbs_point, end_nurbs;

// cycles/canned_cycles.cc: G73, G74, G81 to G89.
CodeFunction run_canned_cycle;
// lathe/thread_cycle.cc: G76.
CodeFunction cut_thread;
// lathe/lathe_cycles.cc: G70 to G72.2. The following blocks are the profile.
CodeFunction begin_lathe_cycle;
// comp/comp_codes.cc: G40 to G42.1.
CodeFunction set_compensation;

// tools/tools.cc: T, M6, M61, G43 to G49. M6 waits for the changer.
CodeFunction select_tool, change_tool, set_tool_number, set_tool_offset;
// tools/stored_data.cc: G10. Changes the tool table or parameters; L0 waits for the tool table.
CodeFunction set_stored_data;
// tools/offsets.cc: G54 to G59.3, G52 and G92, G28 and G30. Change parameters.
CodeFunction use_coordinates, shift_axes, go_to_reference;

// switches/spindles.cc: S, M3 to M5, M19, G96 and G97.
CodeFunction set_speed, turn_spindle, orient_spindle, set_spindle_mode;
// switches/switches.cc: M7 to M9, M48 to M53, M62 to M65, M67 and M68, M100 to M199, G4; M66, which waits.
CodeFunction switch_coolant, switch_overrides, set_output, run_user_code, dwell, wait_for_input;
// switches/program_flow.cc: M0, M1, M60; M2 and M30, which change parameters; M98 and M99.
CodeFunction stop_program, end_program, call_or_return;

}  // namespace mw::gcode::detail
