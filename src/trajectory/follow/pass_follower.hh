// SPDX-License-Identifier: GPL-2.0-or-later
// A pass of a thread: a motion along the curve, locked to a spindle angle, from standstill to standstill.
#pragma once

#include "trajectory/follow/spindle_pursuit.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// Use it in the servo thread only. It is bounded and does not allocate memory. It begins at standstill at
/// the start of the first leg. Formulas: docs/integrator/spindles.md.
class PassFollower {
  public:
    /// Begins a pass. The helix passes its start at a full revolution of the counts, at any speed.
    void begin(const PathStore &store, const Pass &pass, const SpindleReading &spindle, double dt) noexcept;
    /// Filter rate for SpindleTrack [1/s].
    double rate() const noexcept { return pursuit_.rate(); }
    /// Stops in the least time, without following the helix.
    void stop() noexcept { must_stop_ = true; }
    /// Advances the pass by one cycle of `dt` [s]. False when the pass is complete and the tool is stopped.
    bool step(const PathStore &store, const SpindleReading &spindle, double dt) noexcept;

    double s() const noexcept { return state_.x; }
    double v() const noexcept { return state_.v; }
    int spindle() const noexcept { return pass_.spindle; }
    /// True if the tool is at the start and has not moved.
    bool isWaiting() const noexcept { return state_.x <= pass_.start_s && state_.v <= 0 && !stopping_; }

    /// Maximum number of legs in one cycle.
    static constexpr int MOST_LEGS_PER_CYCLE = 64;

  private:
    HelixState helix(const PassLeg &leg, const SpindleReading &spindle) const noexcept;
    bool isAllowed(const PathStore &store, const MotionState &next) const noexcept;
    bool canStop(const MotionState &next, const PassLeg &leg) const noexcept;
    double lowest_jerk(double low, double high, double dt) const noexcept;
    bool begin_stop(const PathStore &store, double jerk, double dt) noexcept;

    Pass pass_;
    MotionLimits limits_;
    SpindlePursuit pursuit_;
    SpeedChangeRun stop_;
    MotionState state_;
    Sequence leg_ = 0;
    double origin_ = 0;  ///< revolutions of the spindle at which the helix passes the start
    bool must_stop_ = false, stopping_ = false;
};

}  // namespace mw::trajectory
