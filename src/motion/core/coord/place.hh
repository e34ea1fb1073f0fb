// SPDX-License-Identifier: GPL-2.0-or-later
// Where the machine is as a pose: commanded and measured.
#pragma once

#include "geom/pose.hh"
#include "kins/kinematics.hh"
#include "motion/api/status.hh"

namespace mw::motion {

struct Place {
    geom::Pose cmd, fb;
    double velocity = 0;  ///< of X Y Z [machine units/s]
    bool isFbValid = false;
};

/// The measured pose. Forward kinematics of an iterating model wants a homed machine; where a model has none
/// the command stands in.
[[gnu::hot]] void read_feedback(Place &place, const kins::Kinematics &kinematics, const double *joints,
                                bool areAllHomed) noexcept;
/// Joints lead; the commanded pose follows them where it is known.
void follow_joints(Place &place, const kins::Kinematics &kinematics, const double *joints,
                   bool isKnown) noexcept;
/// The pose of joints that have just been homed. Forward kinematics that iterate look from where the pose was
/// and, where that leads nowhere, from `first`: what was lost need not be near.
void find_again(Place &place, const kins::Kinematics &kinematics, const double *joints,
                const geom::Pose &first) noexcept;
/// The pose leads.
void follow_pose(Place &place, const geom::Pose &pose, double period_s) noexcept;
void fill(const Place &place, Status &status) noexcept;

}  // namespace mw::motion
