// SPDX-License-Identifier: GPL-2.0-or-later
// Joining of moves: which corners are rounded, which are stops, and the limits of every stretch.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

Planner::Planner(PathStore &store, const PlannerSettings &settings) noexcept
    : store_(store), settings_(settings) {
    Limits none;
    none.velocity.fill(UNLIMITED);
    none.acceleration.fill(UNLIMITED);
    none.jerk.fill(UNLIMITED);
    set_limits(none);
    room_low_.c.fill(-UNLIMITED);
    room_high_.c.fill(UNLIMITED);
}

void Planner::set_limits(const Limits &limits) noexcept {
    wanted_ = limits;
    for (std::size_t i = 0; i < limits.velocity.size(); ++i) {
        highest_.velocity[i] = std::max(highest_.velocity[i], limits.velocity[i]);
        highest_.acceleration[i] = std::max(highest_.acceleration[i], limits.acceleration[i]);
    }
    limits_ = limits_for_filter(limits, filter_, settings_.period_s);
    nominal_tolerance_ = 0;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double v = limits.velocity[static_cast<std::size_t>(i)];
        const bool isCounted = !geom::isAngular(i) && v < UNLIMITED;
        nominal_tolerance_ =
            isCounted ? std::max(nominal_tolerance_, v * PathTuning::NOMINAL_S) : nominal_tolerance_;
    }
}

double Planner::path_tolerance(const MoveRequest &request) const noexcept {
    return request.join != Join::BLEND ? 0.0 : request.tolerance > 0 ? request.tolerance : nominal_tolerance_;
}

bool Planner::suits(double tolerance) const noexcept {
    const auto wanted = static_cast<double>(filter_length(wanted_, settings_.period_s, tolerance));
    return tolerance <= 0 || static_cast<double>(filter_) <= wanted * PathTuning::MOST_UNSUITED;
}

void Planner::begin(const Pose &start, const Snapshot &now, double tolerance) noexcept {
    end_ = start;
    filter_ = filter_length(wanted_, settings_.period_s, tolerance);
    highest_ = wanted_;
    set_limits(wanted_);
    programmed_s_ = 0;
    isStopPlan_ = false;
    first_move_ = last_move_ + 1;
    first_piece_ = last_piece_ + 1;
    oldest_piece_ = first_piece_;
    open_move_ = 0;
    raw_move_ = 0;
    shift_ = {};
    shift_drive_ = {};
    refusals_ = 0;
    changed_from_ = 0;
    drops_ = now.drops;
    plan_ = std::max(plan_, now.plan);
    plan_begin_ = plan_end_;
    plan_ends_.fill(plan_end_);
    switch_cycle_ = 0;
    planned_ = {};
    isAtEndOfPath_ = false;
    start_delay_s_ = 0;
}

