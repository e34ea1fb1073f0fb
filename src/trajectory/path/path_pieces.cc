// SPDX-License-Identifier: GPL-2.0-or-later
// Cuts moves and blends into pieces with separate limits.
#include <algorithm>
#include <cmath>
#include <optional>

#include "trajectory/path/braking.hh"
#include "trajectory/path/exact_arc.hh"
#include "trajectory/path/path_builder.hh"

namespace mw::trajectory {

namespace {

/// Next to a single curve the speed stays constant, so that centripetal acceleration and braking do not meet
/// in the moving average. The path does not get the acceleration that near curves need at the same speed.
/// Next to a stop that overlaps in the average, the acceleration may have to be less.
double zone_length(const Primitive &p, const Corner &corner, const PathLimits &limits, double wish) noexcept {
    const bool isNone = !limits.isFiltered() || p.isArc;
    if (!isNone && corner.blend_d > 0) {
        return std::min(corner.v, wish) * limits.filter_s();
    }
    if (isNone || !corner.isStop || corner.gentle >= 1.0) {
        return 0;
    }
    const double shared = limits.filter_s() - corner.dwell_s + limits.period_s();
    return 0.5 * limit_of(p, 0, p.length, limits.fitted(), wish).a.at(0) * corner.gentle * shared * shared;
}

void make_gentle(PlannedPath &path, Sequence from, double part) noexcept {
    for (Sequence k = from; k <= path.last_piece() && part < 1.0; ++k) {
        path.scale(k, 1.0, part);
    }
}

/// Turning of curves close by leaves less for the path.
void share_with_turning(PlannedPath &path, Sequence from, double taken) noexcept {
    for (Sequence k = from; k <= path.last_piece(); ++k) {
        Piece &piece = path.store().piece(k);
        AccelBound &bound = piece.acceleration;
        for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
            bound.beta[i] += CornerTuning::SHARED_TURNS * bound.alpha[i] * taken;
            bound.alpha[i] *= CornerTuning::SHARED_REST;
        }
        piece.braking = {};
    }
}

}  // namespace

void PathBuilder::add_blend(PlannedPath &path, const Conditions &c, const Corner &corner) noexcept {
    const Primitive &a = path.primitive(open_.move);
    const Primitive &b = path.primitive(open_.move + 1);
    const PlannedMove &before = path.move(open_.move);
    const PlannedMove &after = path.move(open_.move + 1);
    const double wish = std::min(requested_speed(before, c.scales), requested_speed(after, c.scales));
    const double d = corner.blend_d;
    const double turn = geometry::norm(tangent_step(a, b));
    // A curve among others leaves acceleration for what the average adds up; a single one is passed at
    // constant speed.
    const bool isFiltered = c.limits.isFiltered();
    const double reach = isFiltered ? corner.v * c.limits.filter_s() : 0.0;
    const bool isShared =
        isFiltered && std::min(a.length, b.length) < PathTuning::SHARED_REACH * reach + 2.0 * d;
    const SpeedLimit whole = isShared ? shared_limit(a, b, corner, c.limits, wish)
                                      : limit_of_blend(a, b, {d, 0, 2.0 * d}, c.limits.fitted(), wish);
    const int cuts = whole.v < wish ? std::clamp(static_cast<int>(turn / PathTuning::BLEND_CUT) + 1, 1,
                                                 PathTuning::MOST_BLEND_CUTS)
                                    : 1;
    Piece piece;
    piece.primitive = open_.move;
    piece.move = open_.move;
    piece.blend_d = d;
    piece.tolerance = tolerance_of(before, c.limits);
    const double other = tolerance_of(after, c.limits);
    piece.tolerance = piece.tolerance > 0 && other > 0 ? std::min(piece.tolerance, other)
                                                       : std::max(piece.tolerance, other);
    for (int i = 0; i < cuts; ++i) {
        const double from = 2.0 * d * i / cuts;
        const double to = 2.0 * d * (i + 1) / cuts;
        piece.offset = from;
        piece.length = to - from;
        piece.programmed_s = before.start_s + a.length - d + from;
        SpeedLimit limit = cuts == 1 ? whole : limit_of_blend(a, b, {d, from, to}, c.limits.fitted(), wish);
        limit.v = std::min(limit.v, corner.v);
        add_piece(path, c, piece, limit);
    }
}

