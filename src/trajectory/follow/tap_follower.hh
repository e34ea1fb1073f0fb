// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid tapping: along a line with the angle of a spindle, in, through the reversal and back. Knows only the
// place on the line and what is measured of the spindle. Formulas: docs/integrator/spindles.md.
#pragma once

#include <cstdint>

#include "trajectory/follow/spindle_pursuit.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

enum class TapPhase : std::uint8_t {
    WAITING,   ///< stands at the start, or gains speed, until it has met the helix
    IN,        ///< follows to the bottom
    TURNING,   ///< the spindle has been told to turn back
    BACK,      ///< it does, and the tool follows out
    LEAVING,   ///< the spindle has been told to turn forward again
    HOME,      ///< it does; the tool goes to the start by itself
    STOPPING,  ///< a stop: the spindle is off, the tool follows it until it is stopped
    OVER,
};

/// The ideas: the spindle is told to turn back so much before the bottom that it stands there; when it really
/// turns back is seen from its measured angle alone, which the tool follows all the time.
class TapFollower {
  public:
    /// From rest at x 0.
    void begin(const TapTerms &terms, const SpindleReading &spindle, double dt) noexcept;
    /// For SpindleTrack.
    double rate() const noexcept { return pursuit_.rate(); }
    /// An abort: no turning back, no way home.
    void stop(const SpindleReading &spindle) noexcept;
    /// One cycle of `dt`.
    void step(const SpindleReading &spindle, double dt) noexcept;

    double x() const noexcept { return state_.x; }
    double v() const noexcept { return state_.v; }
    TapPhase phase() const noexcept { return phase_; }
    /// Speed of the spindle that is wanted over that which it was started with; 0: off.
    double spindle_factor() const noexcept;
    /// The tool is at the start and has not moved.
    bool isWaiting() const noexcept { return phase_ == TapPhase::WAITING && state_.x <= 0 && state_.v <= 0; }
    bool isOver() const noexcept { return phase_ == TapPhase::OVER; }
    /// The tool has lost the helix: the spindle has not turned back in time, jumped, or is too much for it.
    bool isLost() const noexcept { return lost_; }

  private:
    /// Of the spindle, counted in the sense of the way in.
    struct Turning {
        double turned = 0;   ///< since the helix passed the start, as measured
        double speed = 0;    ///< [turns/s]
        double overrun = 0;  ///< turns until it stands, were it told now to turn back
        HelixState helix;
    };
    /// Jerks that keep the limits and the room of the line.
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
    double direction_ = 1;  ///< of the spindle's counts on the way in
    double origin_ = 0;     ///< counted turns at which the helix passes the start
    MotionState state_;
    SpindlePursuit pursuit_;
    SpeedChangeRun run_;  ///< to rest
    bool running_ = false, lost_ = false, stopped_ = false;
    double stop_turned_ = 0, run_out_ = 0;  ///< of a stop [turns]
};

}  // namespace mw::trajectory
