// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/path_builder.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/corner.hh"

namespace mw::trajectory {

namespace {

Leg leg(const PlannedPath &path, Sequence n) noexcept {
    return {path.primitive(n), path.move(n)};
}

}  // namespace

void PathBuilder::begin(const Pose &start) noexcept {
    end_ = start;
    open_.move = 0;
    newest_ = 0;
}

bool PathBuilder::hasRoom(const PlannedPath &path, const Snapshot &now) noexcept {
    constexpr Sequence PIECES_PER_MOVE = PathTuning::MOST_ARC_CUTS + PathTuning::MOST_BLEND_CUTS + 2;
    const Sequence oldest_piece = std::max(path.first_piece(), now.piece);
    if (path.last_piece() + PIECES_PER_MOVE - oldest_piece >= PIECE_CAPACITY) {
        return false;
    }
    const Sequence oldest_move =
        path.last_piece() < oldest_piece ? path.last_move() : path.piece(oldest_piece).move;
    constexpr Sequence KEPT = 4;
    return path.last_move() + KEPT - oldest_move < PRIMITIVE_CAPACITY;
}

void PathBuilder::fill_move(PlannedPath &path, Sequence n, const Primitive &primitive,
                            const MoveRequest &request) noexcept {
    path.primitive(n) = primitive;
    const FeedLength feed = feed_length(primitive);
    PlannedMove &m = path.move(n);
    m.request = request;
    m.request.isAngular = feed.isAngular;
    m.request.tag.feed_ratio = primitive.length / feed.length;
    m.request.tag.end = primitive.end;
    m.feed = request.tag.requested_velocity * m.request.tag.feed_ratio;
    path.store().move(n) = m.request.tag;
    end_ = primitive.end;
}

Sequence PathBuilder::add(PlannedPath &path, const Conditions &c, const Primitive &primitive,
                          const MoveRequest &request, bool isMerging) noexcept {
    const bool mayGrow = isMerging && !c.blocks.isOn && canGrow(path, primitive, request);
    if (mayGrow && grow(path, primitive, request)) {
        return path.last_move();
    }
    const double start_s = path.programmed_length();
    const Sequence n = path.append_move();
    PlannedMove &m = path.move(n);
    m.start_s = start_s;
    m.deviation = 0;
    fill_move(path, n, primitive, request);
    joined_count_ = 0;
    isJoinable_ = true;
    last_synched_ = request.feed_per_revolution > 0 ? n : last_synched_;
    open_newest(path, c);
    newest_ = n;
    return n;
}

/// The line may become a part of the newest one: same demands, and nothing happens in between.
bool PathBuilder::canGrow(const PlannedPath &path, const Primitive &line,
                          const MoveRequest &request) const noexcept {
    if (newest_ == 0 || !isJoinable_) {
        return false;
    }
    const MoveRequest &before = path.move(newest_).request;
    const bool isSame = before.tag.requested_velocity == request.tag.requested_velocity &&
                        before.tolerance == request.tolerance &&
                        before.merge_tolerance == request.merge_tolerance &&
                        before.corner_scale == request.corner_scale && before.isRapid == request.isRapid &&
                        before.isOverridable == request.isOverridable && before.tag.type == request.tag.type;
    const bool isPlain = before.join == geometry::PathMode::BLEND &&
                         request.join == geometry::PathMode::BLEND && !request.isGated &&
                         !(request.feed_per_revolution > 0) && !(before.feed_per_revolution > 0);
    return isSame && isPlain && !line.isArc && !path.primitive(newest_).isArc &&
           joined_count_ < PathTuning::MOST_JOINED;
}

/// Makes the newest line go to the end of `line` if all ends in between stay near it, in order.
bool PathBuilder::grow(PlannedPath &path, const Primitive &line, const MoveRequest &request) noexcept {
    double allowed = request.merge_tolerance;
    if (request.tolerance > 0 && !request.isMergeAdded) {
        allowed = std::min(std::max(allowed, PathTuning::JOIN_SHARE * request.tolerance),
                           PathTuning::MOST_JOIN_SHARE * request.tolerance);
    }
    const Primitive &before = path.primitive(newest_);
    const Primitive whole = make_line(before.start, line.end);
    joined_[joined_count_] = before.end;
    double along = 0;
    double worst = 0;
    for (std::size_t i = 0; i <= joined_count_; ++i) {
        const Pose off = joined_[i] - whole.start;
        const double s = geometry::dot(off, whole.lin);
        const Pose side = off - whole.lin * s;
        worst = std::max({worst, geometry::norm_linear(side), geometry::norm_abc(side)});
        if (!(s > along) || s >= whole.length || worst > allowed) {
            return false;
        }
        along = s;
    }
    ++joined_count_;
    path.move(newest_).deviation = request.isMergeAdded ? 0.0 : worst;
    fill_move(path, newest_, whole, request);
    return true;
}

/// The corner to a move that the path has come to a stop before.
Corner PathBuilder::fresh_corner(const PlannedPath &path, Sequence n) const noexcept {
    Corner corner;
    if (n <= path.first_move()) {
        return corner;
    }
    const MoveRequest &request = path.move(n).request;
    const Pose step = tangent_step(path.primitive(n - 1), path.primitive(n));
    corner.isStop = geometry::norm(step) > PathTuning::SAME_DIRECTION || request.isGated ||
                    path.move(n - 1).request.join == geometry::PathMode::EXACT_STOP;
    return corner;
}

/// Joins the newest move to the open one, now that it is known to be whole.
void PathBuilder::open_newest(PlannedPath &path, const Conditions &c) noexcept {
    if (newest_ == 0) {
        return;
    }
    const Sequence n = newest_;
    newest_ = 0;
    Corner corner;
    if (open_.move == 0) {
        corner = fresh_corner(path, n);
    } else {
        corner = corner_between(leg(path, open_.move), leg(path, n), c);
        close(path, c, path.primitive(open_.move).length - corner.blend_d, corner);
        if (corner.blend_d > 0) {
            open_.isStop = false;
            add_blend(path, c, corner.blend_d);
        }
    }
    open_ = {n, corner.blend_d, corner.isStop};
}

void PathBuilder::release_end(PlannedPath &path, const Conditions &c) noexcept {
    open_newest(path, c);
    if (open_.move != 0) {
        close(path, c, path.primitive(open_.move).length, {});
        open_.move = 0;
    }
}

}  // namespace mw::trajectory
