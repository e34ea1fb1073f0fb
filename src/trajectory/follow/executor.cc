// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/executor.hh"

#include <algorithm>
#include <cmath>

// [[likely]] marks the branch of most cycles; see motion/servo/controller.cc.
namespace mw::trajectory {

namespace {

/// Position on the line of a tap, which may be past its ends.
Pose line_at(const Primitive &line, double x) noexcept {
    return x == 0 ? line.start : x == line.length ? line.end : line.start + line.lin * x;
}

}  // namespace

void Executor::take_plans() noexcept {
    while (const CurvePlan *plan = store_.curve_plans.front()) [[unlikely]] {
        curve_.take(*plan);
        store_.curve_plans.drop();
    }
}

const ExecutorOutput &Executor::step(std::uint64_t cycle) noexcept {
    take_plans();
    out_.tap = {};
    state_.cycle = cycle;
    if (state_.motion == Motion::LOCKED) [[unlikely]] {
        step_locked();
    } else if (state_.motion == Motion::CURVE || curve_.isWaiting()) {
        curve_.step(store_, period_, state_);
        if (state_.motion == Motion::LOCKED) [[unlikely]] {
            begin_pass();
        }
    }
    locate();
    command();
    const bool isDropOver = state_.isDropping && isAtRest();
    if (isDropOver) [[unlikely]] {
        finish_drop();
    }
    return out_;
}

void Executor::set_position(const Pose &pose) noexcept {
    position_ = pose;
    out_.position = pose;
}

/// Writes the commanded position and the other outputs.
void Executor::command() noexcept {
    out_.position = position_;
    state_.done_move = std::max(state_.done_move, done_);
    out_.isMoving = !isAtRest();
}

void Executor::come_to_rest() noexcept {
    state_.motion = Motion::REST;
    state_.v = 0;
}

/// Drops the rest of the path. The planner sees this in `drops`.
void Executor::finish_drop() noexcept {
    state_.isDropping = false;
    ++state_.drops;
    ++state_.brakes;
    state_.x = 0;
    state_.isOnPath = false;
    curve_.clear();
    tapping_ = false;
}

void Executor::hold(bool isHeld) noexcept {
    if (!isHeld) [[likely]] {
        state_.isHeld = false;
        return;
    }
    const bool isAtStart = tapping_ ? tap_.isWaiting() : pass_.isWaiting();
    if (state_.motion == Motion::LOCKED && isAtStart) {
        come_to_rest();
    }
    if (!state_.isHeld && state_.motion == Motion::REST) {
        ++state_.brakes;
    }
    state_.isHeld = true;
}

void Executor::drop() noexcept {
    if (state_.isDropping) {
        return;
    }
    state_.isDropping = true;
    if (isAtRest()) {
        finish_drop();
    }
}

void Executor::stop_now() noexcept {
    state_.motion = Motion::REST;
    state_.v = 0;
    out_.tap = {};
    set_position(out_.position);
    finish_drop();
}

/// Updates the position, its move and the last completed move.
void Executor::locate() noexcept {
    out_.velocity = std::abs(state_.v);
    const bool isMoving = state_.motion != Motion::REST;
    out_.isOnProbe = false;
    if (!state_.isOnPath) [[unlikely]] {
        out_.move = 0;
        out_.distance_to_go = 0;
        return;
    }
    CurveFollower::Place at = curve_.place(store_, !isMoving);
    if (tapping_) [[unlikely]] {
        at = {line_at(store_.primitive(curve_.plan().move), tap_.x()), curve_.plan().move, false, at.left};
    }
    position_ = at.pose;
    done_ = std::max(done_, at.is_complete ? at.move : at.move - 1);
    out_.isOnProbe = store_.move(at.move).isProbe && !(at.is_complete && isAtRest());
    out_.move = at.is_complete && !isMoving && !out_.isOnProbe ? 0 : at.move;
    out_.distance_to_go = at.left;
}

const PathEvent *Executor::due_event() noexcept {
    const PathEvent *event = store_.events.front();
    while (event != nullptr && event->drops != state_.drops) {
        store_.events.drop();
        event = store_.events.front();
    }
    return event != nullptr && event->after_move <= state_.done_move ? event : nullptr;
}

bool Executor::isEmpty() const noexcept {
    return !state_.isOnPath ||
           (isAtRest() && state_.done_move >= store_.last_move.load(std::memory_order_acquire));
}

}  // namespace mw::trajectory
