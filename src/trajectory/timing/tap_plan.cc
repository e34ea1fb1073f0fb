// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/tap_plan.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/line_joints.hh"
#include "trajectory/path/stretch.hh"
#include "trajectory/timing/locked_pass.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

double ramp_at(const std::array<double, 2> &ramp, double rps) noexcept {
    return rps < 0 ? ramp[1] : ramp[0];
}

/// Deviation of the averaged tool position from the helix [revolutions] while a spindle of this ramp
/// reverses. Following it takes the part `use` of the tool's acceleration: the change is seen late, and
/// corrected with the rest.
double off_helix(double ramp, double use, double mean_s) noexcept {
    const double late_s = TapTuning::LATE_MEANS * mean_s;
    return ramp * (TapTuning::LATE_S2 + 0.5 * late_s * late_s * use / (1.0 - use));
}

/// The spindle reaches its speed in the retract, and keeps it until the tool follows it well again, before it
/// is commanded forward.
bool isBackLong(const TapTerms &tap, const std::array<double, 2> &ramp, double rps, double mean_s) noexcept {
    const double back = tap.back_scale * std::abs(rps);
    const double slowest = std::min(ramp[0], ramp[1]);
    const double turns =
        slowest > 0 ? back * back / slowest + TapTuning::SETTLING_MEANS * back * mean_s : 0.0;
    return turns * tap.per_turn <= tap.depth + TapTuning::CLEARANCE * tap.per_turn;
}

/// The line of a tap, and the travel of the tool on it.
TapTerms line_of(const PathView &view, Sequence move, double rps) noexcept {
    const MoveRequest &r = view.path.move(move).request;
    TapTerms tap;
    tap.depth = view.path.primitive(move).length;
    tap.per_turn = r.feed_per_revolution * r.tag.feed_ratio;
    tap.back_scale = r.tap_scale;
    tap.low = -r.room_before;
    tap.high = tap.depth + r.room_behind;
    const double ramp = ramp_at(view.conditions.ramps[static_cast<std::size_t>(r.spindle)], rps);
    if (ramp > 0) {
        const double turns = TapTuning::MORE_ROOM + rps * rps / ramp;
        tap.high = std::min(tap.high, tap.depth + turns * tap.per_turn);
        if (view.conditions.workspace.isMapped()) {
            tap.low = std::max(tap.low, -turns * tap.per_turn);
        }
    }
    return tap;
}

/// What the tool may do along the line.
struct Ability {
    double most_speed = 0;  ///< ever
    double velocity = 0;    ///< up to which it has this acceleration
    double acceleration = 0;
};

/// The joints' curves leave the less acceleration the faster the tool may go: it may go faster than it will
/// have to as long as that costs little.
Ability ability_of_joints(const PathView &view, Sequence move, const TapTerms &tap, double needed) noexcept {
    const Conditions &c = view.conditions;
    const Primitive &line = view.path.primitive(move);
    const SpeedLimit axes = limit_of(line, 0, line.length, c.limits.fitted(), UNLIMITED);
    const LineJoints joints = joints_along(c.workspace, line, tap.low, tap.high);
    if (!joints.isReachable) {
        return {};
    }
    Ability out;
    out.most_speed = std::min(axes.v, joints.most_speed(c.workspace.joints));
    const double least = std::min(out.most_speed, TapTuning::OVERSPEED * needed);
    const auto left_at = [&](double v) {
        const double left = joints.acceleration(c.workspace.joints, v, c.limits.filter_s());
        return std::min(tap_share(c.limits) * axes.a.at(0), PassTuning::FULL * left);
    };
    const double enough = TapTuning::SPEED_WORTH * left_at(least);
    for (int n = 0; n <= TapTuning::SPEED_STEPS; ++n) {
        const double part = static_cast<double>(n) / TapTuning::SPEED_STEPS;
        const double v = least + part * (out.most_speed - least);
        const double a = left_at(v);
        if (n == 0 || a >= enough) {
            out.velocity = v;
            out.acceleration = a;
        }
    }
    return out;
}

double needed_speed(const PathView &view, Sequence move, double rps) noexcept {
    const MoveRequest &r = view.path.move(move).request;
    return r.feed_per_revolution * r.tag.feed_ratio * std::abs(rps) * std::max(1.0, r.tap_scale);
}

}  // namespace

double tap_share(const PathLimits &limits) noexcept {
    return limits.isFiltered() ? PassTuning::SHORT_SHARE : PassTuning::FULL;
}

TapTerms tap_terms(const PathView &view, Sequence first, double rps) noexcept {
    const Sequence move = view.path.move_of(first);
    TapTerms tap = line_of(view, move, rps);
    if (view.conditions.workspace.isMapped()) {
        const Ability can = ability_of_joints(view, move, tap, needed_speed(view, move, rps));
        tap.velocity = can.velocity;
        tap.acceleration = can.acceleration;
        return tap;
    }
    tap.velocity = view.path.plan(first).v_limit;
    tap.acceleration = tap_share(view.conditions.limits) * view.path.piece(first).acceleration.at(0);
    return tap;
}

TapVerdict check_tap(const PathView &view, Sequence move) noexcept {
    const PlannedPath &path = view.path;
    const MoveRequest &r = path.move(move).request;
    const PathLimits &limits = view.conditions.limits;
    const auto n = static_cast<std::size_t>(r.spindle);
    const double rps = view.conditions.scales.spindle_rps[n];
    const double ahead = std::abs(rps);
    const std::array<double, 2> &ramp = view.conditions.ramps[n];
    const double per_turn = r.feed_per_revolution * r.tag.feed_ratio;
    double load = pass_load(view, move) * std::max(1.0, r.tap_scale);
    double a =
        tap_share(limits) *
        limit_of(path.primitive(move), 0, path.primitive(move).length, limits.fitted(), UNLIMITED).a.at(0);
    if (view.conditions.workspace.isMapped()) {
        const double needed = needed_speed(view, move, rps);
        const Ability can = ability_of_joints(view, move, line_of(view, move, rps), needed);
        load = std::max(load, needed / std::max(can.most_speed, TapTuning::NO_SPEED));
        a = can.acceleration;
    }
    if (load > 1.0 + PassTuning::LOAD_ROUNDING) {
        return {TapObstacle::TOO_FAST, load};
    }
    const double abruptness = per_turn * std::max(ramp[0], ramp[1]) / (TapTuning::MEETING_SHARE * a);
    if (abruptness > 1.0) {
        return {TapObstacle::TOO_ABRUPT, abruptness};
    }
    if (limits.isFiltered()) {
        const double use = TapTuning::MEETING_SHARE * abruptness;
        const bool isOneByOne = isBackLong(line_of(view, move, rps), ramp, rps, limits.filter_s());
        // A spindle that slows down while it accelerates changes its acceleration by both.
        const double change = (isOneByOne ? 1.0 : 2.0) * std::max(ramp[0], ramp[1]);
        const double off = off_helix(change, use, limits.filter_s());
        if (off > TapTuning::MOST_OFF) {
            return {TapObstacle::TOO_SUDDEN, off};
        }
    }
    const double turn_back = ramp_at(ramp, rps);
    const double run_in = 0.5 * std::pow(per_turn * ahead, 2) / (TapTuning::MEETING_SHARE * a);
    const double overrun = turn_back > 0 ? 0.5 * ahead * ahead / turn_back * per_turn : 0.0;
    const double depth = path.primitive(move).length;
    if (run_in + overrun > depth) {
        return {TapObstacle::TOO_SHALLOW, (run_in + overrun) / depth};
    }
    return {};
}

}  // namespace mw::trajectory
