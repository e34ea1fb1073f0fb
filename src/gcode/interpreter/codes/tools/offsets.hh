// SPDX-License-Identifier: GPL-2.0-or-later
// Coordinate systems, G52 and G92, and the reference points G28 and G30.
#pragma once

#include "gcode/interpreter/codes/code_parts.hh"

namespace mw::gcode::detail {

/// Nine axes from parameter `first` on, converted from machine units by `to_program`.
Pose parameter_pose(const Parameters &parameters, int first, double to_program);
void set_parameter_pose(Parameters &parameters, int first, const Pose &pose, double to_program);
/// Changes the frame; the machine does not move, its position is converted to the new frame.
void change_frame(State &state, const Frame &made);
void send_coordinates(const State &state, CanonQueue &canon);

/// The position that G28.1 or G30.1 has stored, in the current frame; wrapped rotary axes take the shortest
/// path from `before`, a machine position.
Pose stored_place(int first, const Pose &before, const State &state, const CodeParts &parts);

}  // namespace mw::gcode::detail
