// SPDX-License-Identifier: GPL-2.0-or-later
// Constant surface speed (G96): the spindle speed increases as the tool approaches the program's X0.
#pragma once

#include <numbers>

#include "base/geometry/pose.hh"
#include "gcode/canon/frame.hh"

namespace mw::gcode {

/// Machine X of program X0. [machine units]
inline double centre_line_x(const geometry::Pose &g5x, const geometry::Pose &g92, double rotation_xy_deg,
                            const geometry::Pose &tool_offset) {
    return detail::Frame{g5x, g92, tool_offset, rotation_xy_deg}.to_machine({})[geometry::AXIS_X];
}

/// Spindle speed times radius. `surface_unit`: machine units per length unit of `speed`, see
/// MachineCanon::set_spindle_speed. [machine units/min]
inline double surface_speed_factor(double speed, double surface_unit) {
    return speed * surface_unit / (2.0 * std::numbers::pi);
}

}  // namespace mw::gcode
