// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid tapping: a motion along a line, locked to a spindle angle, to the bottom and back through the
// reversal. It uses only the position on the line and the measurements of the spindle. Formulas:
// docs/integrator/spindles.md.
#pragma once

#include <cstdint>

#include "trajectory/follow/spindle_pursuit.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

enum class TapPhase : std::uint8_t {
    WAITING,   ///< the tool is stopped at the start, or accelerates, until it reaches the helix
    IN,        ///< the tool follows the spindle to the bottom
    TURNING,   ///< the spindle is commanded to reverse
    BACK,      ///< the spindle runs in reverse, and the tool follows it out
    LEAVING,   ///< the spindle is commanded to run forward again
    HOME,      ///< the spindle runs forward; the tool returns to the start by itself
    STOPPING,  ///< abort: the spindle is off, and the tool follows it until it is stopped
    OVER,
};

/// The spindle is commanded to reverse ahead of the bottom by its overrun, so that it stops at the bottom.
/// The tool follows the measured angle all the time. So only this angle determines the actual reversal.
class TapFollower {
  public:
    /// Begins a tap at standstill at x = 0.
    void begin(const TapTerms &terms, const SpindleReading &spindle, double dt) noexcept;
    /// Filter rate for SpindleTrack [1/s].
    double rate() const noexcept { return pursuit_.rate(); }
    /// Aborts the tap: the spindle does not reverse, and the tool does not return.
    void stop(const SpindleReading &spindle) noexcept;
    /// Advances the tap by one cycle of `dt` [s].
    void step(const SpindleReading &spindle, double dt) noexcept;

    double x() const noexcept { return state_.x; }
    double v() const noexcept { return state_.v; }
    TapPhase phase() const noexcept { return phase_; }
    /// Commanded spindle speed, as a factor of the speed with which it was started; 0: off.
    double spindle_factor() const noexcept;
    /// True if the tool is at the start and has not moved.
    bool isWaiting() const noexcept { return phase_ == TapPhase::WAITING && state_.x <= 0 && state_.v <= 0; }
    bool isOver() const noexcept { return phase_ == TapPhase::OVER; }
    /// True if the tool has lost the helix: the spindle did not reverse in time, its angle jumped, or it was
    /// too fast.
    bool isLost() const noexcept { return lost_; }

  private:
    /// Spindle data; positive in the direction of the cut.
    struct Turning {
        double turned = 0;   ///< measured revolutions since the helix passed the start
        double speed = 0;    ///< [rev/s]
        double overrun = 0;  ///< revolutions to standstill after a reverse command now
        HelixState helix;
    };
    /// Range of jerks that keep the limits and the range of the line.
    struct JerkRange {
        double low = 0, high = 0;
    };
    Turning read(const SpindleReading &spindle) const noexcept;
    void decide(const Turning &t, double dt) noexcept;
    bool isFollowing(const Turning &t) noexcept;
    JerkRange jerk_range(double dt) const noexcept;
    bool isWithin(const MotionState &next, double side) const noexcept;
    void follow(const Turning &t, double dt) noexcept;
    void go_home(double dt) noexcept;
    double place_at_rest(const MotionState &from) const noexcept;
    void begin_run(double dt) noexcept;

    TapTerms terms_;
    MotionLimits limits_;
    TapPhase phase_ = TapPhase::OVER;
    double direction_ = 1;  ///< direction of the spindle's counts during the cut
    double origin_ = 0;     ///< counted revolutions at which the helix passes the start
    MotionState state_;
    SpindlePursuit pursuit_;
    SpeedChangeRun run_;  ///< a stop
    bool running_ = false, lost_ = false, stopped_ = false;
    /// Revolutions at the start of a stop, and maximum revolutions after it.
    double stop_turned_ = 0, run_out_ = 0;
};

}  // namespace mw::trajectory
