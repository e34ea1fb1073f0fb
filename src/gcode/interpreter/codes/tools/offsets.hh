// SPDX-License-Identifier: GPL-2.0-or-later
// Coordinate systems, G52 and G92, and the reference points G28 and G30.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Nine axes from `first` on, which are in machine units, converted by `to_program`.
Pose parameter_pose(const Parameters &parameters, int first, double to_program);
void set_parameter_pose(Parameters &parameters, int first, const Pose &pose, double to_program);
/// Changes the frame; the machine does not move, its position is converted to the new frame.
void change_frame(State &state, const Frame &made);
void send_coordinates(const State &state, CanonQueue &canon);

// Codes: false after setting the fault.

/// G54 to G59.3.
bool use_coordinates(const Code &code, const BlockValues &values, const Machine &machine,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault);
/// The position that G28.1 or G30.1 has stored, in the current frame; wrapped rotary axes move the short way
/// from `before`, a machine position.
Pose stored_place(int first, const Pose &before, const Machine &machine, const Parameters &parameters,
                  const State &state);
/// G52, G92 and G92.1 to G92.3.
bool shift_axes(const Code &code, const BlockValues &values, const Machine &machine, Parameters &parameters,
                State &state, CanonQueue &canon, Fault &fault);
/// G28 and G30: through the programmed position to the stored one; .1 stores.
bool go_to_reference(const Code &code, const BlockValues &values, const Machine &machine,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
