// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/path_limits.hh"

#include <algorithm>

namespace mw::trajectory {

namespace {

/// Default deviation of the curve if no tolerance is programmed: a part of the length of a line or of the
/// radius of an arc, and at least the distance in NOMINAL_S at maximum speed.
constexpr double FREE_OF_LENGTH = 0.1, FREE_OF_RADIUS = 1e-3, NOMINAL_S = 1e-4;
/// Maximum default deviation without jerk limits: the deviation of a corner of 90 degrees at the programmed
/// speed with 0.7 of the acceleration, (v^2 sqrt(2)/(1.4 a)) sqrt(2)/4.
constexpr double FREE_OF_CORNER = 0.5 / 1.4;
/// Minimum default deviation [machine units]: a smaller corner takes less than a servo period.
constexpr double LEAST_FREE = 1e-5;

}  // namespace

PathLimits::PathLimits(double period_s) noexcept : period_s_(period_s) {
    Limits none;
    none.velocity.fill(UNLIMITED);
    none.acceleration.fill(UNLIMITED);
    none.jerk.fill(UNLIMITED);
    set(none);
}

void PathLimits::set(const Limits &limits) noexcept {
    wanted_ = limits;
    nominal_tolerance_ = 0;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double v = limits.velocity[static_cast<std::size_t>(i)];
        const bool isCounted = !geometry::isAngular(i) && v < UNLIMITED;
        nominal_tolerance_ = isCounted ? std::max(nominal_tolerance_, v * NOMINAL_S) : nominal_tolerance_;
    }
}

double PathLimits::free_tolerance(const Primitive &primitive, double speed) const noexcept {
    const double shape =
        primitive.isArc ? FREE_OF_RADIUS * primitive.radius : FREE_OF_LENGTH * primitive.length;
    if (wanted_.isJerkLimited) {
        return std::max(nominal_tolerance_, shape);
    }
    const SpeedLimit limit = limit_of(primitive, 0, primitive.length, wanted_, speed > 0 ? speed : UNLIMITED);
    const double corner = FREE_OF_CORNER * limit.v * limit.v / limit.a.at(0);
    const double least = std::max(LEAST_FREE, nominal_tolerance_);
    return std::clamp(corner, least, std::max(least, shape));
}

}  // namespace mw::trajectory
