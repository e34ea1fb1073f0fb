// SPDX-License-Identifier: GPL-2.0-or-later
// Meets a helix that moves with a spindle, and stays on it: chooses the jerk of each servo cycle.
#pragma once

#include "trajectory/path/limited_motion.hh"

namespace mw::trajectory {

/// The place of the helix along the tool's way, its speed and acceleration, now.
using HelixState = MotionState;

/// The tool approaches the helix with the jerk that reaches it in the least time: that with which the fastest
/// change to the helix's speed would end on the helix. A deviation that the jerk limit allows to decay by
/// itself, critically damped, does so. Realtime-safe.
class SpindlePursuit {
  public:
    /// `rate`: see following_rate. The helix counts as met within the distance `met`.
    void begin(double rate, double met) noexcept { *this = {rate, met}; }
    /// Jerk for the coming cycle of `dt`, from `low` to `high`, for a tool within `limits`.
    double jerk(const HelixState &helix, const MotionState &tool, const MotionLimits &limits, double dt,
                double low, double high) noexcept;
    double rate() const noexcept { return rate_; }
    /// The tool has been on the helix.
    bool hasMet() const noexcept { return has_met_; }
    /// How far the tool is ahead of the helix [distance].
    double ahead() const noexcept { return ahead_; }

    /// Part of acceleration and jerk with which the helix is approached: the rest corrects what the spindle
    /// does meanwhile.
    static constexpr double MEETING_SHARE = 0.9;

    SpindlePursuit() = default;

  private:
    SpindlePursuit(double rate, double met) noexcept : rate_(rate), met_(met) {}

    double rate_ = 0, met_ = 0;
    bool has_met_ = false;
    double ahead_ = 0;
};

/// How fast changes of the spindle are followed [1/s]. The step of an encoder shakes the tool with a jerk
/// that grows with the step, which is `per_turn * step` along the tool's way, and with the power 3.5 of the
/// rate. This rate leaves most of the jerk for the motion.
double following_rate(double per_turn, double step, double jerk, double dt) noexcept;

/// Distance that a helix of this speed moves ahead of a tool that starts now and reaches the speed in the
/// least time, to be there when it is met.
double run_in_distance(double helix_v, const MotionLimits &limits) noexcept;

}  // namespace mw::trajectory
