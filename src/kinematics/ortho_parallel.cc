// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/ortho_parallel.hh"

#include <algorithm>

#include "kinematics/spherical_wrist.hh"

namespace mw::kinematics {

namespace {

constexpr double NEAR = 1e-7;  ///< fraction of a length, or of a right angle, within which solutions coincide

/// Orientation of the lower arm: joint 0 about Z, joints 1 and 2 about the rotated Y.
Rotation arm_of(const double *joints) noexcept {
    const auto turned = [&](const Vector &v) {
        return turned_z(turned_y(v, joints[1] + joints[2]), joints[0]);
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

/// Orientation of the hand relative to the lower arm: rotations about Z, Y and Z.
Rotation hand_of(const double *joints) noexcept {
    const auto turned = [&](const Vector &v) {
        return turned_z(turned_y(turned_z(v, joints[5]), joints[4]), joints[3]);
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

/// Joints 3 to 5. If the hand is in line with the arm, only the sum or difference of joints 3 and 5 is
/// determined: joint 3 is kept.
Status turn_wrist(const Rotation &hand, double side, double *joints) noexcept {
    const double off_line = std::hypot(hand.z.x, hand.z.y);
    if (off_line < NEAR) {
        const bool is_ahead = hand.z.z > 0;
        joints[4] = is_ahead ? 0.0 : side * 180.0;
        const double turn = is_ahead ? arc_tangent(hand.x.y, hand.x.x) - joints[3]
                                     : joints[3] - arc_tangent(-hand.x.y, -hand.x.x);
        joints[5] = nearest_turn(turn, joints[5]);
        return Status::SINGULAR;
    }
    joints[3] = nearest_turn(arc_tangent(side * hand.z.y, side * hand.z.x), joints[3]);
    joints[4] = nearest_turn(arc_tangent(side * off_line, hand.z.z), joints[4]);
    joints[5] = nearest_turn(arc_tangent(side * hand.y.z, -side * hand.x.z), joints[5]);
    return Status::OK;
}

}  // namespace

/// Distance of the wrist from axis 0 in the direction of joint 0.
double OrthoParallel::ahead_of(const double *joints) const noexcept {
    return get(A1) + get(C2) * sine(joints[1]) + lower() * sine(joints[1] + joints[2] + lower_angle());
}

OrthoParallel::Sides OrthoParallel::sides_of(const double *joints) const noexcept {
    return {ahead_of(joints) < 0 ? -1.0 : 1.0, sine(joints[2] + lower_angle()) < 0 ? -1.0 : 1.0,
            sine(joints[4]) < 0 ? -1.0 : 1.0};
}

Status OrthoParallel::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    const double up = get(C2) * cosine(joints[1]) + lower() * cosine(joints[1] + joints[2] + lower_angle());
    const Vector wrist = turned_z({ahead_of(joints), get(B), up}, joints[0]) + Vector{0, 0, get(C1)};
    const Rotation hand = arm_of(joints) * hand_of(joints);
    set_place(pose, wrist + hand.z * get(C4));
    set_rotation(pose, hand);
    std::copy_n(joints + JOINTS, 3, pose.c.begin() + geometry::AXIS_U);
    return Status::OK;
}

/// Joints 0 to 2 for a position of the wrist: joint 0 points to the wrist, then the two arms reach it.
Status OrthoParallel::place_wrist(const Vector &wrist, const Sides &sides, double *joints) const noexcept {
    const double upper = get(C2);
    const double size = std::abs(upper) + lower();
    const double level = square(wrist.x) + square(wrist.y);
    const double ahead_squared = level - square(get(B));
    const double rounding = 1e-12 * size * size;
    if (!(ahead_squared >= -rounding) || !(upper != 0 && lower() > 0)) {
        return Status::UNREACHABLE;
    }
    const double ahead = sides.shoulder * std::sqrt(std::max(ahead_squared, 0.0));
    const double out = ahead - get(A1);
    const double up = wrist.z - get(C1);
    const double bend =
        (square(out) + square(up) - square(upper) - square(lower())) / (2.0 * upper * lower());
    const double rest = 1.0 - bend * bend;
    if (!(rest >= -1e-12)) {
        return Status::UNREACHABLE;
    }
    const double bent = sides.elbow * std::sqrt(std::max(rest, 0.0));
    const bool over_axis = level < square(NEAR * size);
    if (!over_axis) {
        joints[0] = nearest_turn(arc_tangent(wrist.y, wrist.x) - arc_tangent(get(B), ahead), joints[0]);
    }
    joints[2] = nearest_turn(arc_tangent(bent, bend) - lower_angle(), joints[2]);
    const double along = upper + lower() * bend;
    const double across = lower() * bent;
    const bool folded = std::hypot(along, across) < NEAR * size;
    if (!folded) {
        joints[1] =
            nearest_turn(arc_tangent(along * out - across * up, along * up + across * out), joints[1]);
    }
    const bool at_edge = ahead_squared < square(NEAR * size) || rest < square(NEAR);
    return over_axis || folded || at_edge ? Status::SINGULAR : Status::OK;
}

Status OrthoParallel::inverse(const Pose &pose, double *joints) const noexcept {
    const Sides sides = sides_of(joints);
    return inverse_by_wrist(
        pose, get(C4), joints,
        [&](const Vector &wrist, double *found) noexcept { return place_wrist(wrist, sides, found); },
        [&](const Rotation &hand, double *found) noexcept {
            return turn_wrist(arm_of(found).inverse() * hand, sides.wrist, found);
        });
}

}  // namespace mw::kinematics
