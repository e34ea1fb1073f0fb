// SPDX-License-Identifier: GPL-2.0-or-later
// Where the machine is as a pose: commanded and measured.
#pragma once

#include "base/geometry/pose.hh"
#include "kinematics/kinematics.hh"
#include "motion/interface/status.hh"

namespace mw::motion {

struct CartesianPosition {
    geometry::Pose cmd, fb;
    double velocity = 0;  ///< of X Y Z [machine units/s]
    bool isFbValid = false;
};

/// The measured pose. Forward kinematics of an iterating model wants a homed machine; where a model has none
/// the command stands in.
[[gnu::hot]] void read_feedback(CartesianPosition &place, const kinematics::Kinematics &kinematics,
                                const double *joints, bool areAllHomed) noexcept;
/// Joints lead; the commanded pose follows them where it is known.
void follow_joints(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                   bool isKnown) noexcept;
/// The pose of joints that have just been homed. Forward kinematics that iterate look from where the pose was
/// and, where that leads nowhere, from `first`: what was lost need not be near.
void find_again(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                const geometry::Pose &first) noexcept;
/// The pose leads.
void follow_pose(CartesianPosition &place, const geometry::Pose &pose, double period_s) noexcept;
void fill(const CartesianPosition &place, Status &status) noexcept;

}  // namespace mw::motion
