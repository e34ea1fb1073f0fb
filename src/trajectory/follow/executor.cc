// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/executor.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

// [[likely]] marks what most cycles do: see motion/servo/controller.cc.
namespace mw::trajectory {

namespace {

/// A tap also goes beyond the ends of its line.
Pose line_at(const Primitive &line, double x) noexcept {
    return x == 0 ? line.start : x == line.length ? line.end : line.start + line.lin * x;
}

}  // namespace

void Executor::take_commits() noexcept {
    while (const CurvePlan *plan = store_.curve_plans.front()) [[unlikely]] {
        curve_.take(*plan);
        store_.curve_plans.drop();
    }
    while (const Commit *c = store_.commits.front()) [[unlikely]] {
        if (c->isSwitch) {
            const bool isFree = !state_.isHeld && !state_.isDropping;
            const bool isTimely = c->switch_cycle > state_.cycle && c->brakes == state_.brakes && isFree;
            if (isTimely) {
                next_switch_ = *c;
                next_end_ = c->end;
            }
        } else if (next_switch_.plan != 0 && c->plan == next_switch_.plan) {
            next_end_ = c->end;
        } else if (next_switch_.plan == 0 && c->plan == state_.plan && state_.motion == Motion::FOLLOW) {
            phase_end_ = c->end;
        }
        store_.commits.drop();
    }
}

const ExecutorOutput &Executor::step(std::uint64_t cycle) noexcept {
    take_commits();
    out_.tap = {};
    state_.cycle = cycle;
    if (state_.motion == Motion::LOCKED) [[unlikely]] {
        step_locked();
    } else if (state_.motion == Motion::CURVE || curve_.isWaiting()) {
        curve_.step(store_, period_, state_);
        if (state_.motion == Motion::LOCKED) [[unlikely]] {
            begin_pass();
        }
    } else {
        advance(period_);
    }
    const bool isDue = next_switch_.plan != 0 && next_switch_.switch_cycle <= cycle;
    if (isDue) [[unlikely]] {
        const bool isFree = !state_.isHeld && !state_.isDropping;
        const bool isValid =
            next_switch_.brakes == state_.brakes && next_switch_.switch_cycle == cycle && isFree;
        if (isValid) {
            state_.motion = Motion::FOLLOW;
            state_.isOnCurve = false;
            state_.plan = next_switch_.plan;
            state_.phase = next_switch_.begin;
            state_.time_in_phase = 0;
            phase_end_ = next_end_;
            state_.piece = store_.phase(state_.phase).piece;
            state_.x = store_.phase(state_.phase).x0;
            state_.v = store_.phase(state_.phase).v0;
        }
        next_switch_.plan = 0;
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

/// What is commanded.
void Executor::command() noexcept {
    out_.position = position_;
    state_.done_move = std::max(state_.done_move, done_);
    out_.isMoving = !isAtRest();
}

void Executor::advance(double dt) noexcept {
    for (int n = 0; n < MAX_STEPS_PER_CYCLE && dt > 0 && state_.motion != Motion::REST; ++n) {
        dt = state_.motion == Motion::FOLLOW ? follow(dt) : brake_along(dt);
    }
}

/// Goes on within the present phase; returns the time that is left after its end.
double Executor::follow(double dt) noexcept {
    const Phase &p = store_.phase(state_.phase);
    const double left = p.duration - state_.time_in_phase;
    if (dt < left) [[likely]] {
        state_.time_in_phase += dt;
        state_.x = p.x_at(state_.time_in_phase);
        state_.v = p.v_at(state_.time_in_phase);
        state_.piece = p.piece;
        return 0;
    }
    if (state_.phase + 1 < phase_end_) {
        ++state_.phase;
        const Phase &next = store_.phase(state_.phase);
        state_.time_in_phase = 0;
        state_.piece = next.piece;
        state_.x = next.x0;
        state_.v = next.v0;
        return dt - left;
    }
    state_.piece = p.piece;
    state_.x = p.x_at(p.duration);
    state_.v = p.v_at(p.duration);
    const double length = store_.piece(p.piece).length;
    if (std::abs(state_.x - length) <= ExecutorTuning::ARRIVED * (1.0 + length)) {
        state_.x = length;
    }
    if (p.isStop(period_)) {
        come_to_rest();
    } else {
        start_brake();
    }
    return dt - left;
}

void Executor::start_brake() noexcept {
    state_.motion = Motion::BRAKE;
    ++state_.brakes;
    next_switch_.plan = 0;
    brake_on_piece();
}

void Executor::enter_next_piece() noexcept {
    ++state_.piece;
    state_.x = 0;
    brake_on_piece();
}

/// Sets up braking from the present state to a stop, to where the piece allows another, or to its end.
void Executor::brake_on_piece() noexcept {
    const Piece &piece = store_.piece(state_.piece);
    const double v2 = state_.v * state_.v;
    const Piece::BrakeLeg leg = piece.brake_leg(state_.x, v2);
    brake_.end = leg.end;
    const double left = std::max(0.0, brake_.end - state_.x);
    double a = leg.a;
    const double out2 = v2 - 2.0 * a * left;
    brake_.time = 0;
    brake_.isFinal = out2 <= TimingTuning::STOP_FIT * v2;
    if (!brake_.isFinal) {
        const double out = std::sqrt(out2);
        const double duration = 2.0 * left / (state_.v + out);
        brake_.phase = {state_.piece, duration, state_.x, state_.v, -a, 0};
        return;
    }
    if (out2 > 0 && left > 0) {
        a = v2 / (2.0 * left);
    }
    brake_.phase = {state_.piece, state_.v / a, state_.x, state_.v, -a, 0};
}

double Executor::brake_along(double dt) noexcept {
    const double left = brake_.phase.duration - brake_.time;
    if (dt < left) {
        brake_.time += dt;
        state_.x = brake_.phase.x_at(brake_.time);
        state_.v = brake_.phase.v_at(brake_.time);
        return 0;
    }
    const Piece &piece = store_.piece(state_.piece);
    if (brake_.isFinal) {
        const double stop = brake_.phase.x_at(brake_.phase.duration);
        state_.x = std::abs(stop - piece.length) <= ExecutorTuning::ARRIVED * (1.0 + piece.length)
                       ? piece.length
                       : std::min(stop, piece.length);
        come_to_rest();
        return 0;
    }
    state_.v = brake_.phase.v_at(brake_.phase.duration);
    if (brake_.end < piece.length) {
        state_.x = brake_.end;
        brake_on_piece();
        return dt - left;
    }
    if (state_.piece == store_.last_piece.load(std::memory_order_acquire)) {
        // The planner promises that this does not happen; were it wrong, the end of the path is where we
        // stop.
        state_.x = piece.length;
        come_to_rest();
        return 0;
    }
    enter_next_piece();
    return dt - left;
}

void Executor::come_to_rest() noexcept {
    state_.motion = Motion::REST;
    state_.v = 0;
}

/// Whatever is left of the path is gone; the planner learns it from `drops`.
void Executor::finish_drop() noexcept {
    state_.isDropping = false;
    ++state_.drops;
    ++state_.brakes;
    state_.piece = 0;
    state_.x = 0;
    state_.isOnCurve = false;
    next_switch_.plan = 0;
    curve_.clear();
    tapping_ = false;
}

void Executor::hold(bool isHeld) noexcept {
    if (!isHeld) [[likely]] {
        state_.isHeld = false;
        return;
    }
    if (!state_.isHeld && state_.motion == Motion::FOLLOW) {
        start_brake();
    }
    const bool isAtStart = tapping_ ? tap_.isWaiting() : pass_.isWaiting();
    if (state_.motion == Motion::LOCKED && isAtStart) {
        come_to_rest();
    }
    if (!state_.isHeld && state_.motion == Motion::REST) {
        ++state_.brakes;
        next_switch_.plan = 0;
    }
    state_.isHeld = true;
}

void Executor::drop() noexcept {
    if (state_.isDropping) {
        return;
    }
    state_.isDropping = true;
    if (state_.motion == Motion::FOLLOW) {
        start_brake();
    } else if (isAtRest()) {
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

/// Position, the move that it belongs to, and how many moves are complete.
void Executor::locate() noexcept {
    out_.velocity = std::abs(state_.v);
    const bool isMoving = state_.motion != Motion::REST;
    out_.isOnProbe = false;
    if (state_.isOnCurve) {
        CurveFollower::Place at = curve_.place(store_, !isMoving);
        if (tapping_) [[unlikely]] {
            at = {line_at(store_.primitive(curve_.plan().move), tap_.x()), curve_.plan().move, false,
                  at.left};
        }
        position_ = at.pose;
        done_ = std::max(done_, at.is_complete ? at.move : at.move - 1);
        out_.isOnProbe = store_.move(at.move).isProbe && !(at.is_complete && isAtRest());
        out_.move = at.is_complete && !isMoving && !out_.isOnProbe ? 0 : at.move;
        out_.distance_to_go = at.left;
        return;
    }
    if (state_.piece == 0) [[unlikely]] {
        out_.move = 0;
        out_.distance_to_go = 0;
        return;
    }
    const Piece &piece = store_.piece(state_.piece);
    position_ = position_at(store_, piece, state_.x);
    const bool isBlend = piece.blend_d > 0;
    const double along_piece = piece.offset + state_.x;
    const bool isSecond = isBlend && along_piece >= piece.blend_d;
    const Sequence move = piece.move + (isSecond ? 1 : 0);
    const Primitive &line = store_.primitive(piece.primitive + (isSecond ? 1 : 0));
    const double y = isBlend ? along_piece * along_piece / (4.0 * piece.blend_d) : 0;
    const double start = isBlend ? line.length - piece.blend_d : 0;
    const double along = isSecond ? y : start + along_piece - y;
    const bool isComplete = piece.isToEnd && state_.x >= piece.length;
    done_ = std::max(done_, isComplete ? move : move - 1);
    out_.isOnProbe = store_.move(move).isProbe && !(isComplete && isAtRest());
    out_.move = isComplete && !isMoving && !out_.isOnProbe ? 0 : move;
    out_.distance_to_go = isComplete ? 0 : line.length - along;
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
    if (state_.isOnCurve) {
        return isAtRest() && state_.done_move >= store_.last_move.load(std::memory_order_acquire);
    }
    if (state_.piece == 0) {
        return true;
    }
    const bool isAtEnd = state_.piece == store_.last_piece.load(std::memory_order_acquire) &&
                         state_.x >= store_.piece(state_.piece).length;
    return isAtRest() && isAtEnd;
}

}  // namespace mw::trajectory
