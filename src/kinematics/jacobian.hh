// SPDX-License-Identifier: GPL-2.0-or-later
// Derivatives of joints by pose and of pose by joints, by finite differences: for models without analytic
// derivatives, including foreign modules.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

/// [joint][axis], in units of the joint per unit of the axis
struct Jacobian {
    std::array<std::array<double, geometry::AXIS_COUNT>, MAX_JOINTS> of{};
};

/// Central differences over +-`step` [machine units and degrees] of the axes in `axes` (bit per axis; other
/// columns are 0). SINGULAR or UNREACHABLE if an adjacent pose has this status. `joints` belong to the pose.
Status joints_by_pose(const Kinematics &model, const Pose &pose, const double *joints, unsigned axes,
                      double step, Jacobian &out) noexcept;

/// Derivatives of the pose, over +-`step` of the first `count` joints.
Status pose_by_joints(const Kinematics &model, const double *joints, int count, const Pose &pose, double step,
                      Jacobian &out) noexcept;

}  // namespace mw::kinematics
