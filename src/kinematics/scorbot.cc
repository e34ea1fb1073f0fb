// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/scorbot.hh"

#include <algorithm>

#include "kinematics/frame.hh"

namespace mw::kinematics {

namespace {

constexpr double NEAR = 1e-7;  ///< fraction of an arm length, or of a right angle

}  // namespace

Status Scorbot::forward(const double *joints, Pose &pose) const noexcept {
    const double reach = SHOULDER_X_MM + ARM_MM * (cosine(joints[1]) + cosine(joints[2]));
    if (!areFinite(joints, 5) || reach < 0) {
        return Status::UNREACHABLE;
    }
    pose[geometry::AXIS_X] = reach * cosine(joints[0]);
    pose[geometry::AXIS_Y] = reach * sine(joints[0]);
    pose[geometry::AXIS_Z] = SHOULDER_Z_MM + ARM_MM * (sine(joints[1]) + sine(joints[2]));
    pose[geometry::AXIS_A] = joints[3];
    pose[geometry::AXIS_B] = joints[4];
    const bool free = reach > NEAR * ARM_MM && std::abs(sine(joints[1] - joints[2])) > NEAR;
    return free ? Status::OK : Status::SINGULAR;
}

Status Scorbot::inverse(const Pose &pose, double *joints) const noexcept {
    const double reach = std::hypot(pose[geometry::AXIS_X], pose[geometry::AXIS_Y]);
    const double x = reach - SHOULDER_X_MM;
    const double z = pose[geometry::AXIS_Z] - SHOULDER_Z_MM;
    const double distance = std::hypot(x, z);
    const double part = distance / (2.0 * ARM_MM);
    if (!isFinite(pose) || !(part <= 1.0 + 1e-12)) {
        return Status::UNREACHABLE;
    }
    const bool over_axis = reach < NEAR * ARM_MM;
    const bool folded = part < NEAR;
    const double bend = std::acos(std::clamp(part, 0.0, 1.0)) * DEGREES;
    const double side = sine(joints[1] - joints[2]) < 0 ? -1.0 : 1.0;
    const double level = folded ? nearest_turn(joints[1] - side * bend, 0) : arc_tangent(z, x);
    if (!over_axis) {
        joints[0] = nearest_turn(arc_tangent(pose[geometry::AXIS_Y], pose[geometry::AXIS_X]), joints[0]);
    }
    joints[1] = nearest_turn(level + side * bend, joints[1]);
    joints[2] = nearest_turn(level - side * bend, joints[2]);
    joints[3] = pose[geometry::AXIS_A];
    joints[4] = pose[geometry::AXIS_B];
    const bool stretched = std::abs(sine(2.0 * bend)) < NEAR;
    return over_axis || folded || stretched ? Status::SINGULAR : Status::OK;
}

}  // namespace mw::kinematics
