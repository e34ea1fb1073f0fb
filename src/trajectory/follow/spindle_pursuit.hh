// SPDX-License-Identifier: GPL-2.0-or-later
// Controls the tool so that it reaches a helix that moves with the spindle, and stays on it. Chooses the jerk
// of each servo cycle.
#pragma once

#include "trajectory/path/limited_motion.hh"

namespace mw::trajectory {

/// Current position, speed and acceleration of the helix along the path of the tool.
using HelixState = MotionState;

/// The tool approaches the helix in the least time. It uses the jerk after which the fastest change to the
/// speed of the helix ends on the helix. Near the helix, the deviation decays critically damped, as soon as
/// this is possible within the jerk limit. Realtime-safe.
class SpindlePursuit {
  public:
    /// Begins a pursuit. `rate`: see following_rate. `met`: distance within which the tool counts as on the
    /// helix.
    void begin(double rate, double met) noexcept { *this = {rate, met}; }
    /// Jerk for the next cycle of `dt` [s], between `low` and `high`, for a tool within `limits`.
    double jerk(const HelixState &helix, const MotionState &tool, const MotionLimits &limits, double dt,
                double low, double high) noexcept;
    double rate() const noexcept { return rate_; }
    /// True if the tool has reached the helix.
    bool hasMet() const noexcept { return has_met_; }
    /// Distance of the tool ahead of the helix.
    double ahead() const noexcept { return ahead_; }

    /// Part of acceleration and jerk for the approach. The rest is for changes of the spindle speed
    /// meanwhile.
    static constexpr double MEETING_SHARE = 0.9;

    SpindlePursuit() = default;

  private:
    SpindlePursuit(double rate, double met) noexcept : rate_(rate), met_(met) {}

    double rate_ = 0, met_ = 0;
    bool has_met_ = false;
    double ahead_ = 0;
};

/// Rate with which changes of the spindle speed are followed [1/s]. Each step of the encoder causes a jerk of
/// the tool. It is proportional to `per_turn * step`, the step along the path of the tool, and to the
/// power 3.5 of the rate. This rate leaves most of the jerk for the motion.
double following_rate(double per_turn, double step, double jerk, double dt) noexcept;

/// Lead that a helix of this speed needs over a tool that starts now, so that the tool reaches it in the
/// least time with its speed [unit].
double run_in_distance(double helix_v, const MotionLimits &limits) noexcept;

}  // namespace mw::trajectory
