// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/legacy/status_table.hh"

#include <cmath>
#include <numbers>

#include "messages/legacy/units.hh"

namespace mw::legacy {

geometry::Pose program_position(const Status &status, const geometry::Pose &machine_position) {
    const messages::OffsetsStatus &offsets = status.offsets;
    geometry::Pose pose = machine_position - offsets.g5x - offsets.tool;
    const double angle = -offsets.rotation_xy_deg * std::numbers::pi / 180;
    const double x = pose.x(), y = pose.y();
    pose[geometry::AXIS_X] = x * std::cos(angle) - y * std::sin(angle);
    pose[geometry::AXIS_Y] = x * std::sin(angle) + y * std::cos(angle);
    return pose - offsets.g92;
}

std::string limit_word(const messages::JointStatus &joint) {
    return joint.isOnNegHardLimit   ? "MINHARD"
           : joint.isOnNegSoftLimit ? "MINSOFT"
           : joint.isOnPosSoftLimit ? "MAXSOFT"
           : joint.isOnPosHardLimit ? "MAXHARD"
                                    : "OK";
}

std::string unit_word(const Joint &joint) {
    const double units = joint.now.isPresent ? joint.set.units : 1.0;
    return joint.isAngular() ? name_of_angle(units) : name_of_length(units);
}

}  // namespace mw::legacy
