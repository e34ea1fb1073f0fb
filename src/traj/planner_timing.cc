// SPDX-License-Identifier: GPL-2.0-or-later
// The speed profile: what can be kept is found backwards, what is driven is found forwards and committed.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

Sequence Planner::move_of(Sequence piece) const noexcept {
    const Piece &p = store_.piece(piece);
    return p.move + (p.blend_d > 0 ? 1 : 0);
}

/// A place before which the path stops and does not go on for now.
bool Planner::isBarrier(Sequence piece) const noexcept {
    const MoveRequest &r = move_plan(move_of(piece)).request;
    return r.isGated || (isStepping_ && r.tag.block != step_block_);
}

/// Stands before a place that a plan must not lead beyond.
bool Planner::isBeforeBarrier(const State &from) const noexcept {
    return from.x <= 0 && from.v <= 0 && isPlanEnd(from.piece);
}

/// Highest speed of a move under the present scales [1/s].
double Planner::move_cap(const MovePlan &m, double v_limit) const noexcept {
    double cap = v_limit;
    if (m.request.isRapid) {
        cap = v_limit * std::min(1.0, scales_.rapid);
    } else if (m.request.feed_per_revolution > 0) {
        const double rps = scales_.spindle_rps[static_cast<std::size_t>(m.request.spindle)];
        const bool isOverridden = m.request.isOverridable && !m.request.isLocked;
        cap = m.request.feed_per_revolution * std::abs(rps) * m.request.tag.feed_ratio *
              (isOverridden ? scales_.feed : 1.0);
    } else if (m.feed > 0) {
        cap = m.feed * (m.request.isOverridable ? scales_.feed : 1.0);
    }
    if (!m.request.isAngular) {
        cap = std::min(cap, scales_.max_velocity * m.request.tag.feed_ratio);
    }
    return std::min(cap, v_limit);
}

double Planner::cap_of(Sequence piece) const noexcept {
    const Piece &p = store_.piece(piece);
    const double v_limit = piece_plan(piece).v_limit;
    const double cap = move_cap(move_plan(p.move), v_limit);
    return p.blend_d > 0 ? std::min(cap, move_cap(move_plan(p.move + 1), v_limit)) : cap;
}

/// Highest speeds at the pieces' starts from the last piece back; stops where nothing changes any more.
void Planner::pass_backward(Sequence from, bool isWhole) noexcept {
    double next2 = from < last_piece_ ? piece_plan(from + 1).v2_in : 0.0;
    double cap = from >= oldest_piece_ && from > 0 ? cap_of(from) : 0.0;
    for (Sequence k = from; k >= oldest_piece_ && k > 0; --k) {
        const Piece &p = store_.piece(k);
        PiecePlan &plan = piece_plan(k);
        double v2 = std::min(cap * cap, p.acceleration.highest_before(next2, p.length));
        if (k > oldest_piece_) {
            cap = cap_of(k - 1);
            v2 = std::min(v2, cap * cap);
        }
        if (plan.isStopBefore || isBarrier(k)) {
            v2 = 0;
        }
        if (v2 != plan.v2_in) {
            changed_from_ = k;
            plan.v2_in = v2;
        } else if (!isWhole) {
            break;
        }
        next2 = v2;
    }
}

void Planner::set_scales(const Scales &scales) noexcept {
    bool isSame = scales.feed == scales_.feed && scales.rapid == scales_.rapid &&
                  scales.max_velocity == scales_.max_velocity;
    // Spindle speeds never stand still; they matter only where something follows them. What changes little is
    // followed now and then, so that a lead does not drift.
    const bool isFollowed = last_synched_ != 0 && last_piece_ >= oldest_piece_ &&
                            last_synched_ >= store_.piece(oldest_piece_).move;
    ++steady_updates_;
    const double slight =
        steady_updates_ > TimingTuning::STEADY_UPDATES ? TimingTuning::DRIFTED : TimingTuning::CHANGED;
    for (std::size_t i = 0; i < scales.spindle_rps.size() && isSame && isFollowed; ++i) {
        const double rps = scales_.spindle_rps[i];
        isSame = std::abs(scales.spindle_rps[i] - rps) <= slight * std::abs(rps);
    }
    steady_updates_ = isSame ? steady_updates_ : 0;
    if (isSame) {
        scales_.max_feed = scales.max_feed;
        scales_.spindle_rps = isFollowed ? scales_.spindle_rps : scales.spindle_rps;
        return;
    }
    scales_ = scales;
    pass_backward(last_piece_, true);
    // Speeds within pieces change too, not only those at their starts.
    changed_from_ = oldest_piece_;
}