bool Planner::hasRoom(const Snapshot &now) const noexcept {
    constexpr Sequence PIECES_PER_MOVE = PathTuning::MOST_ARC_CUTS + PathTuning::MOST_BLEND_CUTS + 2;
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

void Planner::fill_move(Sequence n, const Primitive &primitive, const MoveRequest &request) noexcept {
    store_.primitive(n) = primitive;
    const FeedLength feed = feed_length(primitive);
    MovePlan &m = move_plan(n);
    m.request = request;
    m.request.isAngular = feed.isAngular;
    m.request.tag.feed_ratio = primitive.length / feed.length;
    m.request.tag.end = primitive.end;
    m.free_tolerance =
        std::max(nominal_tolerance_, primitive.isArc ? PathTuning::FREE_OF_RADIUS * primitive.radius
                                                     : PathTuning::FREE_OF_LENGTH * primitive.length);
    m.feed = request.tag.requested_velocity * m.request.tag.feed_ratio;
    store_.move(n) = m.request.tag;
    programmed_s_ = m.start_s + primitive.length;
    end_ = primitive.end;
}

Sequence Planner::add(const Primitive &primitive, const MoveRequest &request) noexcept {
    if (canJoin(primitive, request) && join_line(primitive, request)) {
        return last_move_;
    }
    const Sequence n = ++last_move_;
    MovePlan &m = move_plan(n);
    m.start_s = programmed_s_;
    m.deviation = 0;
    m.shift_in = {};
    m.shift_out = {};
    fill_move(n, primitive, request);
    shape_corner(raw_move_, n);
    joined_count_ = 0;
    isJoinable_ = true;
    last_synched_ = request.feed_per_revolution > 0 ? n : last_synched_;

    join_raw();
    raw_move_ = n;
    return n;
}

/// Joins the newest move to the one before it, now that it is known to be whole.
void Planner::join_raw() noexcept {
    if (raw_move_ == 0) {
        return;
    }
    const Sequence n = raw_move_;
    raw_move_ = 0;
    const Primitive &primitive = store_.primitive(n);
    const MovePlan &m = move_plan(n);
    Joint joint;
    if (open_move_ != 0) {
        joint = joint_between(open_move_, n);
        if (joint.d > 0 && isLocked(open_move_) && isLocked(n)) {
            move_corner_on(open_move_, n, joint);
        }
        const Primitive &before = store_.primitive(open_move_);
        close_move(before.length - joint.d, !(joint.d > 0), joint);
        if (joint.d > 0) {
            const MovePlan &a = move_plan(open_move_);
            const double wish = std::min(wish_of(a), wish_of(m));
            isOpenStop_ = false;
            add_blend(before, primitive, joint, wish);
        }
    } else if (n > first_move_) {
        const Pose step = tangent_step(store_.primitive(n - 1), primitive);
        joint.isStop = geom::norm(step) > PathTuning::SAME_DIRECTION || m.request.isGated ||
                       move_plan(n - 1).request.join == Join::STOP || isAlongOnly(primitive, m.request) ||
                       isAlongOnly(store_.primitive(n - 1), move_plan(n - 1).request);
        joint.dwell_s = filter_s();
    }
    open_move_ = n;
    open_offset_ = joint.d;
    isOpenStop_ = joint.isStop;
    open_joint_ = joint;
}

void Planner::release_end() noexcept {
    join_raw();
    if (open_move_ != 0) {
        close_move(store_.primitive(open_move_).length, true, {});
        open_move_ = 0;
    }
}

void Planner::add_blend(const Primitive &a, const Primitive &b, const Joint &joint, double wish) noexcept {
    const double d = joint.d;
    const double turn = geom::norm(tangent_step(a, b));
    // A curve among others leaves room for what the mean brings together; one that stands alone is passed
    // at one speed.
    const double reach = isFiltered() ? joint.v * filter_s() : 0.0;
    const bool isShared =
        isFiltered() && std::min(a.length, b.length) < PathTuning::SHARED_REACH * reach + 2.0 * d;
    const SpeedLimit whole =
        isShared ? shared_limit(a, b, joint, wish) : limit_of_blend(a, b, {d, 0, 2.0 * d}, limits_, wish);
    const int cuts = whole.v < wish ? std::clamp(static_cast<int>(turn / PathTuning::BLEND_CUT) + 1, 1,
                                                 PathTuning::MOST_BLEND_CUTS)
                                    : 1;
    Piece piece;
    piece.primitive = open_move_;
    piece.move = open_move_;
    piece.blend_d = d;
    piece.tolerance = tolerance_of(move_plan(open_move_));
    const double other = tolerance_of(move_plan(open_move_ + 1));
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

/// The open move's own part, from the end of the blend before it up to `to`, where the blend of `next` begins
/// if there is one.
void Planner::close_move(double to, bool isToEnd, const Joint &next) noexcept {
    const Primitive &p = store_.primitive(open_move_);
    const double from = open_offset_;
    if (to - from <= 1e-12 * p.length) {
        return;
    }
    const MovePlan &m = move_plan(open_move_);
    Piece piece;
    piece.primitive = open_move_;
    piece.move = open_move_;
    piece.tolerance = tolerance_of(m);
    piece.offset = from;
    const double wish = std::min(wish_of(m), filtered_arc_speed(p, m));
    const bool isAfterBlend = isFiltered() && open_joint_.d > 0;
    const bool isBeforeBlend = isFiltered() && next.d > 0;
    const double length = to - from;
    const auto zone = [&](const Joint &joint) {
        const double way = zone_length(p, joint, wish);
        const bool isFit = way < PathTuning::ZONE_SHARE * length;
        return joint.isStop ? std::min(way, PathTuning::ZONE_SHARE * length) : isFit ? way : 0.0;
    };
    const double before = zone(open_joint_);
    const double after = zone(next);
    if (before > 0) {
        const Sequence first = last_piece_ + 1;
        add_part(piece, from + before, false, open_joint_.isStop ? wish : open_joint_.v);
        make_gentle(first, open_joint_.gentle);
    }
    const Sequence first = last_piece_ + 1;
    piece.offset = from + before;
    add_part(piece, to - after, isToEnd && !(after > 0), wish);
    const auto taken_by = [](bool isNear, const Joint &j) { return isNear ? j.turning / (j.v * j.v) : 0.0; };
    const double taken = std::max(taken_by(isAfterBlend && !(before > 0), open_joint_),
                                  taken_by(isBeforeBlend && !(after > 0), next));
    for (Sequence k = first; k <= last_piece_ && taken > 0 && !p.isArc; ++k) {
        AccelBound &bound = store_.piece(k).acceleration;
        for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
            bound.beta[i] += CornerTuning::SHARED_TURNS * bound.alpha[i] * taken;
            bound.alpha[i] *= CornerTuning::SHARED_REST;
        }
    }
    if (after > 0) {
        const Sequence last = last_piece_ + 1;
        piece.offset = to - after;
        add_part(piece, to, isToEnd, next.isStop ? wish : next.v);
        make_gentle(last, next.gentle);
    }
}

/// Next to a curve that stands alone the speed stays as it is there, so that turning and braking do not meet
/// in the mean; what curves close by take of the acceleration at the same speed is not there for the path.
/// Next to a stop that overlaps in the mean the acceleration may have to be less.
double Planner::zone_length(const Primitive &p, const Joint &joint, double wish) const noexcept {
    const bool isNone = !isFiltered() || p.isArc;
    if (!isNone && joint.d > 0) {
        return std::min(joint.v, wish) * filter_s();
    }
    if (isNone || !joint.isStop || joint.gentle >= 1.0) {
        return 0;
    }
    const double shared = filter_s() - joint.dwell_s + settings_.period_s;
    return 0.5 * limit_of(p, 0, p.length, limits_, wish).a.at(0) * joint.gentle * shared * shared;
}

void Planner::make_gentle(Sequence from, double part) noexcept {
    for (Sequence k = from; k <= last_piece_ && part < 1.0; ++k) {
        scale_piece(k, 1.0, part);
    }
}

/// The part of the open move from piece.offset up to `to`, at most at the speed v.
void Planner::add_part(Piece piece, double to, bool isToEnd, double v) noexcept {
    const Primitive &p = store_.primitive(open_move_);
    const MovePlan &m = move_plan(open_move_);
    const double from = piece.offset;
    const double wish = std::min(v, wish_of(m));
    SpeedLimit whole = limit_of(p, from, to, limits_, wish);
    int cuts = 1;
    piece.isAlong = isAlongOnly(p, m.request);
    if (piece.isAlong) {
        whole = along_limit(p, wish);
    } else if (p.isArc) {
        const double cut = whole.v < wish ? PathTuning::ARC_CUT : PathTuning::ARC_CUT_WHEN_SLOW;
        const double pieces = std::ceil(std::abs(p.omega) * (to - from) / cut);
        cuts = static_cast<int>(std::clamp(pieces, 1.0, static_cast<double>(PathTuning::MOST_ARC_CUTS)));
    }
    if (joint_map_ != nullptr && !piece.isAlong) {
        // Joints may run on curves where the path is straight.
        const double pieces = std::ceil(geom::norm_abc(p.lin) * (to - from) / PathTuning::JOINT_CUT_DEG);
        cuts = std::max(cuts, static_cast<int>(std::clamp(pieces, PathTuning::LEAST_JOINT_CUTS,
                                                          static_cast<double>(PathTuning::MOST_ARC_CUTS))));
    }
    for (int i = 0; i < cuts; ++i) {
        const double begin = from + (to - from) * i / cuts;
        const double end = i + 1 == cuts ? to : from + (to - from) * (i + 1) / cuts;
        piece.offset = begin;
        piece.programmed_s = m.start_s + begin;
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
    const SpeedLimit lowest = joint_map_ == nullptr ? limit : limit_with_joints(piece, limit);
    slot.acceleration = lowest.a;
    PiecePlan &plan = piece_plan(k);
    plan.v_limit = std::min(lowest.v, PathTuning::MOVES_PER_CYCLE * store_.primitive(piece.primitive).length /
                                          settings_.period_s);
    plan.v2_in = -1;
    plan.isStopBefore = isOpenStop_;
    plan.eased_in = 0;
    plan.gentle = 1;
    plan.dwell_s = isOpenStop_ ? open_joint_.dwell_s : filter_s();
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
    const bool isPass = isLocked(na) && isLocked(nb) && ma.request.spindle == mb.request.spindle;
    const bool isStop =
        (ma.request.join == Join::STOP && !isPass) || mb.request.isGated || ma.request.tag.isProbe ||
        mb.request.tag.isProbe ||
        (isLocked(na) || isLocked(nb) ? !isPass : ma.request.isSynched() != mb.request.isSynched());
    if (isStop) {
        return {.isStop = true, .dwell_s = filter_s()};
    }
    if (isPass) {
        return locked_corner(na, nb);
    }
    const double step = geom::norm(tangent_step(a, b));
    const bool isAlong = isAlongOnly(a, ma.request) || isAlongOnly(b, mb.request);
    if (isAlong) {
        return {.isStop = true, .dwell_s = filter_s()};
    }
    if (step <= PathTuning::SAME_DIRECTION) {
        return {};
    }
    const bool isExact = ma.request.join != Join::BLEND || mb.request.join != Join::BLEND;
    const Pose ta = derivative_at(a, a.length);
    const Pose tb = derivative_at(b, 0);
    const bool isCorner = isExact && step > PathTuning::EXACT_STEP;
    const bool isReversal = geom::dot(ta, tb) < PathTuning::REVERSAL_COSINE * geom::norm(ta) * geom::norm(tb);
    double tolerance = isExact ? PathTuning::EXACT_DEVIATION : tolerance_of(ma);
    const double other = tolerance_of(mb);
    if (!isExact && other > 0) {
        tolerance = tolerance > 0 ? std::min(tolerance, other) : other;
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
    return d > PathTuning::SMALLEST_BLEND ? Joint{.d = d} : Joint{.isStop = true};
}

/// The line may become a part of the open one: same demands, and nothing happens in between.
bool Planner::canJoin(const Primitive &line, const MoveRequest &request) const noexcept {
    if (raw_move_ == 0 || !isJoinable_ || isStepping_ || !settings_.isMerging) {
        return false;
    }
    const MoveRequest &open = move_plan(raw_move_).request;
    const bool isSame = open.tag.requested_velocity == request.tag.requested_velocity &&
                        open.tolerance == request.tolerance &&
                        open.merge_tolerance == request.merge_tolerance &&
                        open.corner_scale == request.corner_scale && open.isRapid == request.isRapid &&
                        open.isOverridable == request.isOverridable && open.tag.type == request.tag.type;
    const bool isPlain = open.join == Join::BLEND && request.join == Join::BLEND && !request.isGated &&
                         !(request.feed_per_revolution > 0) && !(open.feed_per_revolution > 0);
    return isSame && isPlain && !line.isArc && !store_.primitive(raw_move_).isArc &&
           joined_count_ < PathTuning::MOST_JOINED;
}

/// Makes the open line go to the end of `line` if all ends in between stay near it, in order.
bool Planner::join_line(const Primitive &line, const MoveRequest &request) noexcept {
    double allowed = request.merge_tolerance;
    if (request.tolerance > 0 && !request.isMergeAdded) {
        allowed = std::min(std::max(allowed, PathTuning::JOIN_SHARE * request.tolerance),
                           PathTuning::MOST_JOIN_SHARE * request.tolerance);
    }
    const Primitive &open = store_.primitive(raw_move_);
    const Pose shift = move_plan(raw_move_).shift_in;
    const Primitive whole = make_line(open.start - shift, line.end);
    joined_[joined_count_] = open.end;
    double along = 0;
    double worst = 0;
    for (std::size_t i = 0; i <= joined_count_; ++i) {
        const Pose off = joined_[i] - whole.start;
        const double s = geom::dot(off, whole.lin);
        const Pose side = off - whole.lin * s;
        worst = std::max({worst, geom::norm_linear(side), geom::norm_abc(side)});
        if (!(s > along) || s >= whole.length || worst > allowed) {
            return false;
        }
        along = s;
    }
    ++joined_count_;
    move_plan(raw_move_).deviation = request.isMergeAdded ? 0.0 : worst;
    fill_move(raw_move_, whole, request);
    if (shift != Pose{}) {
        reshape(raw_move_, shift, {});
    }
    return true;
}

bool Planner::add_event(PathEvent event) noexcept {
    isJoinable_ = false;
    event.after_move = last_move_;
    event.drops = drops_;
    return store_.events.push(event);
}

}  // namespace mw::traj
