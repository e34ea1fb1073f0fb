// SPDX-License-Identifier: GPL-2.0-or-later
// Joining of moves: which corners are rounded, which are stops, and the limits of every stretch.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"

namespace mw::traj {

namespace {

/// Tangents that differ by less are the same but for rounding: the step of speed is below any limit.
constexpr double SAME_DIRECTION = 1e-11;
/// Exact path: joints that differ by rounding of a program's figures are passed, within a deviation that no
/// machine shows.
constexpr double EXACT_PATH_STEP = 0.02;
constexpr double EXACT_PATH_DEVIATION = 1e-6;
/// A path that turns back by more than this (cosine) is a reversal: the end of the move is what matters.
constexpr double REVERSAL_COSINE = -0.9;
/// Below this a blend is a stop.
constexpr double SMALLEST_BLEND = 1e-7;
/// Moves passed in one servo cycle at most; with all their pieces and up to four phases a piece this stays
/// below Executor::MAX_STEPS_PER_CYCLE.
constexpr double MOVES_PER_CYCLE = 12;
/// Arcs and blends are cut so that the direction of the path changes little on each piece [rad].
constexpr double ARC_CUT = 0.13;
constexpr double ARC_CUT_WHEN_SLOW = 0.5;
constexpr int MOST_ARC_CUTS = 64;
constexpr double BLEND_CUT = 0.3;
constexpr int MOST_BLEND_CUTS = 4;

}  // namespace

Planner::Planner(PathStore &store, const PlannerSettings &settings) noexcept
    : store_(store), settings_(settings) {
    Limits none;
    none.velocity.fill(UNLIMITED);
    none.acceleration.fill(UNLIMITED);
    none.jerk.fill(UNLIMITED);
    set_limits(none);
}

void Planner::set_limits(const Limits &limits) noexcept {
    wanted_ = limits;
    limits_ = limits_for_filter(limits, filter_, settings_.period_s);
}

void Planner::begin(const Pose &start, const Snapshot &now) noexcept {
    end_ = start;
    filter_ = filter_length(wanted_, settings_.period_s);
    set_limits(wanted_);
    programmed_s_ = 0;
    isStopPlan_ = false;
    first_move_ = last_move_ + 1;
    first_piece_ = last_piece_ + 1;
    oldest_piece_ = first_piece_;
    open_move_ = 0;
    changed_from_ = 0;
    drops_ = now.drops;
    plan_ = std::max(plan_, now.plan);
    plan_begin_ = plan_end_;
    plan_ends_.fill(plan_end_);
    switch_cycle_ = 0;
    planned_ = {};
    isAtEndOfPath_ = false;
    isStepping_ = false;
    start_delay_s_ = 0;
}

bool Planner::hasRoom(const Snapshot &now) const noexcept {
    constexpr Sequence PIECES_PER_MOVE = MOST_ARC_CUTS + MOST_BLEND_CUTS + 2;
    const Sequence oldest_piece = std::max(first_piece_, now.piece);
    if (last_piece_ + PIECES_PER_MOVE - oldest_piece >= PIECE_CAPACITY) {
        return false;
    }
    const Sequence oldest_move = last_piece_ < oldest_piece ? last_move_ : store_.piece(oldest_piece).move;
    // Moves that the mean still covers are kept as well.
    const Sequence kept = isFiltered() ? PRIMITIVE_CAPACITY / 4 : 4;
    return last_move_ + kept - oldest_move < PRIMITIVE_CAPACITY;
}

double Planner::wish_of(const MovePlan &m) const noexcept {
    if (m.request.isRapid || m.request.feed_per_revolution > 0 || !(m.feed > 0)) {
        return UNLIMITED;
    }
    return m.request.isOverridable ? m.feed * std::max(1.0, scales_.max_feed) : m.feed;
}

Sequence Planner::add(const Primitive &primitive, const MoveRequest &request) noexcept {
    const Sequence n = ++last_move_;
    store_.primitive(n) = primitive;
    const FeedLength feed = feed_length(primitive);
    MovePlan &m = move_plan(n);
    m.request = request;
    m.request.isAngular = feed.isAngular;
    m.request.tag.feed_ratio = primitive.length / feed.length;
    m.request.tag.end = primitive.end;
    m.feed = request.tag.requested_velocity * m.request.tag.feed_ratio;
    m.start_s = programmed_s_;
    programmed_s_ += primitive.length;
    store_.move(n) = m.request.tag;
    end_ = primitive.end;
    last_synched_ = request.feed_per_revolution > 0 ? n : last_synched_;

    Joint joint;
    if (open_move_ != 0) {
        joint = joint_between(open_move_, n);
        const Primitive &before = store_.primitive(open_move_);
        close_move(before.length - joint.d, !(joint.d > 0));
        if (joint.d > 0) {
            const MovePlan &a = move_plan(open_move_);
            const double wish = std::min(wish_of(a), wish_of(m));
            isOpenStop_ = false;
            add_blend(before, primitive, joint, wish);
        }
    } else if (n > first_move_) {
        const Pose step = tangent_step(store_.primitive(n - 1), primitive);
        joint.isStop = geom::norm(step) > SAME_DIRECTION || m.request.isGated ||
                       move_plan(n - 1).request.join == Join::STOP;
        joint.dwell_s = filter_s();
    }
    open_move_ = n;
    open_offset_ = joint.d;
    isOpenStop_ = joint.isStop;
    open_dwell_s_ = joint.dwell_s;
    return n;
}

void Planner::release_end() noexcept {
    if (open_move_ != 0) {
        close_move(store_.primitive(open_move_).length, true);
        open_move_ = 0;
    }
}

void Planner::add_blend(const Primitive &a, const Primitive &b, const Joint &joint, double wish) noexcept {
    const double d = joint.d;
    const double turn = geom::norm(tangent_step(a, b));
    const SpeedLimit whole = limit_of_blend(a, b, {d, 0, 2.0 * d}, limits_, wish);
    const int cuts =
        whole.v < wish ? std::clamp(static_cast<int>(turn / BLEND_CUT) + 1, 1, MOST_BLEND_CUTS) : 1;
    Piece piece;
    piece.primitive = open_move_;
    piece.move = open_move_;
    piece.blend_d = d;
    piece.tolerance = tolerance_of(move_plan(open_move_).request);
    const double other = tolerance_of(move_plan(open_move_ + 1).request);
    piece.tolerance = piece.tolerance > 0 && other > 0 ? std::min(piece.tolerance, other)
                                                       : std::max(piece.tolerance, other);
    for (int i = 0; i < cuts; ++i) {
        const double from = 2.0 * d * i / cuts;
        const double to = 2.0 * d * (i + 1) / cuts;
        piece.offset = from;
        piece.length = to - from;
        piece.programmed_s = move_plan(open_move_).start_s + a.length - d + from;
        SpeedLimit limit = cuts == 1 ? whole : limit_of_blend(a, b, {d, from, to}, limits_, wish);
        limit.v = std::min(limit.v, joint.v);
        add_piece(piece, limit);
    }
}

/// The open move's own part, from the end of the blend before it up to `to`.
void Planner::close_move(double to, bool isToEnd) noexcept {
    const Primitive &p = store_.primitive(open_move_);
    const double from = open_offset_;
    if (to - from <= 1e-12 * p.length) {
        return;
    }
    const MoveRequest &request = move_plan(open_move_).request;
    const double wish = std::min(wish_of(move_plan(open_move_)), filtered_arc_speed(p, request));
    const SpeedLimit whole = limit_of(p, from, to, limits_, wish);
    int cuts = 1;
    if (p.isArc) {
        const double cut = whole.v < wish ? ARC_CUT : ARC_CUT_WHEN_SLOW;
        const double pieces = std::ceil(std::abs(p.omega) * (to - from) / cut);
        cuts = static_cast<int>(std::clamp(pieces, 1.0, static_cast<double>(MOST_ARC_CUTS)));
    }
    Piece piece;
    piece.primitive = open_move_;
    piece.move = open_move_;
    piece.tolerance = tolerance_of(request);
    for (int i = 0; i < cuts; ++i) {
        const double begin = from + (to - from) * i / cuts;
        const double end = i + 1 == cuts ? to : from + (to - from) * (i + 1) / cuts;
        piece.offset = begin;
        piece.programmed_s = move_plan(open_move_).start_s + begin;
        piece.length = end - begin;
        piece.isToEnd = isToEnd && i + 1 == cuts;
        add_piece(piece, cuts == 1 ? whole : limit_of(p, begin, end, limits_, wish));
        isOpenStop_ = false;
    }
}

void Planner::add_piece(const Piece &piece, const SpeedLimit &limit) noexcept {
    const Sequence k = last_piece_ + 1;
    Piece &slot = store_.piece(k);
    slot = piece;
    slot.acceleration = limit.a;
    PiecePlan &plan = piece_plan(k);
    plan.v_limit =
        std::min(limit.v, MOVES_PER_CYCLE * store_.primitive(piece.primitive).length / settings_.period_s);
    plan.v2_in = -1;
    plan.isStopBefore = isOpenStop_;
    plan.dwell_s = isOpenStop_ ? open_dwell_s_ : filter_s();
    last_piece_ = k;
    isAtEndOfPath_ = false;
    // Release: the executor that sees the number (acquire) sees the piece and its primitives filled.
    store_.last_piece.store(k, std::memory_order_release);
}

Planner::Joint Planner::joint_between(Sequence na, Sequence nb) const noexcept {
    const Primitive &a = store_.primitive(na);
    const Primitive &b = store_.primitive(nb);
    const MovePlan &ma = move_plan(na);
    const MovePlan &mb = move_plan(nb);
    const bool isStop = ma.request.join == Join::STOP || mb.request.isGated || ma.request.tag.isProbe ||
                        mb.request.tag.isProbe;
    if (isStop) {
        return {.isStop = true, .dwell_s = filter_s()};
    }
    const double step = geom::norm(tangent_step(a, b));
    if (step <= SAME_DIRECTION) {
        return {};
    }
    const bool isExact = ma.request.join == Join::EXACT || mb.request.join == Join::EXACT;
    const Pose ta = derivative_at(a, a.length);
    const Pose tb = derivative_at(b, 0);
    const bool isCorner = isExact && step > EXACT_PATH_STEP;
    const bool isReversal = geom::dot(ta, tb) < REVERSAL_COSINE * geom::norm(ta) * geom::norm(tb);
    double tolerance = isExact ? EXACT_PATH_DEVIATION : ma.request.tolerance;
    const bool isOther = !isExact && mb.request.tolerance > 0;
    if (isOther) {
        tolerance = tolerance > 0 ? std::min(tolerance, mb.request.tolerance) : mb.request.tolerance;
    }
    if (isFiltered()) {
        return filtered_corner(na, nb, tolerance, isCorner || isReversal);
    }
    return corner(na, nb, tolerance, isCorner || isReversal);
}

/// The blend within the tolerance that is wide enough for the speed; a stop where there is none.
Planner::Joint Planner::corner(Sequence na, Sequence nb, double tolerance, bool mustStop) const noexcept {
    if (mustStop) {
        return {.isStop = true};
    }
    const Primitive &a = store_.primitive(na);
    const Primitive &b = store_.primitive(nb);
    double d = 0.5 * std::min(a.length, b.length);
    if (tolerance > 0) {
        d = std::min(d, blend_d_for_tolerance(a, b, tolerance));
    }
    const double va = limit_of(a, 0, a.length, limits_, wish_of(move_plan(na))).v;
    const double vb = limit_of(b, 0, b.length, limits_, wish_of(move_plan(nb))).v;
    d = std::min(d, blend_d_for_speed(a, b, limits_, std::min(va, vb)));
    return d > SMALLEST_BLEND ? Joint{.d = d} : Joint{.isStop = true};
}

bool Planner::add_event(PathEvent event) noexcept {
    event.after_move = last_move_;
    event.drops = drops_;
    return store_.events.push(event);
}

}  // namespace mw::traj
