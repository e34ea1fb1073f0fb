// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/speed_cap.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Half of the time over which a quadratic B-spline of three periods is above 0, over the period.
constexpr double REACH = 1.5;
/// A stop takes the place of a speed that a start with full jerk has after so many periods: to pass saves
/// less than twice their time.
constexpr double STOP_PERIODS = 10;
/// Part of the jerk limit that is left to the margins of the profile.
constexpr double NEGLIGIBLE = 1e-3;
/// A derivative below it is 0.
constexpr double LEAST = 1e-30;

PerLimited sizes_of(const Pose &p) noexcept {
    PerLimited out{};
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        out[i] = std::abs(p.c[i]);
    }
    out[XYZ_NORM] = geometry::norm_xyz(p);
    return out;
}

const Bounds &bounds_of(const CurveLimits &limits, std::size_t i) noexcept {
    return i == XYZ_NORM ? limits.xyz : limits.axes[i];
}

double jerk_of(const Bounds &b, double period_s) noexcept {
    return std::min(b.jerk, b.acceleration / std::max(LEAST_RAMP_S, 2 * period_s));
}

/// Limits along a path with the tangent `first`.
Bounds along(const PerLimited &first, const CurveLimits &limits, double period_s) noexcept {
    Bounds out;
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        const Bounds &b = bounds_of(limits, i);
        const double q1 = std::max(first[i], LEAST);
        out.velocity = std::min(out.velocity, b.velocity / q1);
        out.acceleration = std::min(out.acceleration, b.acceleration / q1);
        out.jerk = std::min(out.jerk, jerk_of(b, period_s) / q1);
    }
    return out;
}

double reach_of(double v, double acceleration, double period_s) noexcept {
    const double near_s = REACH * period_s;
    return near_s * (v + 0.5 * near_s * acceleration);
}

}  // namespace

double largest_reach(const curve::CurvePoint &end, const CurveLimits &limits, double period_s) noexcept {
    const Bounds bounds = along(sizes_of(end.first), limits, period_s);
    return reach_of(bounds.velocity, bounds.acceleration, period_s);
}

SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, double period_s) noexcept {
    const PerLimited turn = sizes_of(seam.after.first - seam.before.first),
                     bend = sizes_of(seam.after.second - seam.before.second);
    const Bounds before = along(sizes_of(seam.before.first), limits, period_s),
                 after = along(sizes_of(seam.after.first), limits, period_s);
    SpeedCap cap;
    cap.s = seam.s;
    cap.period_s = period_s;
    cap.v = std::min(before.velocity, after.velocity);
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        const double jerk = jerk_of(bounds_of(limits, i), period_s);
        cap.turn[i] = turn[i] / (period_s * period_s);
        cap.bend[i] = 0.75 * bend[i] / period_s;
        cap.v = std::min({cap.v, TURN_SHARE * jerk / std::max(cap.turn[i], LEAST),
                          std::sqrt(jerk / std::max(cap.bend[i], LEAST))});
    }
    const double stop_s = STOP_PERIODS * period_s;
    cap.reach = reach_of(cap.v, before.acceleration, period_s);
    cap.is_stop = cap.v < stop_s * std::min(0.5 * stop_s * std::max(before.jerk, after.jerk),
                                            std::max(before.acceleration, after.acceleration));
    return cap;
}

bool isNeeded(const SpeedCap &cap, const CurveLimits &limits) noexcept {
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        const double jerk = jerk_of(bounds_of(limits, i), cap.period_s);
        if (cap.v * (cap.turn[i] + cap.bend[i] * cap.v) > NEGLIGIBLE * jerk) {
            return true;
        }
    }
    return false;
}

}  // namespace mw::trajectory::profile