/// The open move's own part, from the end of the blend before it up to `to`, where the blend of `next` begins
/// if there is one.
void PathBuilder::close(PlannedPath &path, const Conditions &c, double to, const Corner &next) noexcept {
    const Primitive &p = path.primitive(open_.move);
    const double from = open_.offset;
    if (to - from <= PathTuning::SMALLEST_PART * p.length) {
        return;
    }
    const PlannedMove &m = path.move(open_.move);
    const bool isToEnd = !(next.blend_d > 0);
    Piece piece;
    piece.primitive = open_.move;
    piece.move = open_.move;
    piece.tolerance = tolerance_of(m, c.limits);
    piece.offset = from;
    const double wish = std::min(requested_speed(m, c.scales), mean_arc_speed({p, m}, c.limits));
    const bool isAfterBlend = c.limits.isFiltered() && open_.before.blend_d > 0;
    const bool isBeforeBlend = c.limits.isFiltered() && next.blend_d > 0;
    const double length = to - from;
    const auto zone = [&](const Corner &corner) {
        const double way = zone_length(p, corner, c.limits, wish);
        const bool isFit = way < PathTuning::ZONE_SHARE * length;
        return corner.isStop ? std::min(way, PathTuning::ZONE_SHARE * length) : isFit ? way : 0.0;
    };
    const double before = zone(open_.before);
    const double after = zone(next);
    if (before > 0) {
        const Sequence first = path.last_piece() + 1;
        add_part(path, c, piece, from + before, open_.before.isStop ? wish : open_.before.v);
        make_gentle(path, first, open_.before.gentle);
    }
    const Sequence first = path.last_piece() + 1;
    piece.offset = from + before;
    piece.isToEnd = isToEnd && !(after > 0);
    add_part(path, c, piece, to - after, wish);
    const auto taken_by = [](bool isNear, const Corner &near) {
        return isNear ? near.turning / (near.v * near.v) : 0.0;
    };
    const double taken = std::max(taken_by(isAfterBlend && !(before > 0), open_.before),
                                  taken_by(isBeforeBlend && !(after > 0), next));
    if (taken > 0 && !p.isArc) {
        share_with_turning(path, first, taken);
    }
    if (after > 0) {
        const Sequence last = path.last_piece() + 1;
        piece.offset = to - after;
        piece.isToEnd = isToEnd;
        add_part(path, c, piece, to, next.isStop ? wish : next.v);
        make_gentle(path, last, next.gentle);
    }
}

/// The part of the open move from piece.offset up to `to`, at most at the speed v. piece.isToEnd is for its
/// last cut.
void PathBuilder::add_part(PlannedPath &path, const Conditions &c, Piece piece, double to,
                           double v) noexcept {
    const Primitive &p = path.primitive(open_.move);
    const PlannedMove &m = path.move(open_.move);
    const Limits &limits = c.limits.fitted();
    const double from = piece.offset;
    const bool isToEnd = piece.isToEnd;
    const double wish = std::min(v, requested_speed(m, c.scales));
    const SpeedLimit whole = limit_of(p, from, to, limits, wish);
    int cuts = 1;
    piece.isAlong = isExactArc(p, m.request, c.limits);
    constexpr double MOST = PathTuning::MOST_ARC_CUTS;
    if (p.isArc) {
        const bool isFine = piece.isAlong || whole.v < wish;
        const double cut = isFine ? PathTuning::ARC_CUT : PathTuning::ARC_CUT_WHEN_SLOW;
        const double pieces = std::ceil(std::abs(p.omega) * (to - from) / cut);
        cuts = static_cast<int>(std::clamp(pieces, 1.0, MOST));
    }
    if (c.workspace.isMapped() && !piece.isAlong) {
        // Joints may run on curves where the path is straight.
        const double pieces = std::ceil(geometry::norm_abc(p.lin) * (to - from) / PathTuning::JOINT_CUT_DEG);
        cuts = std::max(cuts, static_cast<int>(std::clamp(pieces, PathTuning::LEAST_JOINT_CUTS, MOST)));
    }
    std::optional<ExactArc> exact;
    if (piece.isAlong) {
        piece.length = to - from;
        exact.emplace(path.store(), piece, c, wish);
    }
    for (int i = 0; i < cuts; ++i) {
        const double begin = from + (to - from) * i / cuts;
        const double end = i + 1 == cuts ? to : from + (to - from) * (i + 1) / cuts;
        piece.offset = begin;
        piece.programmed_s = m.start_s + begin;
        piece.length = end - begin;
        piece.isToEnd = isToEnd && i + 1 == cuts;
        SpeedLimit limit = whole;
        if (exact.has_value()) {
            const ExactArc::Allowance allowed = exact->allowance_of(piece);
            limit = allowed.speed;
            piece.braking = allowed.braking;
        } else if (cuts > 1) {
            limit = limit_of(p, begin, end, limits, wish);
        }
        add_piece(path, c, piece, limit);
        open_.isStop = false;
    }
}

void PathBuilder::add_piece(PlannedPath &path, const Conditions &c, const Piece &piece,
                            const SpeedLimit &limit) noexcept {
    const bool isMapped = c.workspace.isMapped() && !piece.isAlong;
    const SpeedLimit lowest =
        isMapped ? limit_with_joints(path.store(), piece, c.workspace, c.limits.filter_s(), limit) : limit;
    Piece limited = piece;
    limited.acceleration = lowest.a;
    if (!piece.isAlong) {
        limited.braking = braking_on(path.store(), piece, c, lowest);
    }
    const bool isDense = limited.braking.top > 0 && limited.braking.isDense;
    const double v = isDense ? lowest.v * BrakingTuning::DENSE_DRIVEN : lowest.v;
    PlannedPiece plan;
    plan.v_limit = std::min(v, PathTuning::MOVES_PER_CYCLE * path.primitive(piece.primitive).length /
                                   c.limits.period_s());
    plan.isStopBefore = open_.isStop;
    plan.dwell_s = open_.isStop ? open_.before.dwell_s : c.limits.filter_s();
    path.append_piece(limited, plan);
}

}  // namespace mw::trajectory
