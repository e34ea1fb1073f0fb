// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/scara.hh"

#include <algorithm>

#include "kinematics/frame.hh"

namespace mw::kinematics {

namespace {

constexpr int JOINTS = 6;
constexpr double STRETCHED = 1e-7;  ///< sine of the elbow angle below which both solutions coincide

}  // namespace

Status Scara::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, JOINTS)) {
        return Status::UNREACHABLE;
    }
    const double outer = joints[0] + joints[1];
    const double hand = outer + joints[3];
    pose[geometry::AXIS_X] = get(D2) * cosine(joints[0]) + get(D4) * cosine(outer) + get(D6) * cosine(hand);
    pose[geometry::AXIS_Y] = get(D2) * sine(joints[0]) + get(D4) * sine(outer) + get(D6) * sine(hand);
    pose[geometry::AXIS_Z] = get(D1) + get(D3) - get(D5) - joints[2];
    pose[geometry::AXIS_A] = joints[4];
    pose[geometry::AXIS_B] = joints[5];
    pose[geometry::AXIS_C] = hand;
    return Status::OK;
}

Status Scara::inverse(const Pose &pose, double *joints) const noexcept {
    const double inner = get(D2);
    const double outer = get(D4);
    const double c = pose[geometry::AXIS_C];
    const double x = pose[geometry::AXIS_X] - get(D6) * cosine(c);
    const double y = pose[geometry::AXIS_Y] - get(D6) * sine(c);
    const double bend = (x * x + y * y - inner * inner - outer * outer) / (2.0 * inner * outer);
    if (!isFinite(pose) || !(std::abs(bend) <= 1.0 + 1e-12)) {
        return Status::UNREACHABLE;
    }
    const double cosine_1 = std::clamp(bend, -1.0, 1.0);
    const double side = sine(joints[1]) > 0 ? 1.0 : -1.0;
    const double sine_1 = side * std::sqrt((1.0 - cosine_1) * (1.0 + cosine_1));
    const double along = inner + outer * cosine_1;
    const double across = outer * sine_1;
    // An arm with equal halves that is folded over its shoulder may point in any direction.
    const double reach = std::hypot(x, y);
    const bool folded = reach < STRETCHED * (std::abs(inner) + std::abs(outer));
    const double elbow = nearest_turn(arc_tangent(sine_1, cosine_1), joints[1]);
    const double shoulder =
        folded ? joints[0] : nearest_turn(arc_tangent(y, x) - arc_tangent(across, along), joints[0]);
    joints[0] = shoulder;
    joints[1] = elbow;
    joints[2] = get(D1) + get(D3) - get(D5) - pose[geometry::AXIS_Z];
    joints[3] = c - shoulder - elbow;
    joints[4] = pose[geometry::AXIS_A];
    joints[5] = pose[geometry::AXIS_B];
    return folded || std::abs(sine_1) < STRETCHED ? Status::SINGULAR : Status::OK;
}

}  // namespace mw::kinematics
