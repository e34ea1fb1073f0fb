// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/spindle_pursuit.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/follow/spindle_track.hh"

namespace mw::trajectory {

namespace {

/// Decay rate of a deviation, as a fraction of the filter rate.
constexpr double DECAY = 0.67;
/// Approximate multiple of the jerk limit for the step of an encoder times rate^3.5.
constexpr double STEP_JERK = 4;
/// Minimum acceleration for the approach, as a fraction of the limit, in addition to that of the helix.
constexpr double LEAST_ACCELERATION = 0.02;

/// The jerk with which a deviation decays with three equal poles at `rate` [1/s].
double decaying(const MotionState &relative, double rate) noexcept {
    return -rate * (3 * relative.a + rate * (3 * relative.v + rate * relative.x));
}

/// An upper bound of this jerk until the deviation has decayed. The terms of the current jerk may cancel.
double largest_decaying(const MotionState &relative, double rate) noexcept {
    return rate *
           (3 * std::abs(relative.a) + rate * (3 * std::abs(relative.v) + rate * std::abs(relative.x)));
}

/// Position of the tool relative to the helix when it reaches the speed of the helix.
double place_when_as_fast(const MotionState &relative, const MotionLimits &limits) noexcept {
    return relative.x + speed_change(relative, 0, limits.acceleration, limits.jerk).distance;
}

}  // namespace

double run_in_distance(double helix_v, const MotionLimits &limits) noexcept {
    const SpeedChange change =
        speed_change({}, std::abs(helix_v), SpindlePursuit::MEETING_SHARE * limits.acceleration, limits.jerk);
    return std::abs(helix_v) * change.duration - change.distance;
}

double following_rate(double per_turn, double step, double jerk, double dt) noexcept {
    return std::min(SpindleTrack::HIGHEST_RATE / dt, std::pow(STEP_JERK * jerk / (per_turn * step), 2.0 / 7));
}

double SpindlePursuit::jerk(const HelixState &helix, const MotionState &tool, const MotionLimits &limits,
                            double dt, double low, double high) noexcept {
    const MotionState relative{tool.x - helix.x, tool.v - helix.v, tool.a - helix.a};
    ahead_ = relative.x;
    const double wanted = decaying(relative, DECAY * rate_);
    if (largest_decaying(relative, DECAY * rate_) <= limits.jerk) {
        has_met_ = has_met_ || std::abs(relative.x) < met_;
        return std::clamp(wanted, low, std::max(low, high));
    }
    MotionLimits left = limits;
    left.acceleration = std::max(MEETING_SHARE * limits.acceleration - std::abs(helix.a),
                                 LEAST_ACCELERATION * limits.acceleration);
    left.jerk = MEETING_SHARE * limits.jerk;
    return highest_allowed(
        low, high, [&](double jerk) { return place_when_as_fast(relative.after(jerk, dt), left) <= 0; });
}

}  // namespace mw::trajectory
