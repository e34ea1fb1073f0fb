// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/locked_pass.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/stretch.hh"
#include "trajectory/timing/tap_plan.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// Way along a piece in a turn of the spindle; on a blend between those of its lines, so that the lead along
/// the thread stays.
double turn_way(const PlannedPath &path, Sequence piece) noexcept {
    const Piece &p = path.piece(piece);
    const auto way = [&path](Sequence n) {
        const MoveRequest &r = path.move(n).request;
        return r.feed_per_revolution * r.tag.feed_ratio;
    };
    if (!(p.blend_d > 0)) {
        return way(p.move);
    }
    const double part = (p.offset + 0.5 * p.length) / (2.0 * p.blend_d);
    return 1.0 / ((1.0 - part) / way(p.move) + part / way(p.move + 1));
}

/// Acceleration step along a line that the moving average can spread.
double swing_of(const PathLimits &limits, const Primitive &line) noexcept {
    const Pose t = derivative_at(line, 0);
    const PerLimited &jerk = limits.wanted().jerk;
    double swing = jerk[XYZ_NORM] / std::max(geometry::norm_xyz(t), 1e-300);
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double part = std::abs(t[i]);
        swing = part > 0 ? std::min(swing, jerk[static_cast<std::size_t>(i)] / part) : swing;
    }
    return PassTuning::FULL * swing * limits.filter_s();
}

}  // namespace

Sequence pass_end(const PathView &view, Sequence first) noexcept {
    Sequence last = first;
    while (last < view.path.last_piece() && isLockedPiece(view, last + 1) &&
           !view.path.plan(last + 1).isStopBefore && !isBarrier(view, last + 1)) {
        ++last;
    }
    return last;
}

Pass make_pass(const PathView &view, Sequence first) noexcept {
    const PlannedPath &path = view.path;
    const PathLimits &limits = view.conditions.limits;
    const MoveRequest &r = path.move(path.move_of(first)).request;
    const double rps = view.conditions.scales.spindle_rps[static_cast<std::size_t>(r.spindle)];
    Pass pass;
    pass.first = first;
    pass.last = pass_end(view, first);
    pass.spindle = r.spindle;
    pass.direction = rps < 0 ? -1.0 : 1.0;
    pass.share = PassTuning::FULL;
    pass.trim = PassTuning::FULL;
    if (r.isTap) {
        pass.isTap = true;
        pass.share = tap_share(limits);
        pass.trim = pass.share;
        pass.tap = tap_terms(view, first, rps);
        const Sequence in = path.move_of(first);
        while (pass.last < path.last_piece() && path.move_of(pass.last + 1) <= in + 1) {
            ++pass.last;
        }
        return pass;
    }
    if (!limits.isFiltered()) {
        return pass;
    }
    double length = 0;
    for (Sequence k = pass.first; k <= pass.last; ++k) {
        length += path.piece(k).length;
    }
    const double v = turning_speed(r, view.conditions.scales) * PassTuning::SPEED_RESERVE;
    const double a = PassTuning::LONG_SHARE * path.piece(first).acceleration.at(0);
    const bool isOneMove = path.move_of(pass.first) == path.move_of(pass.last);
    const bool isLong = isOneMove && length > v * v / a + PassTuning::LONG_MEANS * v * limits.filter_s();
    const double even = isOneMove ? PassTuning::SHORT_SHARE : PassTuning::CORNER_SHARE;
    pass.share = isLong ? PassTuning::LONG_SHARE : even;
    pass.trim = isLong ? PassTuning::LONG_TRIM : even;
    pass.swing = isLong ? swing_of(limits, path.primitive(path.move_of(first))) : 0.0;
    return pass;
}

void fill_pass(PlannedPath &path, const PathLimits &limits, const Pass &pass) noexcept {
    double out2 = 0;
    for (Sequence k = pass.last; k >= pass.first; --k) {
        Piece &p = path.store().piece(k);
        p.per_turn = turn_way(path, k);
        // A corner that had to be tighter is passed more slowly.
        const bool isTurning = limits.isFiltered() && p.blend_d > 0;
        p.v_most = path.plan(k).v_limit * (isTurning ? std::sqrt(PassTuning::TURNING) : 1.0);
        p.v2_out = out2;
        AccelBound bound = p.acceleration;
        for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
            bound.alpha[i] *= pass.share;
            bound.beta[i] *= pass.share;
        }
        p.v2_in = std::min(p.v_most * p.v_most, bound.highest_before(out2, p.length));
        const double v_before = k > pass.first ? path.plan(k - 1).v_limit : 0.0;
        out2 = std::min(p.v2_in, v_before * v_before);
    }
}

double pass_load(const PathView &view, Sequence move) noexcept {
    const PlannedPath &path = view.path;
    const Conditions &c = view.conditions;
    double load = 0;
    double length = 0;
    double ramps = 0;  // ways that gaining and losing the speed take, at the slower end
    for (Sequence n = move; n <= path.last_move(); ++n) {
        const MoveRequest &r = path.move(n).request;
        if (!c.isLocked(r) || (n > move && r.isGated)) {
            break;
        }
        const Primitive &p = path.primitive(n);
        const SpeedLimit limit = limit_of(p, 0, p.length, c.limits.fitted(), UNLIMITED);
        const double v = turning_speed(r, c.scales);
        load = std::max(load, v / std::min(limit.v, c.scales.max_velocity * r.tag.feed_ratio));
        length += p.length;
        ramps = std::max(ramps, v * v / (tap_share(c.limits) * limit.a.at(v * v)));
    }
    // If no part of it would have the lead, the maximum speed that leaves one goes with the root.
    return load <= 1.0 && ramps > length ? std::sqrt(ramps / length) : load;
}

}  // namespace mw::trajectory
