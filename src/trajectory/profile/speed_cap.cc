// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/speed_cap.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

/// Half of the time over which a quadratic B-spline of three periods is positive, divided by the period.
constexpr double REACH = 1.5;
/// The motion stops at a seam if its cap is lower than the speed of a start with full jerk after this number
/// of periods. Passing it would save less than twice this time.
constexpr double STOP_PERIODS = 10;
/// A jump that uses less than this fraction of a limit is ignored. The margins of the profile cover it.
constexpr double NEGLIGIBLE = 1e-3;
/// A smaller derivative counts as 0.
constexpr double LEAST = 1e-30;

PerLimited sizes_of(const Pose &p) noexcept {
    PerLimited out{};
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        out[i] = std::abs(p.c[i]);
    }
    out[XYZ_NORM] = geometry::norm_xyz(p);
    return out;
}

/// Jerk limit of a coordinate. Without jerk limits, the jerk that reaches full acceleration within one
/// period.
double jerk_of(const Bounds &b, double period_s, bool has_jerk) noexcept {
    return has_jerk ? std::min(b.jerk, b.acceleration / std::max(LEAST_RAMP_S, 2 * period_s))
                    : b.acceleration / period_s;
}

/// Lowers limits along the path to those of a coordinate with the derivative `first`.
void lower(Bounds &along, const Bounds &b, double first, double period_s, bool has_jerk) noexcept {
    const double q1 = std::max(first, LEAST);
    along.velocity = std::min(along.velocity, b.velocity / q1);
    along.acceleration = std::min(along.acceleration, b.acceleration / q1);
    along.jerk = std::min(along.jerk, jerk_of(b, period_s, has_jerk) / q1);
}

/// Limits along a path with the tangent `first`.
Bounds along(const Pose &first, const CurveLimits &limits, double period_s) noexcept {
    Bounds out;
    const PerLimited sizes = sizes_of(first);
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        lower(out, bounds_of(limits, i), sizes[i], period_s, limits.has_jerk);
    }
    return out;
}

double reach_of(double v, double acceleration, double period_s) noexcept {
    const double near_s = REACH * period_s;
    return near_s * (v + 0.5 * near_s * acceleration);
}

/// Applies the limits of one more coordinate, with the jumps of its derivatives.
void take(SpeedCap &cap, std::size_t i, const Bounds &b, double turn, double bend) noexcept {
    const double jerk = jerk_of(b, cap.period_s, cap.has_jerk);
    cap.turn[i] = turn / (cap.period_s * cap.period_s);
    cap.bend[i] = cap.has_jerk ? 0.75 * bend / cap.period_s : 0.0;
    cap.v = std::min({cap.v, TURN_SHARE * jerk / std::max(cap.turn[i], LEAST),
                      std::sqrt(jerk / std::max(cap.bend[i], LEAST))});
}

bool isTaken(const SpeedCap &cap, std::size_t i, const Bounds &b) noexcept {
    return cap.v * (cap.turn[i] + cap.bend[i] * cap.v) > NEGLIGIBLE * jerk_of(b, cap.period_s, cap.has_jerk);
}

}  // namespace

double largest_reach(const curve::CurvePoint &end, const CurveLimits &limits, double period_s) noexcept {
    const Bounds bounds = along(end.first, limits, period_s);
    return reach_of(bounds.velocity, bounds.acceleration, period_s);
}

SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, double period_s) noexcept {
    return cap_of(seam, limits, nullptr, {}, period_s);
}

SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, const JointMap *map,
                const JointLimits &joints, double period_s) noexcept {
    const PerLimited turn = sizes_of(seam.after.first - seam.before.first),
                     bend = sizes_of(seam.after.second - seam.before.second);
    Bounds before = along(seam.before.first, limits, period_s),
           after = along(seam.after.first, limits, period_s);
    SpeedCap cap;
    cap.s = seam.s;
    cap.period_s = period_s;
    cap.has_jerk = limits.has_jerk;
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        take(cap, i, bounds_of(limits, i), turn[i], bend[i]);
    }
    if (map != nullptr) {
        const curve::JointJump jump = curve::joint_jump(seam.before, seam.after, *map);
        for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
            const Bounds b = bounds_of(joints, j);
            take(cap, JOINTS_AT + j, b, jump.first[j], jump.second[j]);
            lower(before, b, jump.before[j], period_s, limits.has_jerk);
            lower(after, b, jump.after[j], period_s, limits.has_jerk);
        }
        cap.is_stop = !jump.exists;
    }
    cap.v = std::min({cap.v, before.velocity, after.velocity});
    cap.reach = reach_of(cap.v, before.acceleration, period_s);
    const double stop_s = STOP_PERIODS * period_s;
    cap.is_stop = cap.is_stop || cap.v < stop_s * std::min(0.5 * stop_s * std::max(before.jerk, after.jerk),
                                                           std::max(before.acceleration, after.acceleration));
    return cap;
}

bool isNeeded(const SpeedCap &cap, const CurveLimits &limits) noexcept {
    return isNeeded(cap, limits, {});
}

bool isNeeded(const SpeedCap &cap, const CurveLimits &limits, const JointLimits &joints) noexcept {
    for (std::size_t i = 0; i < LIMITED_COUNT; ++i) {
        if (isTaken(cap, i, bounds_of(limits, i))) {
            return true;
        }
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints.count); ++j) {
        if (isTaken(cap, JOINTS_AT + j, bounds_of(joints, j))) {
            return true;
        }
    }
    return false;
}

}  // namespace mw::trajectory::profile
