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

/// Joints that move in proportion to axes.
struct LinearJoints {
    std::uint32_t joints = 0;  ///< bit per joint
    std::array<Pose, MAX_JOINTS> slope{};
};

struct Workspace {
    Pose low, high;                 ///< soft limits of the axes; the path stays within them
    const JointMap *map = nullptr;  ///< null: the axes' limits are all there are
    JointLimits joints;             ///< with a map
    JointRoom joint_room;           ///< the same
    LinearJoints linear;            ///< the same

    Workspace() noexcept {
        low.c.fill(-UNLIMITED);
        high.c.fill(UNLIMITED);
    }
    bool isMapped() const noexcept { return map != nullptr; }
    /// Where a joint may be.
    double low_of(std::size_t joint) const noexcept {
        return isKept(joint) ? joint_room.low[joint] : joints.low[joint];
    }
    double high_of(std::size_t joint) const noexcept {
        return isKept(joint) ? joint_room.high[joint] : joints.high[joint];
    }
    /// Within the soft limits of the axes and the room of joints that have one.
    bool holds(const Pose &pose) const noexcept;
    /// The largest part of `tolerance` that a path may deviate from a move without leaving the soft limits of
    /// joints that are not linear; 0 where the move itself is at one of them.
    double tolerance_within(const Primitive &move, double tolerance) const noexcept;

  private:
    using PerJoint = std::array<double, MAX_JOINTS>;
    bool isKept(std::size_t joint) const noexcept { return (joint_room.joints >> joint & 1U) != 0; }
    bool isLinear(std::size_t joint) const noexcept { return (linear.joints >> joint & 1U) != 0; }
    bool take_reach(const Pose &pose, double tolerance, PerJoint &reach) const noexcept;
    double least_share(const Primitive &move, int samples, const PerJoint &reach) const noexcept;
};

}  // namespace mw::trajectory
