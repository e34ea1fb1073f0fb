// SPDX-License-Identifier: GPL-2.0-or-later
// Six rotary joints. The axes of the last three meet in one point, the wrist: the first three joints position
// the wrist, the last three orient the hand. Header-only and realtime-safe.
#pragma once

#include <algorithm>

#include "kinematics/frame.hh"
#include "kinematics/kinematics.hh"

namespace mw::kinematics {

/// The joints for a pose of the hand, which is `hand_length` from the wrist along its Z. `place(wrist,
/// joints)` calculates joints 0 to 2, then `turn(hand, joints)` joints 3 to 5; both return a Status. Without
/// a solution the joints are not changed.
template <class Place, class Turn>
Status inverse_by_wrist(const Pose &pose, double hand_length, double *joints, const Place &place,
                        const Turn &turn) noexcept {
    constexpr int JOINTS = 6;
    if (!isFinite(pose) || !areFinite(joints, JOINTS)) {
        return Status::UNREACHABLE;
    }
    const Rotation hand = rotation_of(pose);
    double found[JOINTS];
    std::copy_n(joints, JOINTS, found);
    const Status placed = place(place_of(pose) - hand.z * hand_length, found);
    if (placed == Status::UNREACHABLE) {
        return placed;
    }
    const Status turned = turn(hand, found);
    std::copy_n(found, JOINTS, joints);
    std::copy_n(pose.c.begin() + geometry::AXIS_U, 3, joints + JOINTS);
    return placed == Status::OK ? turned : placed;
}

}  // namespace mw::kinematics
