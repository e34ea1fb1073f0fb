// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that are locked to the angle of a spindle (threads): their corners, their limits, and when they
// begin. The executor drives them. Formulas: docs/motion/planner.md.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

/// Last piece of the pass that begins with `first`, as far as it is known.
Sequence Planner::pass_end(Sequence first) const noexcept {
    Sequence last = first;
    while (last < last_piece_ && isLockedPiece(last + 1) &&
           !pieces_[(last + 1) % PIECE_CAPACITY].isStopBefore && !isBarrier(last + 1)) {
        ++last;
    }
    return last;
}

bool Planner::isPassKnown(const Snapshot &now) const noexcept {
    State from;
    if (!start_state(now, from)) {
        return false;
    }
    const bool isEndOpen = open_move_ != 0 && isLocked(open_move_) && !isOpenStop_;
    const bool isGrowing = isEndOpen && pass_end(from.piece) == last_piece_;
    return !isGrowing || !hasRoom(now);
}

/// Along the path at the present speed of the spindle.
double Planner::turning_speed(const MoveRequest &r) const noexcept {
    const double rps = std::abs(scales_.spindle_rps[static_cast<std::size_t>(r.spindle)]);
    return r.feed_per_revolution * r.tag.feed_ratio * rps;
}

double Planner::pass_load(Sequence move) const noexcept {
    double load = 0;
    for (Sequence n = move; n <= last_move_ && isLocked(n) && (n == move || !move_plan(n).request.isGated);
         ++n) {
        const MoveRequest &r = move_plan(n).request;
        const Primitive &p = store_.primitive(n);
        const double most =
            std::min(limit_of(p, 0, p.length, limits_, UNLIMITED).v, scales_.max_velocity * r.tag.feed_ratio);
        load = std::max(load, turning_speed(r) / most);
    }
    return load;
}

/// A corner within a pass is passed at the spindle's speed, whatever the path mode: a thread cannot wait.
Planner::Joint Planner::locked_corner(Sequence na, Sequence nb) const noexcept {
    const Primitive &a = store_.primitive(na);
    const Primitive &b = store_.primitive(nb);
    const Pose ta = derivative_at(a, a.length);
    const Pose tb = derivative_at(b, 0);
    if (geom::norm(tb - ta) <= PathTuning::SAME_DIRECTION) {
        return {};
    }
    const double v = PassTuning::SPEED_RESERVE *
                     std::max(turning_speed(move_plan(na).request), turning_speed(move_plan(nb).request));
    const double wide = blend_d_for_speed(a, b, limits_, v) *
                        (isFiltered() ? LimitTuning::BLEND_SHARE / PassTuning::TURNING : 1.0);
    const double d = std::min(0.5 * std::min(a.length, b.length), wide);
    const bool isReversal = geom::dot(ta, tb) < PathTuning::REVERSAL_COSINE * geom::norm(ta) * geom::norm(tb);
    return isReversal || !(d > PathTuning::SMALLEST_BLEND) ? Joint{.isStop = true, .dwell_s = filter_s()}
                                                           : Joint{.d = d, .v = UNLIMITED};
}

/// The corner moves on, so that the first line is followed to its programmed end: what it cuts is to have its
/// full depth there. With jerk limits half of the mean is on its way round the corner at that moment.
void Planner::move_corner_on(Sequence na, Sequence nb, const Joint &joint) noexcept {
    Primitive &a = store_.primitive(na);
    Primitive &b = store_.primitive(nb);
    const double behind = isFiltered() ? 0.5 * filter_s() * turning_speed(move_plan(na).request) : 0.0;
    const Pose along = derivative_at(a, a.length);
    // Never beyond where the second line ends: a shoulder may be there.
    const double most = PassTuning::ROOM_SHARE * geom::dot(b.end - b.start, along);
    const double way = std::clamp(joint.d + PassTuning::LAG_RESERVE * behind, 0.0, std::max(0.0, most));
    const Pose corner = a.end + along * way;
    bool isRoom = !a.isArc && !b.isArc;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        isRoom = isRoom && corner[i] >= room_low_[i] && corner[i] <= room_high_[i];
    }
    if (!isRoom) {
        return;
    }
    a = make_line(a.start, corner);
    b = make_line(corner, b.end);
    MovePlan &after = move_plan(nb);
    after.start_s = move_plan(na).start_s + a.length;
    programmed_s_ = nb == last_move_ ? after.start_s + b.length : programmed_s_;
}

