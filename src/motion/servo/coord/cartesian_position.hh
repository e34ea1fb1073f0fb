// SPDX-License-Identifier: GPL-2.0-or-later
// Position of the machine as a pose: commanded and measured.
#pragma once

#include "base/geometry/pose.hh"
#include "kinematics/kinematics.hh"
#include "motion/interface/status.hh"

namespace mw::motion {

class CartesianPosition {
  public:
    const geometry::Pose &cmd() const noexcept { return cmd_; }
    /// Measured.
    const geometry::Pose &fb() const noexcept { return fb_; }
    /// Speed of X Y Z [machine units/s].
    double velocity() const noexcept { return velocity_; }
    bool isFbValid() const noexcept { return fb_valid_; }

    /// The measured pose. Iterative forward kinematics need a homed machine. If they fail, the commanded pose
    /// is used.
    [[gnu::hot]] void read_feedback(const kinematics::Kinematics &kinematics, const double *joints,
                                    bool areAllHomed) noexcept;
    /// The joints are commanded. The commanded pose follows them if the kinematics finds a pose.
    void follow_joints(const kinematics::Kinematics &kinematics, const double *joints, bool isKnown) noexcept;
    /// Finds the pose of joints that have just been homed. Iterative forward kinematics start from the
    /// previous pose and, if that fails, from `first`, because the previous pose may be far away.
    void find_again(const kinematics::Kinematics &kinematics, const double *joints,
                    const geometry::Pose &first) noexcept;
    /// The pose is commanded.
    void follow_pose(const geometry::Pose &pose, double period_s) noexcept;
    /// Sets the commanded pose of the stopped machine, for other kinematics.
    void set_cmd(const geometry::Pose &pose) noexcept { cmd_ = pose; }
    /// Sets the assumed position of an axis before homing.
    void assume(int axis, double position) noexcept { cmd_[axis] = fb_[axis] = position; }

    void fill(Status &status) const noexcept;

  private:
    geometry::Pose cmd_, fb_;
    double velocity_ = 0;
    bool fb_valid_ = false;
};

}  // namespace mw::motion
