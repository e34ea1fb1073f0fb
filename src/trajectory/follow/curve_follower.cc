// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/curve_follower.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

namespace {

/// Distance to the end of a move that counts as rounding error, relative to a length of 1.
constexpr double ARRIVED = 4e-12;

/// True if the planner would take the move as complete at `s`.
bool isAtEnd(const MoveTag &move, double s) noexcept {
    return std::abs(s - move.end_s) <= curve::SAME_PLACE;
}

}  // namespace

void CurveFollower::take(const CurvePlan &plan) noexcept {
    if (plan.is_stop) {
        planner_stop_ = true;
    } else {
        waiting_ = plan;
    }
}

/// Starts the waiting plan. False if it was made for another state.
bool CurveFollower::start(const Snapshot &state) noexcept {
    const bool is_valid = waiting_.brakes == state.brakes && waiting_.after == state.plan &&
                          state.motion == Motion::REST && !state.isHeld && !state.isDropping;
    if (is_valid) {
        plan_ = waiting_;
        cell_ = plan_.begin;
        end_ = plan_.end;
        span_ = plan_.span;
        move_ = plan_.move;
        time_ = 0;
        next_stop_ = 0;
        stopping_ = planner_stop_ = false;
    }
    waiting_.plan = 0;
    return is_valid;
}

void CurveFollower::step(const PathStore &store, double dt, Snapshot &state) noexcept {
    if (isWaiting() && start(state)) [[unlikely]] {
        state.motion = plan_.pass.isAny() ? Motion::LOCKED : Motion::CURVE;
        state.isOnPath = true;
    }
    if (state.motion != Motion::CURVE) [[unlikely]] {
        state.plan = state.motion == Motion::LOCKED ? plan_.plan : state.plan;
        return;
    }
    must_stop_ = state.isHeld || state.isDropping || planner_stop_;
    if (!advance(store, dt)) [[unlikely]] {
        const MoveTag &last = store.move(move(store));
        s_ = isAtEnd(last, s_) ? last.end_s : s_;
        v_ = 0;
        state.motion = Motion::REST;
    }
    state.plan = plan_.plan;
    state.cell = cell_;
    state.time_in_cell = time_;
    state.x = s_;
    state.v = v_;
}

void CurveFollower::clear() noexcept {
    waiting_.plan = 0;
    plan_ = {};
    cell_ = end_ = 0;
    stopping_ = planner_stop_ = false;
    time_ = v_ = 0;
}

/// Changes to the next cell, a new plan or a stop. False if the motion ends with this cell.
bool CurveFollower::leave_cell() noexcept {
    const Sequence left = cell_;
    ++cell_;
    if (stopping_) {
        return cell_ < end_;
    }
    while (next_stop_ < plan_.stop_count && plan_.stops[next_stop_].behind < left) {
        ++next_stop_;
    }
    const bool is_last = cell_ == end_;
    const bool can_stop = next_stop_ < plan_.stop_count && plan_.stops[next_stop_].behind == left;
    const bool continues = waiting_.plan != 0 && waiting_.behind == left;
    if (waiting_.plan != 0 && waiting_.behind <= left && !continues) {
        waiting_.plan = 0;  // the plan is too late
    }
    if (continues && !(must_stop_ && can_stop)) {
        plan_ = waiting_;
        waiting_.plan = 0;
        cell_ = plan_.begin;
        end_ = plan_.end;
        next_stop_ = 0;
        return cell_ < end_;
    }
    if (can_stop && (must_stop_ || is_last)) {
        const CurvePlan::Stop &stop = plan_.stops[next_stop_];
        stopping_ = true;
        cell_ = stop.begin;
        end_ = stop.end;
    }
    return cell_ < end_;
}

bool CurveFollower::advance(const PathStore &store, double dt) noexcept {
    for (int n = 0; n < MOST_CELLS_PER_CYCLE; ++n) {
        const curve::TimeCell &cell = store.cell(cell_);
        if (time_ + dt < cell.duration) [[likely]] {
            time_ += dt;
            s_ = cell.s_at(time_);
            v_ = cell.v_at(time_);
            return true;
        }
        dt -= cell.duration - time_;
        s_ = cell.s_at(cell.duration);
        time_ = 0;
        if (!leave_cell()) {
            waiting_.plan = 0;
            planner_stop_ = false;
            return false;
        }
    }
    return true;
}

/// The move at the current position.
Sequence CurveFollower::move(const PathStore &store) noexcept {
    while (move_ < plan_.last_move && s_ >= store.move(move_).end_s) {
        ++move_;
    }
    return move_;
}

CurveFollower::Place CurveFollower::place(const PathStore &store, bool is_resting) noexcept {
    while (span_ < plan_.last_span && s_ > store.span(span_).end_s()) {
        ++span_;
    }
    Place at{curve::position_at(store.span(span_), s_), move(store), false, 0};
    const MoveTag &move = store.move(at.move);
    at.is_complete = s_ >= move.end_s;
    at.left = std::max(0.0, move.end_s - s_);
    const double off = geometry::norm(at.pose - move.end);
    if (at.is_complete && is_resting && off <= ARRIVED * (1.0 + geometry::norm(move.end))) {
        at.pose = move.end;
    }
    return at;
}

}  // namespace mw::trajectory
