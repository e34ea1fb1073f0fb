// SPDX-License-Identifier: GPL-2.0-or-later
// Where the machine may go: soft limits of the axes, and joints that are not axes.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/path/joint_map.hh"
#include "trajectory/path/limits.hh"

namespace mw::trajectory {

/// Where some joints are kept, within their soft limits.
struct JointRoom {
    std::uint32_t joints = 0;  ///< bit per joint
    std::array<double, MAX_JOINTS> low{}, high{};
};

struct Workspace {
    Pose low, high;                 ///< soft limits of the axes; the path stays within them
    const JointMap *map = nullptr;  ///< null: the axes' limits are all there are
    JointLimits joints;             ///< with a map
    JointRoom joint_room;           ///< the same

    Workspace() noexcept {
        low.c.fill(-UNLIMITED);
        high.c.fill(UNLIMITED);
    }
    bool isMapped() const noexcept { return map != nullptr; }
    /// Within the soft limits of the axes and the room of joints that have one.
    bool holds(const Pose &pose) const noexcept;
    /// What of `shift` leaves the moved corner within the soft limits. The commanded path runs inside of the
    /// corners, so it keeps them as well.
    Pose shift_within(const Pose &corner, const Pose &shift) const noexcept;
};

/// Largest derivatives of each joint along a piece, by differences of the inverse kinematics. With
/// curvatures, one for each joint, q1 is the length of both as on a circle of that, where they are at right
/// angles.
void sample_rows(const PathStore &store, const Piece &piece, const Workspace &workspace,
                 const double *curvatures, LimitRow *rows) noexcept;

/// The limit of a piece, lowered to what its joints can follow: their derivatives along it by differences of
/// the inverse kinematics. `filter_s`: the averaging time, 0 without jerk limits.
SpeedLimit limit_with_joints(const PathStore &store, const Piece &piece, const Workspace &workspace,
                             double filter_s, const SpeedLimit &limit) noexcept;

}  // namespace mw::trajectory