void Planner::open_gate(Sequence move, double delay_s) noexcept {
    start_delay_s_ = delay_s;
    move_plan(move).request.isGated = false;
    pass_backward(last_piece_, true);
}

void Planner::set_step(bool isStepping, std::uint32_t block) noexcept {
    if (isStepping != isStepping_ || block != step_block_) {
        isStepping_ = isStepping;
        step_block_ = block;
        pass_backward(last_piece_, true);
    }
}

/// Where an executor at rest goes on; false when there is nothing more.
bool Planner::start_state(const Snapshot &now, State &state) const noexcept {
    state =
        now.piece < first_piece_ ? State{first_piece_, 0, 0, {}} : State{now.piece, now.x, 0, now.coasting};
    if (state.piece > last_piece_) {
        return false;
    }
    if (state.x >= store_.piece(state.piece).length) {
        if (state.piece == last_piece_) {
            return false;
        }
        state = {state.piece + 1, 0, 0, state.coasting};
    }
    if (now.isSettled) {
        state.coasting = {};
    }
    return true;
}

Sequence Planner::waiting_gate(const Snapshot &now) const noexcept {
    State state;
    const bool isWaiting = now.motion == Motion::REST && start_state(now, state) && state.x <= 0;
    return isWaiting && move_plan(move_of(state.piece)).request.isGated ? move_of(state.piece) : 0;
}

std::uint32_t Planner::next_block(const Snapshot &now) const noexcept {
    State state;
    if (now.motion != Motion::REST && now.piece >= first_piece_) {
        const Piece &p = store_.piece(now.piece);
        const bool isSecond = p.blend_d > 0 && p.offset + now.x >= p.blend_d;
        return store_.move(p.move + (isSecond ? 1 : 0)).block;
    }
    if (!start_state(now, state)) {
        const Sequence next = open_move_ != 0 ? open_move_ : raw_move_;
        return store_.move(next != 0 ? next : last_move_).block;
    }
    return store_.move(state.x > 0 ? store_.piece(state.piece).move : move_of(state.piece)).block;
}

bool Planner::isAtStepStop(const Snapshot &now) const noexcept {
    State state;
    const bool isStanding =
        isStepping_ && now.motion == Motion::REST && start_state(now, state) && state.x <= 0;
    return isStanding && move_plan(move_of(state.piece)).request.tag.block != step_block_;
}

bool Planner::hasNext(const Snapshot &now) const noexcept {
    State state;
    return now.motion != Motion::REST || open_move_ != 0 || raw_move_ != 0 || start_state(now, state);
}

std::uint32_t Planner::moves_left(const Snapshot &now) const noexcept {
    const Sequence done = std::max(now.done_move, first_move_ - 1);
    return last_move_ > done ? static_cast<std::uint32_t>(last_move_ - done) : 0;
}

