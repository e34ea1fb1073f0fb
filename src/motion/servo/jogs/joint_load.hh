// SPDX-License-Identifier: GPL-2.0-or-later
// What jogs of axes require of joints that are not axes: derivatives of the joints by the moving axes, and
// the velocity, acceleration and jerk of joints that follow from those of the axes:
//   q' = sum q_i v_i,  q'' = sum q_i a_i + sum q_ik v_i v_k,  q''' = sum q_i j_i + 3 sum q_ik v_i a_k + q_ikl
//   v_i v_k v_l
#pragma once

#include <array>

#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {

using JointsAt = std::array<double, MAX_JOINTS>;
/// Of each axis that is to move, in the order of JointLoad::axes.
using AxisValues = std::array<double, MAX_AXES>;

/// Velocity, acceleration and jerk of each axis that is to move; jerk 0: none.
struct AxisDemand {
    AxisValues velocity{}, acceleration{}, jerk{};
};

/// Largest magnitudes of the derivatives over some positions, without a margin.
struct JointLoad {
    std::array<int, MAX_AXES> axes{};
    int count = 0;
    std::array<JointsAt, MAX_AXES> q1{};
    std::array<std::array<JointsAt, MAX_AXES>, MAX_AXES> q2{};
    std::array<JointsAt, MAX_AXES> q3{};  ///< along one axis alone
    JointsAt q3_together{};               ///< along `direction`, where several axes are to move
    AxisValues direction{};               ///< of length 1
    bool hasJerk = false;                 ///< third derivatives are needed
};

/// The joint positions nearest to the current ones. False also where a pose can only be reached through a
/// singular one.
bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept;

/// Includes the derivatives at a pose; false when the kinematics has no solution there or beside it.
bool add_pose(const TeleopMachine &m, const geometry::Pose &pose, JointLoad &load) noexcept;

/// What the joints allow the axes of `members` (bit per axis) together, at most `wanted`: they share each
/// joint in proportion to what they want of it.
AxisDemand allowed_demand(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                          const AxisDemand &wanted) noexcept;

/// No joint exceeds a limit while the axes of `members` move with at most this.
bool isWithinJoints(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                    const AxisDemand &demand) noexcept;

}  // namespace mw::motion
