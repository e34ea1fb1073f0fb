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
    /// Of X Y Z [machine units/s].
    double velocity() const noexcept { return velocity_; }
    bool isFbValid() const noexcept { return fb_valid_; }

    /// The measured pose. Forward kinematics of an iterating model needs a homed machine. Where it fails, the
    /// commanded pose is used.
    [[gnu::hot]] void read_feedback(const kinematics::Kinematics &kinematics, const double *joints,
                                    bool areAllHomed) noexcept;
    /// Joints are commanded; the commanded pose follows them where it is known.
    void follow_joints(const kinematics::Kinematics &kinematics, const double *joints, bool isKnown) noexcept;
    /// The pose of joints that have just been homed. Iterating forward kinematics start from the previous
    /// pose and, if that fails, from `first`: the lost position may be far away.
    void find_again(const kinematics::Kinematics &kinematics, const double *joints,
                    const geometry::Pose &first) noexcept;
    /// The pose is commanded.
    void follow_pose(const geometry::Pose &pose, double period_s) noexcept;
    /// The stopped machine has another commanded pose, by other kinematics.
    void set_cmd(const geometry::Pose &pose) noexcept { cmd_ = pose; }
    /// Before homing: assumed position of an axis.
    void assume(int axis, double position) noexcept { cmd_[axis] = fb_[axis] = position; }

    void fill(Status &status) const noexcept;

  private:
    geometry::Pose cmd_, fb_;
    double velocity_ = 0;
    bool fb_valid_ = false;
};

}  // namespace mw::motion
