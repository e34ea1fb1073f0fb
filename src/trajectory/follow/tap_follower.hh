// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid tapping: along a line with the angle of a spindle, in, through the reversal and back. Knows only the
// place on the line and what is measured of the spindle. Formulas: docs/integrator/spindles.md.
#pragma once

#include <cstdint>

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
    STOPPING,  ///< a stop: the spindle is off, the tool follows it to its stand
    OVER,
};

/// The ideas: the spindle is told to turn back so much before the bottom that it stands there; when it really
/// turns back is seen from its measured angle alone, which the tool follows all the time.
class TapFollower {
  public:
    /// From rest at x 0. `ahead_s`: from the reading to what is commanded now; `lag_s`: of the mean.
    void begin(const TapTerms &terms, const SpindleReading &spindle, double ahead_s) noexcept;
    /// An abort: no turning back, no way home.
    void stop(const SpindleReading &spindle) noexcept;
    /// One cycle of `dt`. With a mean of `mean_s` the command is that much later, half of it on average.
    void step(const SpindleReading &spindle, double dt, double mean_s) noexcept;

    double x() const noexcept { return x_; }
    double v() const noexcept { return v_; }
    TapPhase phase() const noexcept { return phase_; }
    /// Speed of the spindle that is wanted over that which it was started with; 0: off.
    double spindle_factor() const noexcept;
    /// It stands at the start and nothing has begun.
    bool isWaiting() const noexcept { return phase_ == TapPhase::WAITING && x_ <= 0 && v_ <= 0; }
    bool isOver() const noexcept { return phase_ == TapPhase::OVER; }
    /// The tool has lost the helix: the spindle has not turned back in time, jumped, or is too much for it.
    bool isLost() const noexcept { return isLost_; }

  private:
    /// Of the spindle, counted in the sense of the way in.
    struct Turning {
        double turned = 0;   ///< since the helix passed the start, as measured
        double speed = 0;    ///< [turns/s]
        double overrun = 0;  ///< turns until it stands, were it told now to turn back
        double helix_x = 0;  ///< where the helix will be when the command is due
        double helix_v = 0;
    };
    Turning read(const SpindleReading &spindle, double dt, double mean_s) const noexcept;
    void decide(const Turning &t, double dt) noexcept;
    double wanted_speed(const Turning &t, double dt) noexcept;
    double following_speed(const Turning &t, double dt) noexcept;

    TapTerms terms_;
    TapPhase phase_ = TapPhase::OVER;
    double direction_ = 1;  ///< of the spindle's counts on the way in
    double origin_ = 0;     ///< counted turns at which the helix passes the start
    double x_ = 0, v_ = 0;
    bool isMet_ = false, isLost_ = false, isStopped_ = false;
    double stop_turned_ = 0, run_out_ = 0;  ///< of a stop [turns]
};

}  // namespace mw::trajectory
