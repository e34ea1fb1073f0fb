// SPDX-License-Identifier: GPL-2.0-or-later
// Position of the machine as a pose: commanded and measured.
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

/// The measured pose. Forward kinematics of an iterating model needs a homed machine. Where it fails, the
/// commanded pose is used.
[[gnu::hot]] void read_feedback(CartesianPosition &place, const kinematics::Kinematics &kinematics,
                                const double *joints, bool areAllHomed) noexcept;
/// Joints are commanded; the commanded pose follows them where it is known.
void follow_joints(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                   bool isKnown) noexcept;
/// The pose of joints that have just been homed. Iterating forward kinematics start from the previous pose
/// and, if that fails, from `first`: the lost position may be far away.
void find_again(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                const geometry::Pose &first) noexcept;
/// The pose is commanded.
void follow_pose(CartesianPosition &place, const geometry::Pose &pose, double period_s) noexcept;
void fill(const CartesianPosition &place, Status &status) noexcept;

}  // namespace mw::motion