/// Way along a piece in a turn of the spindle; on a blend between those of its lines, so that the lead along
/// the thread stays.
double Planner::turn_way(Sequence piece) const noexcept {
    const Piece &p = store_.piece(piece);
    const auto way = [this](Sequence n) {
        const MoveRequest &r = move_plan(n).request;
        return r.feed_per_revolution * r.tag.feed_ratio;
    };
    if (!(p.blend_d > 0)) {
        return way(p.move);
    }
    const double part = (p.offset + 0.5 * p.length) / (2.0 * p.blend_d);
    return 1.0 / ((1.0 - part) / way(p.move) + part / way(p.move + 1));
}

/// What the executor needs to know of each piece.
void Planner::fill_pass(const Pass &pass) noexcept {
    double out2 = 0;
    for (Sequence k = pass.last; k >= pass.first; --k) {
        Piece &p = store_.piece(k);
        p.per_turn = turn_way(k);
        // A corner that had to be tighter is passed more slowly.
        const bool isTurning = isFiltered() && p.blend_d > 0;
        p.v_most = piece_plan(k).v_limit * (isTurning ? std::sqrt(PassTuning::TURNING) : 1.0);
        p.v2_out = out2;
        AccelBound bound = p.acceleration;
        for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
            bound.alpha[i] *= pass.share;
            bound.beta[i] *= pass.share;
        }
        p.v2_in = std::min(p.v_most * p.v_most, bound.highest_before(out2, p.length));
        out2 =
            k > pass.first ? std::min(p.v2_in, piece_plan(k - 1).v_limit * piece_plan(k - 1).v_limit) : 0.0;
    }
}

/// Hands the executor the pass that begins where it stands.
bool Planner::start_pass(const Snapshot &now, const State &from) noexcept {
    if (!isPassKnown(now)) {
        return false;
    }
    const MoveRequest &r = move_plan(move_of(from.piece)).request;
    const double rps = scales_.spindle_rps[static_cast<std::size_t>(r.spindle)];
    Commit commit;
    commit.pass.first = from.piece;
    commit.pass.last = pass_end(from.piece);
    commit.pass.spindle = r.spindle;
    commit.pass.direction = rps < 0 ? -1.0 : 1.0;
    commit.pass.share = PassTuning::FULL;
    commit.pass.trim = PassTuning::FULL;
    if (isFiltered()) {
        double length = 0;
        for (Sequence k = commit.pass.first; k <= commit.pass.last; ++k) {
            length += store_.piece(k).length;
        }
        const double v = turning_speed(r) * PassTuning::SPEED_RESERVE;
        const double a = PassTuning::LONG_SHARE * store_.piece(from.piece).acceleration.at(0);
        const bool isOneMove = move_of(commit.pass.first) == move_of(commit.pass.last);
        const bool isLong = isOneMove && length > v * v / a + PassTuning::LONG_MEANS * v * filter_s();
        const double even = isOneMove ? PassTuning::SHORT_SHARE : PassTuning::CORNER_SHARE;
        commit.pass.share = isLong ? PassTuning::LONG_SHARE : even;
        commit.pass.trim = isLong ? PassTuning::LONG_TRIM : even;
    }
    commit.plan = plan_ + 1;
    commit.isSwitch = true;
    commit.brakes = now.brakes;
    commit.filter = filter_;
    fill_pass(commit.pass);
    if (!store_.commits.push(commit)) {
        return false;
    }
    ++plan_;
    plan_ends_[plan_ % plan_ends_.size()] = plan_end_;
    plan_brakes_ = now.brakes;
    switch_cycle_ = now.cycle + settings_.latency;
    plan_begin_ = plan_end_;
    changed_from_ = 0;
    isAtEndOfPath_ = commit.pass.last == last_piece_;
    isStopPlan_ = false;
    planned_ = {};
    planned_.piece = commit.pass.last;
    planned_.x = store_.piece(commit.pass.last).length;
    return true;
}

}  // namespace mw::traj
