// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/corner_shaper.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// Requirement of a corner by its curvature alone.
struct Demand {
    Pose shift;
    double reach = 0;  ///< distance in the averaging time
    double most = 0;   ///< maximum displacement of the corner
};

bool isPlain(const Leg &leg) noexcept {
    const MoveRequest &r = leg.move.request;
    return !leg.line.isArc && r.join == geometry::PathMode::BLEND && !r.isGated && !r.tag.isProbe &&
           r.tolerance > 0;
}

/// Nothing where there is no curve.
std::optional<Demand> demand_of(const Leg &a, const Leg &b, const Conditions &c) noexcept {
    if (!c.limits.isFiltered() || c.blocks.isOn || !isPlain(a) || !isPlain(b)) {
        return std::nullopt;
    }
    const Limits &limits = c.limits.fitted();
    const Pose step = b.line.lin - a.line.lin;
    const double turn = geometry::norm(step);
    const double spacing = 0.5 * (a.line.length + b.line.length);
    double v2 = std::min(requested_speed(a.move, c.scales), requested_speed(b.move, c.scales));
    v2 *= v2;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double bend = std::abs(step[i]) / spacing;
        const double speed = limits.velocity[static_cast<std::size_t>(i)];
        const double along = std::max(std::abs(a.line.lin[i]), std::abs(b.line.lin[i]));
        v2 = bend > 0 ? std::min(v2, limits.acceleration[static_cast<std::size_t>(i)] / bend) : v2;
        v2 = along > 0 ? std::min(v2, speed * speed / (along * along)) : v2;
    }
    Demand demand;
    demand.reach = std::sqrt(v2) * c.limits.filter_s();
    if (turn > ShapeTuning::MOST_TURN || demand.reach < CornerTuning::DENSE * spacing) {
        return std::nullopt;
    }
    const double tolerance = std::min(tolerance_of(a.move, c.limits), tolerance_of(b.move, c.limits));
    demand.most = ShapeTuning::MOST_SHARE * tolerance;
    const double size = std::max(geometry::norm_linear(step), geometry::norm_abc(step));
    const double inside = size / spacing * demand.reach * demand.reach / 24.0;
    const double out = std::clamp(inside - ShapeTuning::FREE_SHARE * tolerance, 0.0, demand.most);
    demand.shift = size > 0 ? step * (-out / size) : Pose{};
    return demand;
}

}  // namespace

std::optional<Pose> CornerShaper::shift(const Leg &a, const Leg &b, const Conditions &conditions) noexcept {
    const std::optional<Demand> demand = demand_of(a, b, conditions);
    if (!demand) {
        begin();
        return std::nullopt;
    }
    // Two lags in a row, by length: what the shift adds to the curvature stays small.
    const double part = 1.0 - std::exp(-a.line.length / (ShapeTuning::FOLLOWING * demand->reach));
    drive_ = drive_ + (demand->shift - drive_) * part;
    shift_ = shift_ + (drive_ - shift_) * part;
    // What corners before were moved by may be more than this one's tolerance.
    const double size = std::max(geometry::norm_linear(shift_), geometry::norm_abc(shift_));
    shift_ = size > demand->most ? shift_ * (demand->most / size) : shift_;
    if (geometry::norm(shift_) < ShapeTuning::SMALLEST_SHIFT) {
        return std::nullopt;
    }
    return conditions.workspace.shift_within(a.line.end, shift_);
}

}  // namespace mw::trajectory
