// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/puma.hh"

#include <algorithm>

#include "kinematics/spherical_wrist.hh"

namespace mw::kinematics {

namespace {

constexpr double NEAR = 1e-7;  ///< fraction of a length, or of a right angle, within which solutions coincide

/// Orientation of the frame of joint 2 relative to the base.
Rotation arm_of(const double *joints) noexcept {
    const double c = cosine(joints[0]);
    const double s = sine(joints[0]);
    const double c23 = cosine(joints[1] + joints[2]);
    const double s23 = sine(joints[1] + joints[2]);
    return {{c * c23, s * c23, -s23}, {-c * s23, -s * s23, -c23}, {-s, c, 0}};
}

/// Orientation of the hand in the frame of joint 2.
Rotation hand_of(const double *joints) noexcept {
    const double c4 = cosine(joints[3]);
    const double s4 = sine(joints[3]);
    const double c5 = cosine(joints[4]);
    const double s5 = sine(joints[4]);
    const double c6 = cosine(joints[5]);
    const double s6 = sine(joints[5]);
    return {{c4 * c5 * c6 - s4 * s6, s5 * c6, -s4 * c5 * c6 - c4 * s6},
            {-c4 * c5 * s6 - s4 * c6, -s5 * s6, s4 * c5 * s6 - c4 * c6},
            {-c4 * s5, c5, s4 * s5}};
}

/// Joints 3 to 5 from the hand relative to the lower arm. If the hand is in line with the arm, only the sum
/// or difference of joints 3 and 5 is determined: joint 3 is kept.
Status turn_wrist(const Rotation &hand, double side, double *joints) noexcept {
    const double off_line = std::hypot(hand.z.x, hand.z.z);
    if (off_line < NEAR) {
        const bool is_ahead = hand.z.y > 0;
        joints[4] = is_ahead ? 0.0 : side * 180.0;
        const double turn = is_ahead ? arc_tangent(-hand.x.z, hand.x.x) - joints[3]
                                     : joints[3] - arc_tangent(hand.x.z, -hand.x.x);
        joints[5] = nearest_turn(turn, joints[5]);
        return Status::SINGULAR;
    }
    joints[3] = nearest_turn(arc_tangent(side * hand.z.z, -side * hand.z.x), joints[3]);
    joints[4] = nearest_turn(arc_tangent(side * off_line, hand.z.y), joints[4]);
    joints[5] = nearest_turn(arc_tangent(-side * hand.y.y, side * hand.x.y), joints[5]);
    return Status::OK;
}

}  // namespace

Puma::Sides Puma::sides_of(const double *joints) const noexcept {
    const double s23 = sine(joints[1] + joints[2]);
    const double c23 = cosine(joints[1] + joints[2]);
    const double ahead = get(A2) * cosine(joints[1]) + get(A3) * c23 - get(D4) * s23;
    const double bent = get(A3) * sine(joints[2]) + get(D4) * cosine(joints[2]);
    return {ahead < 0 ? -1.0 : 1.0, bent < 0 ? -1.0 : 1.0, sine(joints[4]) < 0 ? -1.0 : 1.0};
}

Status Puma::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, geometry::AXIS_COUNT)) {
        return Status::UNREACHABLE;
    }
    const Rotation arm = arm_of(joints);
    const Rotation hand = arm * hand_of(joints);
    const Vector upper{get(A2) * cosine(joints[1]), 0, -get(A2) * sine(joints[1])};
    const Vector wrist = turned_z(upper, joints[0]) + arm * Vector{get(A3), get(D4), get(D3)};
    set_place(pose, wrist + hand.z * get(D6));
    set_rotation(pose, hand);
    std::copy_n(joints + JOINTS, 3, pose.c.begin() + geometry::AXIS_U);
    return Status::OK;
}

/// Joints 0 to 2 for a position of the wrist.
Status Puma::place_wrist(const Vector &wrist, const Sides &sides, double *joints) const noexcept {
    const double size = std::abs(get(A2)) + std::hypot(get(A3), get(D4));
    const double level = square(wrist.x) + square(wrist.y);
    const double ahead_squared = level - square(get(D3));
    const double k =
        (level + square(wrist.z) - square(get(A2)) - square(get(A3)) - square(get(D3)) - square(get(D4))) /
        (2.0 * get(A2));
    const double bent_squared = square(get(A3)) + square(get(D4)) - k * k;
    const double rounding = 1e-12 * size * size;
    if (!(ahead_squared >= -rounding && bent_squared >= -rounding)) {
        return Status::UNREACHABLE;
    }
    const double ahead = sides.shoulder * std::sqrt(std::max(ahead_squared, 0.0));
    const double bent = sides.elbow * std::sqrt(std::max(bent_squared, 0.0));
    const bool over_axis = level < square(NEAR * size);
    if (!over_axis) {
        const double turn = arc_tangent(wrist.y, wrist.x) - arc_tangent(get(D3), ahead);
        joints[0] = nearest_turn(turn, joints[0]);
    }
    joints[2] = nearest_turn(arc_tangent(get(A3), get(D4)) - arc_tangent(k, bent), joints[2]);
    const double m = get(A2) * cosine(joints[2]) + get(A3);
    const double n = get(A2) * sine(joints[2]) - get(D4);
    const bool folded = std::hypot(m, n) < NEAR * size;
    if (!folded) {
        const double s23 = n * ahead - m * wrist.z;
        const double c23 = m * ahead + n * wrist.z;
        joints[1] = nearest_turn(arc_tangent(s23, c23) - joints[2], joints[1]);
    }
    const bool at_edge = ahead_squared < square(NEAR * size) || bent_squared < square(NEAR * size);
    return over_axis || folded || at_edge ? Status::SINGULAR : Status::OK;
}

Status Puma::inverse(const Pose &pose, double *joints) const noexcept {
    const Sides sides = sides_of(joints);
    return inverse_by_wrist(
        pose, get(D6), joints,
        [&](const Vector &wrist, double *found) noexcept { return place_wrist(wrist, sides, found); },
        [&](const Rotation &hand, double *found) noexcept {
            return turn_wrist(arm_of(found).inverse() * hand, sides.wrist, found);
        });
}

}  // namespace mw::kinematics
