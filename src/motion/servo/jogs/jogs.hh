// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of joints (free mode) and axes (teleop mode), by command and by hand wheel. Homing moves joints with
// the same planners.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/homing/homing.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

/// Source of a jog.
enum class JogSource : std::uint8_t { NONE, KEYBOARD, WHEEL };

/// Time after which a continuous jog ends if it is not renewed.
struct JogLease {
    std::int64_t length_ns = 0, end_ns = 0;
    bool isForward = true;  ///< of the jog that it belongs to
};

struct alignas(64) Jog {
    JogSource source = JogSource::NONE;
    std::int32_t wheel_counts = 0;
    JogLimits wanted;                  ///< before the override and the joints limit them
    double most_velocity = UNBOUNDED;  ///< limit of the override
    double brake_acceleration = 0;     ///< deceleration of a stop: a wheel cannot reduce it
    JogLease lease;
    trajectory::AxisMotion planner;  ///< with the current limits
};

struct Jogs {
    int num_joints = 0;
    bool areLimitsOverridden = false;  ///< until the next jog has ended
    bool isOverrideInJog = false;      ///< that jog has begun
    bool isAnyJogged = false;          ///< by command or wheel, as of this cycle
    bool isTeleopStopped = false;      ///< by a joint's limit, and reported
    std::uint32_t axes = ALL_AXES;     ///< bit per axis that the machine may have
    std::uint32_t leased = 0;          ///< bit per joint, then per axis, whose lease has not ended
    std::array<Jog, MAX_JOINTS> joint{};
    std::array<Jog, MAX_AXES> axis{};

    Jog &at(const JogTarget &target) noexcept {
        const auto i = static_cast<std::size_t>(target.index);
        return target.isJoint ? joint[i] : axis[i];
    }
    const Jog &at(const JogTarget &target) const noexcept {
        const auto i = static_cast<std::size_t>(target.index);
        return target.isJoint ? joint[i] : axis[i];
    }
};

/// True if the joint or axis exists and can be jogged.
bool hasTarget(const Jogs &jogs, const JogTarget &target) noexcept;

/// Conditions and limits of a jog of one joint or axis.
struct JogSituation {
    bool isReady = false;  ///< machine on and not stopping
    Mode mode = Mode::FREE;
    bool isHoming = false, isInhibited = false;
    bool isMovable = false;        ///< the joint is active; a joint moves the axis
    bool isSynchronised = false;   ///< a joint that homes with others is not jogged alone
    bool isDriven = false;         ///< by a pin
    bool isLocked = false;         ///< a lock is opened for the jog
    bool isShared = false;         ///< an axis of a machine whose joints are not axes
    bool isBesideIndexer = false;  ///< something else moves, or one of the two is locked
    bool isOnPosLimit = false, isOnNegLimit = false;
    JogLimits most;
    JogRange range;
    std::int64_t time_ns = 0;  ///< now
};

/// Whether a jog may start at all; `direction` > 0, < 0, or 0 when not yet known.
Reason check(const Jogs &jogs, const JogTarget &target, double direction,
             const JogSituation &situation) noexcept;

CommandResult take(Jogs &jogs, const JogContinuous &command, const JogSituation &situation) noexcept;
CommandResult take(Jogs &jogs, const JogIncremental &command, const JogSituation &situation) noexcept;
CommandResult take(Jogs &jogs, const JogAbsolute &command, const JogSituation &situation) noexcept;
CommandResult take(Jogs &jogs, const JogStop &command) noexcept;
CommandResult take(Jogs &jogs, const OverrideLimits &command) noexcept;
/// One axis of SetTeleopVector, after all of them were checked: at 0 it stops.
Reason check_axis_jog(const Jogs &jogs, int axis, double velocity, const JogSituation &situation) noexcept;
void jog_axis(Jogs &jogs, int axis, double velocity, const JogSituation &situation) noexcept;
/// Jogs every axis at its own speed, and stops those at 0. If one is rejected, none moves. `situations` has
/// one for each axis.
CommandResult take(Jogs &jogs, const SetTeleopVector &command, const JogSituation *situations) noexcept;

/// Ends one lease that was not renewed in time, and its jog brakes. Returns the joint or axis to report,
/// index -1 when there is none left. Called in each cycle, before the jogs move, until it returns -1.
[[gnu::hot]] JogTarget end_lease(Jogs &jogs, std::int64_t time_ns) noexcept;

/// After a change of the limits: a jog ends at the end of its range; one that moves away from the range
/// brakes.
void keep_within(Jog &jog, const JogRange &range) noexcept;
/// Every jog brakes.
void stop(Jogs &jogs) noexcept;
/// Stops every jog in this cycle, without the limits of the drives.
void stop_at_once(Jogs &jogs) noexcept;
/// Removes the sources of all jogs.
void forget_sources(Jogs &jogs) noexcept;
/// Sets the axes, stopped, to the position of the machine.
void reset_axes(Jogs &jogs, const geometry::Pose &pose) noexcept;
/// Sets joints and axes, stopped, and removes the sources. `joint_positions` has MAX_JOINTS elements.
void rest_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose) noexcept;
/// The same when the machine is switched on: counts of wheels start here.
void start_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose,
              const Inputs &in) noexcept;
bool areJointsAtRest(const Jogs &jogs) noexcept;
bool areAxesAtRest(const Jogs &jogs) noexcept;

/// Counts of the wheel since the last cycle that are to move something; 0 for none.
double turned(Jog &jog, const WheelInput &wheel) noexcept;
/// A wheel that requests an impossible move is ignored: it is no command.
void jog_by_wheel(Jogs &jogs, const JogTarget &target, double distance, const WheelInput &wheel,
                  const JogSituation &situation) noexcept;
/// After wheels and commands of a cycle: keeps the counts, and ends jogs that have stopped.
void settle(Jogs &jogs, const Inputs &in) noexcept;

/// Changes the position of a joint without motion; the rest of its move becomes longer by `shift`.
void renumber(Jog &jog, double position, double shift) noexcept;
/// Command of homing to a joint in this cycle.
void home_joint(Jog &jog, const homing::JointCommand &command, const JogLimits &most) noexcept;
/// The override applies to an axis that moves; on machines whose joints are axes.
void limit_axis(Jog &jog, double max_velocity, double scale) noexcept;
/// Continues the move of a joint for one period.
void step_joint(Jog &jog, double max_velocity, double scale, double period_s) noexcept;

void fill(const Jogs &jogs, Mode mode, const geometry::Pose &pose, Outputs &out) noexcept;

}  // namespace mw::motion
