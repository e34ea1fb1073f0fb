// SPDX-License-Identifier: GPL-2.0-or-later
// Use of joint limits by jogs of axes if joints are not axes: derivatives of the joints by the moving axes,
// and the joint velocity, acceleration and jerk that follow from those of the axes:
// q' = sum q_i v_i,
// q'' = sum q_i a_i + sum q_ik v_i v_k,
// q''' = sum q_i j_i + 3 sum q_ik v_i a_k + q_ikl v_i v_k v_l
#pragma once

#include <array>

#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {

using JointsAt = std::array<double, MAX_JOINTS>;
/// One value for each axis that will move, in the order of JointLoad::axes.
using AxisValues = std::array<double, MAX_AXES>;

/// Velocity, acceleration and jerk of each axis that will move; jerk 0: no limit.
struct AxisDemand {
    AxisValues velocity{}, acceleration{}, jerk{};
};

/// Largest absolute derivatives over the sampled positions, without a margin.
struct JointLoad {
    std::array<int, MAX_AXES> axes{};
    int count = 0;
    std::array<JointsAt, MAX_AXES> q1{};
    std::array<std::array<JointsAt, MAX_AXES>, MAX_AXES> q2{};
    std::array<JointsAt, MAX_AXES> q3{};  ///< along one axis alone
    JointsAt q3_together{};               ///< along `direction`, if several axes will move
    AxisValues direction{};               ///< of length 1
    bool hasJerk = false;                 ///< third derivatives are needed
};

/// The joint positions nearest to the current ones. False if a pose cannot be reached, or only through a
/// singular pose.
bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept;

/// Adds the derivatives at a pose; false if the kinematics has no solution there or at the samples around it.
bool add_pose(const TeleopMachine &m, const geometry::Pose &pose, JointLoad &load) noexcept;

/// The demand that the joints allow the axes of `members` (bit per axis) together, at most `wanted`. The axes
/// share each joint in proportion to their demands.
AxisDemand allowed_demand(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                          const AxisDemand &wanted) noexcept;

/// True if no joint exceeds a limit while the axes of `members` move with at most this demand.
bool isWithinJoints(const TeleopMachine &m, const JointLoad &load, std::uint32_t members,
                    const AxisDemand &demand) noexcept;

}  // namespace mw::motion
