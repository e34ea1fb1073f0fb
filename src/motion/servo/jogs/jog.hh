// SPDX-License-Identifier: GPL-2.0-or-later
// The jog of one joint or axis. Homing moves joints with it, too.
#pragma once

#include <cstdint>

#include "motion/homing/homing.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

/// Source of a jog.
enum class JogSource : std::uint8_t { NONE, KEYBOARD, WHEEL };

/// Time after which a continuous jog ends if it is not renewed.
struct JogLease {
    std::int64_t length_ns = 0, end_ns = 0;
    bool isForward = true;  ///< direction of the jog that has the lease
};

/// Conditions and limits of a jog of one joint or axis.
struct JogSituation {
    bool isReady = false;  ///< machine on and not stopping
    Mode mode = Mode::FREE;
    bool isHoming = false, isInhibited = false;
    bool isMovable = false;        ///< the joint is active, or a joint moves the axis
    bool isSynchronised = false;   ///< a joint that homes with others cannot be jogged alone
    bool isDriven = false;         ///< by a pin
    bool isLocked = false;         ///< the jog needs an open lock
    bool isShared = false;         ///< an axis of a machine whose joints are not axes
    bool isBesideIndexer = false;  ///< something else moves, or one of the two axes is locked
    bool isOnPosLimit = false, isOnNegLimit = false;
    MotionLimits limits;
    JogRange range;
    std::int64_t time_ns = 0;  ///< now
};

/// A checked request of a jog.
struct JogMove {
    double position = 0, velocity = 0;
    JogSource source = JogSource::NONE;
};

class alignas(64) Jog {
  public:
    /// Position, speed, target and current limits.
    const trajectory::AxisMotion &motion() const noexcept { return motion_; }
    bool isAtRest() const noexcept { return motion_.isAtRest(); }
    JogSource source() const noexcept { return source_; }
    /// Requested limits, before the override and the joints reduce them.
    const MotionLimits &wanted() const noexcept { return wanted_; }

    /// Starts a jog; rejects a target outside the range.
    Reason start(const JogMove &move, const JogSituation &situation) noexcept;
    /// Changes the speed of a jog but not its target, so a jog that is stopped at a limit stays there.
    void renew(double velocity, const JogSituation &situation) noexcept;
    void begin_lease(double lease_s, bool isForward, std::int64_t time_ns) noexcept;
    const JogLease &lease() const noexcept { return lease_; }
    /// True while the jog has a source. A jog that has stopped loses its source.
    bool update_source() noexcept;
    void forget_source() noexcept { source_ = JogSource::NONE; }

    /// Counts of the wheel since the last cycle; 0 if nothing moves.
    double turned(const WheelInput &wheel) noexcept;
    void set_wheel_counts(std::int32_t counts) noexcept { wheel_counts_ = counts; }
    /// A wheel jog uses a fraction of the acceleration limit.
    void reduce_acceleration(double fraction, bool isShared) noexcept;

    /// Stops with full acceleration.
    void brake() noexcept;
    /// Stops with the current limits.
    void stop() noexcept { motion_.stop(); }
    /// Stops in this cycle, without the limits of the drives.
    void stop_at_once() noexcept { motion_.reset(motion_.position); }
    /// Called after a change of the limits. Ends the jog at the end of the range; brakes it if it moves away
    /// from the range.
    void keep_within(const JogRange &range) noexcept;
    /// Stopped, at another position.
    void reset(double position) noexcept { motion_.reset(position); }
    /// Changes the position without motion; the remaining distance grows by `shift`.
    void renumber(double position, double shift) noexcept { motion_.renumber(position, shift); }
    /// Executes the homing command of this cycle.
    void home(const homing::JointCommand &command, const MotionLimits &limits) noexcept;

    /// Applies the override to an axis that moves; used if joints are axes.
    void limit(double max_velocity, double scale) noexcept;
    /// Sets limits that the joints reduce.
    void set_limits(const MotionLimits &limits) noexcept;
    void step(double period_s) noexcept { motion_.step(period_s); }
    /// Continues the move of a joint for one period.
    void step_joint(double max_velocity, double scale, double period_s) noexcept;

  private:
    JogSource source_ = JogSource::NONE;
    std::int32_t wheel_counts_ = 0;
    MotionLimits wanted_;
    double max_velocity_ = UNBOUNDED;  ///< limit of the override
    double brake_acceleration_ = 0;    ///< for a stop, also if a wheel uses a fraction
    JogLease lease_;
    trajectory::AxisMotion motion_;
};

}  // namespace mw::motion
