// SPDX-License-Identifier: GPL-2.0-or-later
// Workspace of the machine: soft limits of the axes and of joints that are not axes.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/path/joint_map.hh"
#include "trajectory/path/limits.hh"

namespace mw::trajectory {

/// Ranges of some joints within their soft limits.
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
    Pose low, high;                 ///< soft limits of the axes, which the path does not exceed
    const JointMap *map = nullptr;  ///< null: only the limits of the axes apply
    JointLimits joints;             ///< valid with a map
    JointRoom joint_room;           ///< valid with a map
    LinearJoints linear;            ///< valid with a map

    Workspace() noexcept {
        low.c.fill(-UNLIMITED);
        high.c.fill(UNLIMITED);
    }
    bool isMapped() const noexcept { return map != nullptr; }
    /// Lower and upper limit of a joint.
    double low_of(std::size_t joint) const noexcept {
        return isKept(joint) ? joint_room.low[joint] : joints.low[joint];
    }
    double high_of(std::size_t joint) const noexcept {
        return isKept(joint) ? joint_room.high[joint] : joints.high[joint];
    }
    /// True if the pose is within the soft limits of the axes and the ranges of joints.
    bool holds(const Pose &pose) const noexcept;
    /// Maximum deviation of a path from a move, up to `tolerance`, that keeps joints that are not linear
    /// within their soft limits; 0 if the move itself reaches a limit.
    double tolerance_within(const Primitive &move, double tolerance) const noexcept;

  private:
    using PerJoint = std::array<double, MAX_JOINTS>;
    bool isKept(std::size_t joint) const noexcept { return (joint_room.joints >> joint & 1U) != 0; }
    bool isLinear(std::size_t joint) const noexcept { return (linear.joints >> joint & 1U) != 0; }
    bool take_reach(const Pose &pose, double tolerance, PerJoint &reach) const noexcept;
    double least_share(const Primitive &move, int samples, const PerJoint &reach) const noexcept;
};

}  // namespace mw::trajectory
