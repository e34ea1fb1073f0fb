// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/pass_builder.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::plan {

namespace {

/// Factor of all limits. The rest is a margin for rounding.
constexpr double FULL = 0.9999;
/// Corners are made for the current spindle speed times this factor.
constexpr double SPEED_RESERVE = 1.1;
/// Parts of the acceleration and of the jerk for the change of direction in a corner, and part of the jerk
/// for the change of direction while the speed changes. The rest is for changes of the speed.
constexpr double TURNING_A = 0.5, TURNING_J = 0.3, CROSS_J = 0.4;
/// Fraction of the second line into which the corner may be shifted. The end of this line may be at a
/// shoulder.
constexpr double ROOM_SHARE = 0.95;
/// SAME_DIRECTION: a smaller change of the tangent is no corner. REVERSAL_COSINE: lines reverse if the cosine
/// between their tangents is smaller.
constexpr double SAME_DIRECTION = 1e-9, REVERSAL_COSINE = -0.999;
constexpr double SMALLEST_CORNER = 1e-6;

/// Maximum derivatives of one limited coordinate on a leg, and its limits.
struct Row {
    double q1 = 0, q2 = 0, q3 = 0;
    MotionLimits limits;
};
using Rows = std::array<Row, geometry::AXIS_COUNT + 1>;

/// Rows from derivatives per coordinate. The last row is the norm of X Y Z.
template <class Derivatives>
Rows rows_of(const Limits &limits, Derivatives derivatives) noexcept {
    Rows rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = derivatives(i);
        rows[i].limits = {FULL * limits.velocity[i], FULL * limits.acceleration[i],
                          limits.isJerkLimited ? FULL * limits.jerk[i] : UNLIMITED};
    }
    return rows;
}

double size_of(const Pose &p, std::size_t i) noexcept {
    return i == XYZ_NORM ? geometry::norm_xyz(p) : std::abs(p.c[i]);
}

Rows rows_of(const Primitive &p, const Limits &limits) noexcept {
    PerLimited q1{}, q2{};
    derivative_bounds(p, 0, p.length, q1, q2);
    const double turning = p.isArc ? std::abs(p.omega) : 0.0;
    return rows_of(limits, [&](std::size_t i) { return Row{q1[i], q2[i], q2[i] * turning, {}}; });
}

/// Rows of a corner whose tangent changes over the length 2 d as 3 u^2 - 2 u^3.
Rows corner_rows(const Pose &from, const Pose &to, double d, const Limits &limits) noexcept {
    const double length = 2 * d;
    return rows_of(limits, [&](std::size_t i) {
        const double turn = size_of(to - from, i);
        return Row{std::max(size_of(from, i), size_of(to, i)),
                   1.5 * turn / length,
                   6.0 * turn / (length * length),
                   {}};
    });
}

/// The speed at which the change of direction uses its part of acceleration and jerk.
double most_speed(const Rows &rows) noexcept {
    double v = UNLIMITED;
    for (const Row &row : rows) {
        v = row.q1 > 0 ? std::min(v, row.limits.velocity / row.q1) : v;
        v = row.q2 > 0 ? std::min(v, std::sqrt(TURNING_A * row.limits.acceleration / row.q2)) : v;
        v = row.q3 > 0 ? std::min(v, std::cbrt(TURNING_J * row.limits.jerk / row.q3)) : v;
    }
    return v;
}

/// Remaining acceleration and jerk along the curve up to the speed v.
MotionLimits left_at(const Rows &rows, double v) noexcept {
    MotionLimits left{v, UNLIMITED, UNLIMITED};
    for (const Row &row : rows) {
        if (row.q1 > 0) {
            left.acceleration =
                std::min(left.acceleration, (row.limits.acceleration - row.q2 * v * v) / row.q1);
        }
        if (row.q2 * v > 0) {
            left.acceleration = std::min(left.acceleration, CROSS_J * row.limits.jerk / (3 * row.q2 * v));
        }
    }
    for (const Row &row : rows) {
        if (row.q1 > 0) {
            const double turning = row.q3 * v * v * v + 3 * row.q2 * v * left.acceleration;
            left.jerk = std::min(left.jerk, (row.limits.jerk - turning) / row.q1);
        }
    }
    return left;
}