/// The state that the executor will have when a plan made now can take over; false when it will have begun to
/// brake.
bool Planner::predict(const Snapshot &now, State &state) const noexcept {
    const Sequence end = plan_ends_[now.plan % plan_ends_.size()];
    Sequence n = now.phase;
    double t = now.time_in_phase;
    bool isOver = false;
    state.coasting = now.coasting;
    for (std::uint64_t c = 0; c < settings_.latency && !isOver; ++c) {
        double dt = settings_.period_s;
        while (!isOver && dt >= store_.phase(n).duration - t) {
            state.coasting.pass(store_.phase(n).a, store_.phase(n).duration - t);
            dt -= store_.phase(n).duration - t;
            isOver = n + 1 >= end;
            n += isOver ? 0 : 1;
            t = 0;
        }
        if (!isOver) {
            state.coasting.pass(store_.phase(n).a, dt);
            t += dt;
        }
    }
    const Phase &p = store_.phase(n);
    if (isOver) {
        t = p.duration;
    }
    state.piece = p.piece;
    state.x = p.x0 + t * (p.v0 + t * (0.5 * p.a + t * p.j * (1.0 / 6.0)));
    state.v = std::max(0.0, p.v0 + t * (p.a + 0.5 * t * p.j));
    if (isOver) {
        const bool isStop =
            state.v <= ExecutorTuning::STOPPED * std::abs(p.a) * (p.duration + settings_.period_s);
        state.v = 0;
        const double length = store_.piece(p.piece).length;
        const bool isAtEnd = std::abs(state.x - length) <= ExecutorTuning::ARRIVED * (1.0 + length);
        if (isAtEnd && p.piece < last_piece_) {
            state = {p.piece + 1, 0, 0, state.coasting};
        }
        return isStop && !(isAtEnd && p.piece == last_piece_);
    }
    return true;
}

bool Planner::hasPhaseRoom() const noexcept {
    return plan_end_ + TimingTuning::PHASES_PER_PIECE - oldest_phase_ < PHASE_CAPACITY;
}

/// Appends a phase over `length` that ends at the speed `v1`.
void Planner::emit_phase(double length, double v1) noexcept {
    State &s = planned_;
    const double sum = s.v + v1;
    if (length > 0 && sum > 0) {
        const double dt = 2.0 * length / sum;
        store_.phase(plan_end_) = {s.piece, dt, s.x, s.v, (v1 - s.v) / dt, 0};
        ++plan_end_;
        planned_s_ += dt;
        s.x += length;
        s.coasting.pass(v1 - s.v, dt);
    }
    s.v = v1;
}

void Planner::emit_wait(double duration) noexcept {
    State &s = planned_;
    store_.phase(plan_end_++) = {s.piece, duration, s.x, 0, 0, 0};
    planned_s_ += duration;
    s.coasting.pass(0, duration);
}

/// Up from the planned speed, at most to `cap`, and down again to `out2` (squared) where that is in reach.
void Planner::emit_hill(double left, double cap, double out2) noexcept {
    const AccelBound &bound = store_.piece(planned_.piece).acceleration;
    const double v2 = planned_.v * planned_.v;
    // The highest squared speed with an acceleration that holds there: 2 b - v2 - end2 = 2 left a(b).
    const double reach2 = bound.highest_before(v2, left);
    const double end2 = std::min(out2, reach2);
    const double peak2 =
        std::min(cap * cap, std::max(end2, bound.highest_before(0.5 * (v2 + end2), 0.5 * left)));
    const double a = bound.at(peak2);
    const double up = peak2 > v2 ? std::min(left, (peak2 - v2) / (2.0 * a)) : 0.0;
    const double down = peak2 > end2 ? std::min(left - up, (peak2 - end2) / (2.0 * a)) : 0.0;
    const double peak = std::sqrt(peak2);
    emit_phase(up, peak);
    emit_phase(left - up - down, peak);
    emit_phase(down, std::sqrt(end2));
}

/// Commits one piece from the planned state on; false when the plan ends here for now.
bool Planner::emit_piece() noexcept {
    State &s = planned_;
    const Piece &p = store_.piece(s.piece);
    const bool isLast = s.piece == last_piece_;
    isAtEndOfPath_ = isLast && s.x >= p.length;
    if (s.x >= p.length) {
        if (isLast || (s.v <= 0 && isPlanEnd(s.piece + 1))) {
            return false;
        }
        s = {s.piece + 1, 0, s.v, s.coasting};
        return true;
    }
    const double cap = cap_of(s.piece);
    if (!hasPhaseRoom() || (s.v <= 0 && cap <= 0)) {
        return false;
    }
    const double out2 = isLast ? 0.0 : piece_plan(s.piece + 1).v2_in;
    double left = p.length - s.x;
    double a = p.acceleration.at(s.v * s.v);
    if (s.v > cap) {
        // Too fast after an override came down: as hard as the limits allow, until it fits.
        const double excess = s.v * s.v - cap * cap;
        if (excess < 2.0 * a * left) {
            emit_phase(excess / (2.0 * a), cap);
            left = p.length - s.x;
            if (cap <= 0) {
                return true;
            }
            a = p.acceleration.at(s.v * s.v);
        }
    }
    const double v2 = s.v * s.v;
    const double slowest2 = v2 - 2.0 * a * left;
    if (slowest2 >= out2 || s.v > cap) {
        const bool isFit = slowest2 <= out2 + TimingTuning::STOP_FIT * v2;
        emit_phase(left, std::sqrt(isFit ? std::min(out2, v2) : slowest2));
    } else {
        emit_hill(left, cap, out2);
    }
    s.x = p.length;
    return true;
}

