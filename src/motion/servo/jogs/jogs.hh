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

/// What a jog is driven by.
enum class JogSource : std::uint8_t { NONE, KEYBOARD, WHEEL };

/// How long a continuous jog goes on without being renewed.
struct JogLease {
    std::int64_t length_ns = 0, end_ns = 0;
    bool isForward = true;  ///< of the jog that it belongs to
};

/// What each cycle looks at of a jog that stands comes first and fills two lines of the cache: behind it are
/// the samples of its planner.
struct alignas(64) Jog {
    JogSource source = JogSource::NONE;
    std::int32_t wheel_counts = 0;
    double wanted_velocity = 0, wanted_acceleration = 0;  ///< before the override and joints limit them
    double most_velocity = UNBOUNDED;                     ///< that the override may make of it
    double brake_acceleration = 0;                        ///< what a stop takes: no wheel makes it gentler
    JogLease lease;
    trajectory::AxisTrajectory planner;
};

/// Of axes on machines whose joints are not axes, with jerk limits.
struct TeleopShares {
    std::uint32_t axes = 0;  ///< bit per axis that has a share of what the joints can do
    double calm_s = 0;       ///< for so long none of them has been faster than when all of `room` have one
    std::uint32_t room = 0;  ///< bit per axis: they do no more than when all of these have a share; 0: any
};

struct Jogs {
    int num_joints = 0;
    bool areLimitsOverridden = false;  ///< limit switches are, until the next jog has ended
    bool isOverrideInJog = false;      ///< that jog has begun
    bool isAnyJogged = false;          ///< by command or wheel, as of this cycle
    bool isTeleopStopped = false;      ///< by a joint's limit, and said
    std::uint32_t axes = ALL_AXES;     ///< bit per axis that the machine may have
    std::uint32_t leased = 0;          ///< bit per joint, then per axis, whose lease has not ended
    TeleopShares shares;
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

/// There is such a joint or axis to jog.
bool hasTarget(const Jogs &jogs, const JogTarget &target) noexcept;

/// What allows and bounds a jog of one joint or axis.
struct JogSituation {
    bool isReady = false;  ///< machine on, no stop under way
    Mode mode = Mode::FREE;
    bool isHoming = false, isInhibited = false;
    bool isMovable = false;        ///< the joint is active; a joint moves the axis
    bool isSynchronised = false;   ///< a joint that homes with others is not jogged alone
    bool isDriven = false;         ///< by a pin
    bool isLocked = false;         ///< a lock is opened for the jog
    bool isShared = false;         ///< an axis of a machine whose joints are not axes
    bool isBesideIndexer = false;  ///< something else moves, or one of the two is held by a lock
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
/// Every axis at its own speed, those at 0 stop; none of them where one is refused. `situations` has one for
/// each axis.
CommandResult take(Jogs &jogs, const SetTeleopVector &command, const JogSituation *situations) noexcept;

/// Ends one lease that was not renewed in time, and its jog brakes: the joint or axis of which that is to be
/// told, index -1 when there is none any more. Called until then, in each cycle before the jogs move.
[[gnu::hot]] JogTarget end_lease(Jogs &jogs, std::int64_t time_ns) noexcept;

/// After a change of the limits: a jog ends at the edge of its range, and one that leads away from it brakes.
void keep_within(Jog &jog, const JogRange &range) noexcept;
/// Every jog brakes.
void stop(Jogs &jogs) noexcept;
/// Every jog stands in this cycle, whatever that asks of the drives.
void stop_at_once(Jogs &jogs) noexcept;
/// Nothing drives any jog any more.
void forget_sources(Jogs &jogs) noexcept;
/// Axes stand where the machine is.
void reset_axes(Jogs &jogs, const geometry::Pose &pose) noexcept;
/// All of them do, and nothing drives them. `joint_positions` has MAX_JOINTS elements.
void rest_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose) noexcept;
/// The same when the machine is switched on: turns of wheels count from here.
void start_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose,
              const Inputs &in) noexcept;
bool areJointsAtRest(const Jogs &jogs) noexcept;
bool areAxesAtRest(const Jogs &jogs) noexcept;

/// How far the wheel has been turned since the last cycle, as far as that is to move something; 0: not at
/// all.
double turned(Jog &jog, const WheelInput &wheel) noexcept;
/// A wheel that asks for what is not possible is ignored: it is no command.
void jog_by_wheel(Jogs &jogs, const JogTarget &target, double distance, const WheelInput &wheel,
                  const JogSituation &situation) noexcept;
/// After wheels and commands of a cycle: counts are kept, jogs at rest have ended.
void settle(Jogs &jogs, const Inputs &in) noexcept;

/// The positions of a joint get other numbers; what is left of its move gets `shift` longer.
void renumber(Jog &jog, double position, double shift) noexcept;
/// What homing wants of a joint in this cycle.
void home_joint(Jog &jog, const homing::JointCommand &command, const JogLimits &most) noexcept;
/// The override acts on an axis that moves; on machines whose joints are axes.
void limit_axis(Jog &jog, double max_velocity, double scale) noexcept;
/// Goes on with the move of a joint for one period.
void step_joint(Jog &jog, double max_velocity, double scale, double period_s) noexcept;

void fill(const Jogs &jogs, Mode mode, const geometry::Pose &pose, Outputs &out) noexcept;

}  // namespace mw::motion