MotionLimits limits_of(const Rows &rows) noexcept {
    return left_at(rows, most_speed(rows));
}

/// Half of the length of a corner that can be passed at the speed v.
double half_for_speed(const Pose &from, const Pose &to, const Limits &limits, double v) noexcept {
    double d = 0;
    for (const Row &row : corner_rows(from, to, 1.0, limits)) {  // q2 is proportional to 1/d, q3 to 1/d^2
        d = std::max(d, row.q2 * v * v / (TURNING_A * row.limits.acceleration));
        d = std::max(d, std::sqrt(row.q3 * v * v * v / (TURNING_J * row.limits.jerk)));
    }
    return d;
}

}  // namespace

MotionLimits limits_along(const Primitive &line, const Limits &limits) noexcept {
    return limits_of(rows_of(line, limits));
}

void PassBuilder::begin(double s) noexcept {
    s_ = s;
    turns_ = 0;
    is_open_ = false;
    driven_ = 0;
    exact_.begin(s);
}

bool PassBuilder::continues(const PassMove &move) const noexcept {
    if (!is_open_ || open_.primitive.isArc || move.primitive.isArc) {
        return false;
    }
    const Pose &from = open_.primitive.lin, &to = move.primitive.lin;
    return geometry::dot(from, to) > REVERSAL_COSINE * geometry::norm(from) * geometry::norm(to);
}

PassBuilder::Corner PassBuilder::corner_to(const PassMove &next,
                                           const Conditions &conditions) const noexcept {
    const Primitive &a = open_.primitive, &b = next.primitive;
    if (geometry::norm(b.lin - a.lin) <= SAME_DIRECTION) {
        return {};
    }
    const double v = SPEED_RESERVE * std::max(open_.speed, next.speed);
    const double room = 0.5 * std::min(a.length - driven_, b.length);
    Corner corner;
    corner.half = std::min(half_for_speed(a.lin, b.lin, conditions.limits.wanted(), v), room);
    corner.half = std::max(corner.half, std::min(SMALLEST_CORNER, room));
    const double most = ROOM_SHARE * geometry::dot(b.end - b.start, a.lin);
    corner.behind = std::clamp(corner.half, 0.0, std::max(0.0, most));
    if (!conditions.workspace.holds(a.end + a.lin * corner.behind)) {
        corner.behind = 0;
    }
    return corner;
}

double PassBuilder::add(const PassMove &move, const Conditions &conditions) {
    PassMove driven = move;
    double length = move.primitive.length;
    double per_unit = 1.0 / move.per_turn;
    driven_ = is_open_ ? driven_ : 0.0;
    if (is_open_) {
        const Corner corner = corner_to(move, conditions);
        const Pose turn = open_.primitive.end + open_.primitive.lin * corner.behind;
        if (corner.behind > 0) {
            driven.primitive = make_line(turn, move.primitive.end);
            length = corner.behind + driven.primitive.length;
            per_unit *= move.primitive.length / length;
        }
        const Limits &limits = conditions.limits.wanted();
        const double half = std::min(corner.half, 0.5 * driven.primitive.length);
        close(open_.primitive.length + corner.behind - half, limits);
        if (half > 0) {
            add_corner({half, corner.behind}, driven.primitive, per_unit, limits);
        }
        driven_ = half;
    }
    open_ = driven;
    per_unit_ = per_unit;
    is_open_ = true;
    return length;
}

void PassBuilder::add_leg(const LimitedLeg &leg) {
    legs_.push_back(leg);
    turns_ = leg.leg.turns_at(leg.leg.start_s + leg.leg.length);
    s_ = leg.leg.start_s + leg.leg.length;
}

