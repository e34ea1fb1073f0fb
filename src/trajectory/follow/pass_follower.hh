// SPDX-License-Identifier: GPL-2.0-or-later
// A pass of a thread: along the curve with the angle of a spindle, from rest to rest.
#pragma once

#include "trajectory/follow/spindle_pursuit.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// Servo thread; bounded, no allocation. It begins at rest at the start of the first leg. Formulas:
/// docs/integrator/spindles.md.
class PassFollower {
  public:
    /// The helix passes the start of the pass at a whole turn of the counts, whatever the speed.
    void begin(const PathStore &store, const Pass &pass, const SpindleReading &spindle, double dt) noexcept;
    /// For SpindleTrack.
    double rate() const noexcept { return pursuit_.rate(); }
    /// Stops in the least time, without regard to the helix.
    void stop() noexcept { must_stop_ = true; }
    /// One cycle of `dt`. False when the pass is over and the tool is at rest.
    bool step(const PathStore &store, const SpindleReading &spindle, double dt) noexcept;

    double s() const noexcept { return state_.x; }
    double v() const noexcept { return state_.v; }
    int spindle() const noexcept { return pass_.spindle; }
    /// The tool is at the start and has not moved.
    bool isWaiting() const noexcept { return state_.x <= pass_.start_s && state_.v <= 0 && !stopping_; }

    /// Legs that one cycle may pass at most.
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
    double origin_ = 0;  ///< turns of the spindle at which the helix passes the start
    bool must_stop_ = false, stopping_ = false;
};

}  // namespace mw::trajectory