void Planner::emit(double until_s) noexcept {
    while (planned_s_ < until_s && emit_piece()) {
    }
}

void Planner::replan(const Snapshot &now, const State &from) noexcept {
    const std::uint64_t cycle = now.cycle + settings_.latency;
    const Sequence begin = plan_end_;
    planned_ = from;
    planned_s_ = 0;
    if (start_delay_s_ > 0 && from.v <= 0) {
        emit_wait(start_delay_s_);
    }
    const Sequence waited = plan_end_;
    emit(planned_s_ + settings_.horizon_s);
    if (plan_end_ == waited) {
        plan_end_ = begin;
        return;
    }
    Commit commit;
    commit.plan = plan_ + 1;
    commit.isSwitch = true;
    commit.switch_cycle = cycle;
    commit.brakes = now.brakes;
    commit.begin = begin;
    commit.end = plan_end_;
    if (!store_.commits.push(commit)) {
        plan_end_ = begin;
        return;
    }
    start_delay_s_ = 0;
    ++plan_;
    plan_ends_[plan_ % plan_ends_.size()] = plan_end_;
    plan_brakes_ = now.brakes;
    switch_cycle_ = cycle;
    plan_begin_ = begin;
    changed_from_ = 0;
}

void Planner::append(const Snapshot &now) noexcept {
    const double now_s =
        (static_cast<double>(now.cycle) - static_cast<double>(switch_cycle_)) * settings_.period_s;
    const Sequence end = plan_end_;
    emit(now_s + settings_.horizon_s);
    if (plan_end_ == end) {
        return;
    }
    Commit commit;
    commit.plan = plan_;
    commit.brakes = now.brakes;
    commit.begin = plan_begin_;
    commit.end = plan_end_;
    if (store_.commits.push(commit)) {
        plan_ends_[plan_ % plan_ends_.size()] = plan_end_;
    }
}

void Planner::update(const Snapshot &now) noexcept {
    if (isTried()) {
        update_filtered(now);
        return;
    }
    if (now.drops != drops_ || now.isDropping) {
        return;
    }
    oldest_piece_ = std::max(first_piece_, now.piece);
    oldest_phase_ = now.motion == Motion::FOLLOW ? now.phase : plan_begin_;
    if (last_piece_ >= oldest_piece_) {
        pass_backward(last_piece_, false);
    }
    if (now.isHeld || now.motion == Motion::BRAKE || now.motion == Motion::LOCKED) {
        return;
    }
    const bool isTaken = now.plan == plan_;
    const bool isPending = !isTaken && now.cycle < switch_cycle_ && now.brakes == plan_brakes_;
    State from;
    if (isPending) {
        if (changed_from_ == 0 || changed_from_ > planned_.piece + 1) {
            append(now);
        }
    } else if (now.motion == Motion::REST) {
        const bool isFree = start_state(now, from);
        if (isFree && isPassStart(from)) {
            if (!isBarrier(from.piece)) {
                start_pass(now, from);
            }
        } else if (isFree && !isBeforeBarrier(from)) {
            replan(now, from);
        }
    } else if (!isTaken || (changed_from_ != 0 && changed_from_ <= planned_.piece + 1)) {
        if (predict(now, from) && !isBeforeBarrier(from)) {
            replan(now, from);
        }
    } else {
        changed_from_ = 0;
        append(now);
    }
}

}  // namespace mw::traj
