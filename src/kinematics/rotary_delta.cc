// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/rotary_delta.hh"

#include <algorithm>

#include "kinematics/spheres.hh"

namespace mw::kinematics {

namespace {

double leg_angle(int leg) noexcept {
    return 270.0 + 120.0 * leg;
}

}  // namespace

Status RotaryDelta::forward(const double *joints, Pose &pose) const noexcept {
    // Reduces the foot to a point: each knee is moved inward by the foot's radius.
    std::array<Sphere, 3> spheres;
    for (int i = 0; i < 3; ++i) {
        const Vector knee{get(PLATFORM) - get(FOOT) + get(THIGH) * cosine(joints[i]), 0,
                          -get(THIGH) * sine(joints[i])};
        spheres[static_cast<std::size_t>(i)] = {turned_z(knee, leg_angle(i)), get(SHIN)};
    }
    const auto meeting = meeting_of(spheres);
    if (!areFinite(joints, geometry::AXIS_COUNT) || !meeting.has_value()) {
        return Status::UNREACHABLE;
    }
    Pose found = pose;
    std::copy_n(joints, geometry::AXIS_COUNT, found.c.begin());
    set_place(found, meeting->below);
    std::array<double, MAX_JOINTS> back{};
    std::copy_n(joints, geometry::AXIS_COUNT, back.begin());
    const Status status = inverse(found, back.data());
    constexpr double SAME_DEG = 1e-3;
    for (std::size_t i = 0; i < 3; ++i) {
        if (status == Status::UNREACHABLE || std::abs(back[i] - joints[i]) > SAME_DEG) {
            return Status::UNREACHABLE;
        }
    }
    pose = found;
    return status;
}

Status RotaryDelta::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const double thigh = get(THIGH);
    std::array<double, 3> angles{};
    std::array<Vector, 3> shins;
    double least = 1;
    for (int i = 0; i < 3; ++i) {
        // Relative to the shoulder, in the plane of the thigh; y is the distance of the ankle from that
        // plane.
        Vector ankle = turned_z(place_of(pose), -leg_angle(i));
        ankle.x += get(FOOT) - get(PLATFORM);
        const double reach = std::hypot(ankle.x, ankle.z);
        const double bend = (dot(ankle, ankle) + square(thigh) - square(get(SHIN))) / (2.0 * thigh * reach);
        if (!(std::abs(bend) <= 1.0)) {
            return Status::UNREACHABLE;
        }
        const auto n = static_cast<std::size_t>(i);
        angles[n] = arc_tangent(-ankle.z, ankle.x) - std::acos(bend) * DEGREES;
        least = std::min(least, 1.0 - bend * bend);
        const Vector shin{thigh * cosine(angles[n]) - ankle.x, -ankle.y, -thigh * sine(angles[n]) - ankle.z};
        shins[n] = turned_z(shin, leg_angle(i));
    }
    const double spread = spread_of(shins[0], shins[1], shins[2]);
    if (!(spread >= 0)) {
        return Status::UNREACHABLE;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        angles[i] = nearest_turn(angles[i], joints[i]);
    }
    std::copy(pose.c.begin(), pose.c.end(), joints);
    std::copy(angles.begin(), angles.end(), joints);
    return least > square(FLAT) && spread > FLAT ? Status::OK : Status::SINGULAR;
}

}  // namespace mw::kinematics
