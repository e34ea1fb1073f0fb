// SPDX-License-Identifier: GPL-2.0-or-later
// Cuts moves and blends into pieces with separate limits.
#include <algorithm>
#include <cmath>

#include "trajectory/path/braking.hh"
#include "trajectory/path/path_builder.hh"

namespace mw::trajectory {

void PathBuilder::add_blend(PlannedPath &path, const Conditions &c, double d) noexcept {
    const Primitive &a = path.primitive(open_.move);
    const Primitive &b = path.primitive(open_.move + 1);
    const PlannedMove &before = path.move(open_.move);
    const PlannedMove &after = path.move(open_.move + 1);
    const double wish = std::min(requested_speed(before, c.scales), requested_speed(after, c.scales));
    const double turn = geometry::norm(tangent_step(a, b));
    const SpeedLimit whole = limit_of_blend(a, b, {d, 0, 2.0 * d}, c.limits.wanted(), wish);
    const int cuts = whole.v < wish ? std::clamp(static_cast<int>(turn / PathTuning::BLEND_CUT) + 1, 1,
                                                 PathTuning::MOST_BLEND_CUTS)
                                    : 1;
    Piece piece;
    piece.primitive = open_.move;
    piece.move = open_.move;
    piece.blend_d = d;
    for (int i = 0; i < cuts; ++i) {
        const double from = 2.0 * d * i / cuts;
        const double to = 2.0 * d * (i + 1) / cuts;
        piece.offset = from;
        piece.length = to - from;
        add_piece(path, c, piece,
                  cuts == 1 ? whole : limit_of_blend(a, b, {d, from, to}, c.limits.wanted(), wish));
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
    Piece piece;
    piece.primitive = open_.move;
    piece.move = open_.move;
    piece.offset = from;
    piece.isToEnd = !(next.blend_d > 0);
    add_part(path, c, piece, to);
}

/// The part of the open move from piece.offset up to `to`. piece.isToEnd is for its last cut.
void PathBuilder::add_part(PlannedPath &path, const Conditions &c, Piece piece, double to) noexcept {
    const Primitive &p = path.primitive(open_.move);
    const Limits &limits = c.limits.wanted();
    const double from = piece.offset;
    const bool isToEnd = piece.isToEnd;
    const double wish = requested_speed(path.move(open_.move), c.scales);
    const SpeedLimit whole = limit_of(p, from, to, limits, wish);
    int cuts = 1;
    constexpr double MOST = PathTuning::MOST_ARC_CUTS;
    if (p.isArc) {
        const double cut = whole.v < wish ? PathTuning::ARC_CUT : PathTuning::ARC_CUT_WHEN_SLOW;
        const double pieces = std::ceil(std::abs(p.omega) * (to - from) / cut);
        cuts = static_cast<int>(std::clamp(pieces, 1.0, MOST));
    }
    if (c.workspace.isMapped()) {
        // Joints may run on curves where the path is straight.
        const double pieces = std::ceil(geometry::norm_abc(p.lin) * (to - from) / PathTuning::JOINT_CUT_DEG);
        cuts = std::max(cuts, static_cast<int>(std::clamp(pieces, PathTuning::LEAST_JOINT_CUTS, MOST)));
    }
    for (int i = 0; i < cuts; ++i) {
        const double begin = from + (to - from) * i / cuts;
        const double end = i + 1 == cuts ? to : from + (to - from) * (i + 1) / cuts;
        piece.offset = begin;
        piece.length = end - begin;
        piece.isToEnd = isToEnd && i + 1 == cuts;
        add_piece(path, c, piece, cuts > 1 ? limit_of(p, begin, end, limits, wish) : whole);
        open_.isStop = false;
    }
}

void PathBuilder::add_piece(PlannedPath &path, const Conditions &c, const Piece &piece,
                            const SpeedLimit &limit) noexcept {
    const SpeedLimit lowest =
        c.workspace.isMapped() ? limit_with_joints(path.store(), piece, c.workspace, limit) : limit;
    Piece limited = piece;
    limited.acceleration = lowest.a;
    limited.braking = braking_on(path.store(), piece, c, lowest);
    const double v = limited.braking.top > 0 ? lowest.v * BrakingTuning::DENSE_DRIVEN : lowest.v;
    PlannedPiece plan;
    plan.v_limit = std::min(v, PathTuning::MOVES_PER_CYCLE * path.primitive(piece.primitive).length /
                                   c.limits.period_s());
    plan.isStopBefore = open_.isStop;
    path.append_piece(limited, plan);
}

}  // namespace mw::trajectory
