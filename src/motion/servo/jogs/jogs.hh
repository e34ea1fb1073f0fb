// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of joints (free mode) and axes (teleop mode), by command and by hand wheel. Homing moves joints with
// the same planners.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "kinematics/kinematics.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"
#include "motion/servo/jogs/jog.hh"

namespace mw::motion {

/// Inputs of jogs of axes.
struct TeleopMachine {
    const kinematics::Kinematics &kinematics;
    const FoldedLimits &limits;
    const trajectory::JointLimits &joints;             ///< excluding the share of external offsets
    std::array<double, MAX_JOINTS> joint_positions{};  ///< without external offsets
    int num_joints = 0;
    double scale = 1;  ///< override
    double period_s = 1e-3;
    int side = 0;              ///< of the current pose (kinematics::Kinematics)
    std::uint32_t locked = 0;  ///< bit per axis that does not move because its lock is closed
};

struct TeleopStop {
    bool isNew = false;  ///< jogs stopped for the first time in this cycle
    int joint = -1;      ///< joint that would exceed its soft limits; -1: the kinematics has no solution
};
class Jogs {
  public:
    void use_joints(int count) noexcept { num_joints_ = count; }
    /// Bit per axis that the machine may have.
    void set_axes(std::uint32_t axes) noexcept { axes_ = axes; }
    int num_joints() const noexcept { return num_joints_; }
    std::uint32_t axes() const noexcept { return axes_; }
    Jog &at(const JogTarget &target) noexcept {
        const auto i = static_cast<std::size_t>(target.index);
        return target.isJoint ? joint_[i] : axis_[i];
    }
    const Jog &at(const JogTarget &target) const noexcept {
        const auto i = static_cast<std::size_t>(target.index);
        return target.isJoint ? joint_[i] : axis_[i];
    }
    /// True if the joint or axis exists and can be jogged.
    bool hasTarget(const JogTarget &target) const noexcept;
    /// Hard limits are ignored until the next jog has ended.
    bool areLimitsOverridden() const noexcept { return limits_overridden_; }

    /// Checks whether a jog may start. `direction` > 0, < 0, or 0 if unknown.
    Reason check(const JogTarget &target, double direction, const JogSituation &situation) const noexcept;
    CommandResult take(const JogContinuous &command, const JogSituation &situation) noexcept;
    CommandResult take(const JogIncremental &command, const JogSituation &situation) noexcept;
    CommandResult take(const JogAbsolute &command, const JogSituation &situation) noexcept;
    CommandResult take(const JogStop &command) noexcept;
    CommandResult take(const OverrideLimits &command) noexcept;
    /// Jogs every axis at its own speed; axes with speed 0 stop. If one is rejected, none moves. `situations`
    /// has one element per axis.
    CommandResult take(const SetTeleopVector &command, const JogSituation *situations) noexcept;
    /// A wheel is not a command: a request for an impossible move is ignored.
    void jog_by_wheel(const JogTarget &target, double distance, const WheelInput &wheel,
                      const JogSituation &situation) noexcept;

    /// Ends one lease that was not renewed in time, and brakes its jog. Returns the joint or axis to report,
    /// or index -1 when none is left. Call it in each cycle before jogs move, until it returns -1.
    [[gnu::hot]] JogTarget end_lease(std::int64_t time_ns) noexcept;
    /// Called after wheels and commands of a cycle: records counts and ends jogs that have stopped.
    void settle(const Inputs &in) noexcept;
    /// If joints are not axes: moves the axes for one cycle. Stops all jogs before a joint exceeds its soft
    /// limits.
    TeleopStop step_teleop(const TeleopMachine &machine) noexcept;

    /// Every jog brakes.
    void stop() noexcept;
    /// Stops every jog in this cycle, without the limits of the drives.
    void stop_at_once() noexcept;
    /// Removes the sources of all jogs.
    void forget_sources() noexcept;
    /// Sets the axes to the position of the stopped machine.
    void reset_axes(const geometry::Pose &pose) noexcept;
    /// Sets joints and axes of the stopped machine, and removes the sources. `joint_positions` has MAX_JOINTS
    /// elements.
    void rest_at(const double *joint_positions, const geometry::Pose &pose) noexcept;
    /// As rest_at() when the machine is switched on; wheel counts start from here.
    void start_at(const double *joint_positions, const geometry::Pose &pose, const Inputs &in) noexcept;
    bool areJointsAtRest() const noexcept;
    bool areAxesAtRest() const noexcept;

    void fill(Mode mode, const geometry::Pose &pose, Outputs &out) const noexcept;

  private:
    Reason start(const JogTarget &target, const JogMove &move, const JogSituation &s) noexcept;
    Reason start_continuous(const JogTarget &target, double velocity, const JogSituation &s) noexcept;
    Reason start_leased(const JogContinuous &command, const JogSituation &s) noexcept;
    CommandResult start_to(const JogTarget &target, double position, double velocity,
                           const JogSituation &s) noexcept;
    void begin_lease(const JogContinuous &command, std::int64_t time_ns) noexcept;
    bool isRenewable(const JogContinuous &command) const noexcept;
    Reason check_axis(int axis, double velocity, const JogSituation &situation) const noexcept;
    void fill_positions(const geometry::Pose &pose, Outputs &out) const noexcept;

    int num_joints_ = 0;
    bool limits_overridden_ = false;
    bool override_used_ = false;   ///< the jog that ends the override has started
    bool any_jogged_ = false;      ///< by command or wheel, in this cycle
    bool teleop_stopped_ = false;  ///< stopped by a joint limit, and reported
    std::uint32_t axes_ = ALL_AXES;
    std::uint32_t leased_ = 0;  ///< bit per joint, then per axis, with a lease that has not ended
    std::array<Jog, MAX_JOINTS> joint_{};
    std::array<Jog, MAX_AXES> axis_{};
};

}  // namespace mw::motion
