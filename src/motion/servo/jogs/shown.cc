// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and status of jogs.
#include <bit>

#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {
namespace {

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Values that change while axes follow a path: the speeds of their jogs do not.
void fill_places(const Jogs &jogs, const geometry::Pose &pose, Outputs &out) noexcept {
    for (int j = 0; j < jogs.num_joints; ++j) {
        const Jog &from = jogs.joint[at(j)];
        out.status.joint[at(j)].isInPosition = from.planner.isAtRest();
        out.joint[at(j)].free_pos_cmd = from.planner.target;
        out.joint[at(j)].free_velocity_limit = from.planner.max_velocity;
    }
    for (std::uint32_t left = jogs.axes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        AxisOutputs &o = out.axis[at(i)];
        o.position = pose[i];
        o.teleop_position = pose[i];
    }
}

}  // namespace

void fill(const Jogs &jogs, Mode mode, const geometry::Pose &pose, Outputs &out) noexcept {
    const bool isQuiet = mode == Mode::COORD && !jogs.isAnyJogged;
    if (isQuiet && out.areJogsQuiet) [[likely]] {
        fill_places(jogs, pose, out);
        return;
    }
    out.areJogsQuiet = isQuiet;
    bool isJogging = false;
    for (int j = 0; j < jogs.num_joints; ++j) {
        const Jog &from = jogs.joint[at(j)];
        JointOutputs &o = out.joint[at(j)];
        const bool isAtRest = from.planner.isAtRest();
        out.status.joint[at(j)].isInPosition = isAtRest;
        o.free_pos_cmd = from.planner.target;
        o.free_velocity_limit = from.planner.max_velocity;
        o.isFreePlanning = mode == Mode::FREE && !isAtRest;
        o.isKeyboardJogging = from.source == JogSource::KEYBOARD;
        o.isWheelJogging = from.source == JogSource::WHEEL;
        isJogging = isJogging || from.source != JogSource::NONE;
    }
    const bool isTeleop = mode == Mode::TELEOP;
    out.touched |= part_range(status_part::AXES, 1);
    out.axes = jogs.axes;
    for (std::uint32_t left = jogs.axes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Jog &from = jogs.axis[at(i)];
        AxisOutputs &o = out.axis[at(i)];
        o.position = pose[i];
        o.teleop_position = isTeleop ? from.planner.position : pose[i];
        o.teleop_velocity = isTeleop ? from.planner.velocity : 0.0;
        o.teleop_velocity_limit = from.planner.max_velocity;
        o.isTeleopPlanning = isTeleop && !from.planner.isAtRest();
        o.isKeyboardJogging = from.source == JogSource::KEYBOARD;
        o.isWheelJogging = from.source == JogSource::WHEEL;
        isJogging = isJogging || from.source != JogSource::NONE;
        out.status.axis[at(i)].velocity = o.teleop_velocity;
    }
    out.isJogging = isJogging;
}

}  // namespace mw::motion
