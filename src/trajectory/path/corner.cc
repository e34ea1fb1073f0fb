// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas: docs/developer/planner.md.
#include "trajectory/path/corner.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// Two moves and what their corner may do.
struct Bend {
    const Leg &a, &b;
    const Conditions &conditions;
    double tolerance = 0;  ///< 0: any
    bool isStop = false;

    const Limits &limits() const noexcept { return conditions.limits.wanted(); }
    double wish_before() const noexcept { return requested_speed(a.move, conditions.scales); }
    double wish_after() const noexcept { return requested_speed(b.move, conditions.scales); }
};

/// The blend within the tolerance that is wide enough for the speed; a stop where there is none.
Corner accelerated_corner(const Bend &bend) noexcept {
    if (bend.isStop) {
        return {.isStop = true};
    }
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    double d = 0.5 * std::min(a.length, b.length);
    if (bend.tolerance > 0) {
        d = std::min(d, blend_d_for_tolerance(a, b, bend.tolerance));
    }
    const double va = limit_of(a, 0, a.length, bend.limits(), bend.wish_before()).v;
    const double vb = limit_of(b, 0, b.length, bend.limits(), bend.wish_after()).v;
    d = std::min(d, blend_d_for_speed(a, b, bend.limits(), std::min(va, vb)));
    return d > PathTuning::SMALLEST_BLEND ? Corner{.blend_d = d} : Corner{.isStop = true};
}

}  // namespace

Corner corner_between(const Leg &a, const Leg &b, const Conditions &c) noexcept {
    const MoveRequest &ra = a.move.request;
    const MoveRequest &rb = b.move.request;
    if (ra.join == geometry::PathMode::EXACT_STOP || isStopBetween(ra, rb)) {
        return {.isStop = true};
    }
    const double step = geometry::norm(tangent_step(a.line, b.line));
    if (step <= PathTuning::SAME_DIRECTION) {
        return {};
    }
    const bool isExact = ra.join != geometry::PathMode::BLEND || rb.join != geometry::PathMode::BLEND;
    const Pose ta = derivative_at(a.line, a.line.length);
    const Pose tb = derivative_at(b.line, 0);
    const bool isCorner = isExact && step > PathTuning::EXACT_STEP;
    const bool isReversal =
        geometry::dot(ta, tb) < PathTuning::REVERSAL_COSINE * geometry::norm(ta) * geometry::norm(tb);
    double tolerance = isExact ? PathTuning::EXACT_DEVIATION : tolerance_of(a.move);
    const double other = tolerance_of(b.move);
    if (!isExact && other > 0) {
        tolerance = tolerance > 0 ? std::min(tolerance, other) : other;
    }
    const Bend bend{a, b, c, tolerance, isCorner || isReversal};
    return accelerated_corner(bend);
}

}  // namespace mw::trajectory
