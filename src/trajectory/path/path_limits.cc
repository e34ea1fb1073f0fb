// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/path_limits.hh"

#include <algorithm>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

PathLimits::PathLimits(double period_s) noexcept : period_s_(period_s) {
    Limits none;
    none.velocity.fill(UNLIMITED);
    none.acceleration.fill(UNLIMITED);
    none.jerk.fill(UNLIMITED);
    set(none);
}

void PathLimits::set(const Limits &limits) noexcept {
    wanted_ = limits;
    for (std::size_t i = 0; i < limits.velocity.size(); ++i) {
        highest_.velocity[i] = std::max(highest_.velocity[i], limits.velocity[i]);
        highest_.acceleration[i] = std::max(highest_.acceleration[i], limits.acceleration[i]);
    }
    fitted_ = limits_for_filter(limits, filter_, period_s_);
    nominal_tolerance_ = 0;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double v = limits.velocity[static_cast<std::size_t>(i)];
        const bool isCounted = !geometry::isAngular(i) && v < UNLIMITED;
        nominal_tolerance_ =
            isCounted ? std::max(nominal_tolerance_, v * PathTuning::NOMINAL_S) : nominal_tolerance_;
    }
}

void PathLimits::begin(const PathDemand &demand) noexcept {
    filter_ = filter_length(wanted_, period_s_, demand);
    isTurning_ = demand.isTurning;
    filter_s_ = isFiltered() ? static_cast<double>(filter_) * period_s_ : 0.0;
    highest_ = wanted_;
    set(Limits{wanted_});
}

/// A path that rotary axes have a part in keeps its longer mean for lines between: a stop at each would cost
/// more.
bool PathLimits::suits(const PathDemand &demand) const noexcept {
    const PathDemand asked{demand.tolerance, demand.isTurning || isTurning_};
    const auto wanted = static_cast<double>(filter_length(wanted_, period_s_, asked));
    const auto present = static_cast<double>(filter_);
    const bool isTooLong = demand.tolerance > 0 && present > wanted * PathTuning::MOST_UNSUITED;
    const bool isTooShort = demand.isTurning && !isTurning_ && wanted > present * PathTuning::MOST_UNSUITED;
    return !isTooLong && !isTooShort;
}

PathDemand PathLimits::demand_of(const MoveRequest &request, const Pose &start,
                                 const Pose &end) const noexcept {
    constexpr double ROUNDING_DEG = 1e-9;
    const double tolerance = request.join != geometry::PathMode::BLEND ? 0.0
                             : request.tolerance > 0                   ? request.tolerance
                                                                       : nominal_tolerance_;
    return {tolerance, geometry::norm_abc(end - start) > ROUNDING_DEG};
}

double PathLimits::free_tolerance(const Primitive &primitive) const noexcept {
    return std::max(nominal_tolerance_, primitive.isArc ? PathTuning::FREE_OF_RADIUS * primitive.radius
                                                        : PathTuning::FREE_OF_LENGTH * primitive.length);
}

}  // namespace mw::trajectory
