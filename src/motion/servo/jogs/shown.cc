// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and status of jogs.
#include <bit>

#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {
namespace {

std::size_t index(int i) noexcept {
    return static_cast<std::size_t>(i);
}

}  // namespace

/// Fills only values that change while axes follow a path. Jog speeds do not change then.
void Jogs::fill_positions(const geometry::Pose &pose, Outputs &out) const noexcept {
    for (int j = 0; j < num_joints_; ++j) {
        const Jog &from = joint_[index(j)];
        out.status.joint[index(j)].isInPosition = from.isAtRest();
        out.joint[index(j)].free_pos_cmd = from.motion().target;
        out.joint[index(j)].free_velocity_limit = from.motion().max_velocity;
    }
    for (std::uint32_t left = axes_; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        AxisOutputs &o = out.axis[index(i)];
        o.position = pose[i];
        o.teleop_position = pose[i];
    }
}

void Jogs::fill(Mode mode, const geometry::Pose &pose, Outputs &out) const noexcept {
    const bool isQuiet = mode == Mode::COORD && !any_jogged_;
    if (isQuiet && out.areJogsQuiet) [[likely]] {
        fill_positions(pose, out);
        return;
    }
    out.areJogsQuiet = isQuiet;
    bool isJogging = false;
    for (int j = 0; j < num_joints_; ++j) {
        const Jog &from = joint_[index(j)];
        JointOutputs &o = out.joint[index(j)];
        const bool isAtRest = from.isAtRest();
        out.status.joint[index(j)].isInPosition = isAtRest;
        o.free_pos_cmd = from.motion().target;
        o.free_velocity_limit = from.motion().max_velocity;
        o.isFreePlanning = mode == Mode::FREE && !isAtRest;
        o.isKeyboardJogging = from.source() == JogSource::KEYBOARD;
        o.isWheelJogging = from.source() == JogSource::WHEEL;
        isJogging = isJogging || from.source() != JogSource::NONE;
    }
    const bool isTeleop = mode == Mode::TELEOP;
    out.touched |= part_range(status_part::AXES, 1);
    out.axes = axes_;
    for (std::uint32_t left = axes_; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Jog &from = axis_[index(i)];
        AxisOutputs &o = out.axis[index(i)];
        o.position = pose[i];
        o.teleop_position = isTeleop ? from.motion().position : pose[i];
        o.teleop_velocity = isTeleop ? from.motion().velocity : 0.0;
        o.teleop_velocity_limit = from.motion().max_velocity;
        o.isTeleopPlanning = isTeleop && !from.isAtRest();
        o.isKeyboardJogging = from.source() == JogSource::KEYBOARD;
        o.isWheelJogging = from.source() == JogSource::WHEEL;
        isJogging = isJogging || from.source() != JogSource::NONE;
        out.status.axis[index(i)].velocity = o.teleop_velocity;
    }
    out.isJogging = isJogging;
}

}  // namespace mw::motion