/// Adds the open move up to `length` as a leg.
void PassBuilder::close(double length, const Limits &limits) {
    Primitive part = open_.primitive;
    if (!part.isArc && (driven_ > 0 || length != part.length)) {
        part.start = part.base = part.start + part.lin * driven_;
        part.length = length - driven_;
        part.end = length == open_.primitive.length ? part.end : part.start + part.lin * part.length;
    }
    if (!(part.length > 0)) {
        return;
    }
    exact_.begin(s_);
    exact_.add(part);
    exact_.move_spans(spans_, seams_);
    seams_.clear();
    const MotionLimits left = limits_along(open_.primitive, limits);
    PassLeg leg;
    leg.start_s = s_;
    leg.length = part.length;
    leg.turns = turns_;
    leg.per_unit_in = leg.per_unit_out = per_unit_;
    leg.v_most = left.velocity;
    add_leg({leg, left.acceleration, left.jerk});
}

// With the tangent t(u) = a + (b - a)(3 u^2 - 2 u^3), u from 0 to 1 over the length h, the position is
// h (a u + (b - a)(u^3 - u^4/2)).
void PassBuilder::add_corner(const Corner &corner, const Primitive &next, double per_unit,
                             const Limits &limits) {
    const Pose &from = open_.primitive.lin;
    const double h = 2 * corner.half;
    const Pose turn = next.lin - from;
    curve::Span span;
    span.start_s = s_;
    span.length = h;
    span.c[0] = open_.primitive.end + from * (corner.behind - corner.half);
    span.c[1] = from * h;
    span.c[3] = turn * h;
    span.c[4] = turn * (-0.5 * h);
    span.find_moving();
    spans_.push_back(span);
    const MotionLimits left = limits_of(corner_rows(from, next.lin, corner.half, limits));
    PassLeg leg;
    leg.start_s = s_;
    leg.length = h;
    leg.turns = turns_;
    leg.per_unit_in = per_unit_;
    leg.per_unit_out = per_unit;
    leg.v_most = left.velocity;
    add_leg({leg, left.acceleration, left.jerk});
}

void PassBuilder::finish(const Limits &limits) {
    if (is_open_) {
        close(open_.primitive.length, limits);
    }
    is_open_ = false;
    driven_ = 0;
}

void PassBuilder::move_parts(std::vector<curve::Span> &spans, std::vector<LimitedLeg> &legs) {
    spans.insert(spans.end(), spans_.begin(), spans_.end());
    legs.insert(legs.end(), legs_.begin(), legs_.end());
    spans_.clear();
    legs_.clear();
}

double pass_load(const PlannedPath &path, const Conditions &conditions, Sequence move) noexcept {
    double load = 0;
    double length = 0;
    double ramps = 0;  // distance for acceleration and deceleration
    for (Sequence n = move; n <= path.last_move(); ++n) {
        const MoveRequest &r = path.move(n).request;
        if (!conditions.isLocked(r) || (n > move && r.isGated)) {
            break;
        }
        const Primitive &p = path.primitive(n);
        const MotionLimits limits = limits_along(p, conditions.limits.wanted());
        const double v = turning_speed(r, conditions.scales);
        const double operators = conditions.scales.max_velocity * r.tag.feed_ratio;
        load = std::max(load, v / std::min(limits.velocity, operators));
        length += p.length;
        const double gain = speed_change({}, v, limits.acceleration, limits.jerk).distance;
        ramps = std::max(ramps, 2 * gain);
    }
    // If no part of the pass would have the full speed, the maximum possible speed is about proportional to
    // the square root of the length.
    return load <= 1.0 && ramps > length ? std::sqrt(ramps / length) : load;
}

void limit_leg_ends(std::vector<PassLeg> &legs, const MotionLimits &limits) noexcept {
    double v_out = 0;
    for (auto leg = legs.rbegin(); leg != legs.rend(); ++leg) {
        leg->v_out = v_out;
        const double reached = std::sqrt(v_out * v_out + 2 * limits.acceleration * leg->length);
        const double v_in = highest_allowed(0, std::min(leg->v_most, reached), [&](double v) {
            const MotionState in{0, v, 0};
            return v <= leg->v_out ||
                   speed_change(in, leg->v_out, limits.acceleration, limits.jerk).distance <= leg->length;
        });
        const auto before = std::next(leg);
        v_out = before != legs.rend() ? std::min(v_in, before->v_most) : v_in;
    }
}

}  // namespace mw::trajectory::plan
