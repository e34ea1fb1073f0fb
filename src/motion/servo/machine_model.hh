// SPDX-License-Identifier: GPL-2.0-or-later
// The configured machine: joints in use, kinematics, settings, and the resulting limits.
#pragma once

#include <cstdint>

#include "kinematics/kinematics.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/controller_config.hh"
#include "motion/servo/coord/joint_continuity.hh"
#include "motion/servo/coord/retracing.hh"

namespace mw::motion {

/// The limits always follow from the settings, the joints in use and the homed joints of the last fold().
class MachineModel {
  public:
    /// `kinematics` outlives it.
    MachineModel(const ControllerConfig &config, const kinematics::Kinematics &kinematics) noexcept
        : config_(config), kinematics_(&kinematics) {}

    int num_joints() const noexcept { return config_.num_joints; }
    /// Joints that a pose moves; the others are extra joints.
    int num_pose_joints() const noexcept { return config_.num_pose_joints(); }
    int num_extra_joints() const noexcept { return config_.num_extra_joints; }
    int num_spindles() const noexcept { return config_.num_spindles; }
    double period_s() const noexcept { return config_.period_s; }
    const kinematics::Kinematics &kinematics() const noexcept { return *kinematics_; }
    const Settings &settings() const noexcept { return settings_; }
    const AxisMap &map() const noexcept { return map_; }
    const FoldedLimits &limits() const noexcept { return limits_; }
    /// Counts changes of limits().
    std::uint32_t limits_version() const noexcept { return limits_version_; }

    /// Uses the first `count` joints. fold() must follow.
    void use_joints(int count) noexcept;
    /// fold() must follow.
    Reason set(const SetParameter &command) noexcept;
    /// Calculates the limits again.
    void fold(const HomedJoints &homed) noexcept;

    /// Limits per servo cycle of the joints that a pose moves.
    JointStepLimit joint_step_limit() const noexcept {
        return {limits_.joints.velocity.data(), config_.period_s, config_.num_pose_joints()};
    }
    RetraceLimits retrace_limits() const noexcept {
        return {limits_, map_.areJointsAxes() ? 0 : config_.num_pose_joints(), config_.period_s};
    }

  private:
    ControllerConfig config_;
    const kinematics::Kinematics *kinematics_;
    Settings settings_;
    AxisMap map_;
    FoldedLimits limits_;
    std::uint32_t limits_version_ = 0;
};

}  // namespace mw::motion
