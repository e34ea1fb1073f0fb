// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/path_limits.hh"

#include <algorithm>

namespace mw::trajectory {

namespace {

/// Deviation of the curve without a programmed tolerance: part of a line's length, of an arc's radius, and at
/// least the distance in this time at maximum speed.
constexpr double FREE_OF_LENGTH = 0.1, FREE_OF_RADIUS = 1e-3, NOMINAL_S = 1e-4;

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

double PathLimits::free_tolerance(const Primitive &primitive) const noexcept {
    return std::max(nominal_tolerance_,
                    primitive.isArc ? FREE_OF_RADIUS * primitive.radius : FREE_OF_LENGTH * primitive.length);
}

}  // namespace mw::trajectory
