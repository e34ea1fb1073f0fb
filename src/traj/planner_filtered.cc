// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits: profiles for a leader whose mean is commanded (docs/motion/planner.md).
// Between rising and falling the leader keeps its speed for as long as the mean takes, so that the
// acceleration never swings by more than the mean can spread.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

/// True when the speed can be kept for the time of the mean from here and everything after that is still
/// kept.
bool Planner::canCoast(Sequence piece, double x, double v) noexcept {
    double way = v * filter_s();
    const double v2 = v * v * (1.0 - TimingTuning::SAME_SPEED);
    for (Sequence k = piece; k <= last_piece_; ++k, x = 0) {
        looked_at_ = std::max(looked_at_, k);
        const Piece &p = store_.piece(k);
        const double left = p.length - x;
        const double out2 = k == last_piece_ ? 0.0 : piece_plan(k + 1).v2_in;
        if (way < left) {
            return v2 <= p.acceleration.highest_before(out2, left - way);
        }
        if (v2 > out2) {
            return false;
        }
        way -= left;
    }
    return false;
}

/// Rises as far as the piece, the cap and what follows allow; false when that is next to nothing.
bool Planner::emit_rise(double cap) noexcept {
    const State &s = planned_;
    const Piece &p = store_.piece(s.piece);
    const double v2 = s.v * s.v;
    const double left = p.length - s.x;
    const double top = std::min(cap, std::sqrt(p.acceleration.highest_before(v2, left)));
    const auto way_to = [&](double v) {
        const double a = p.acceleration.at(v * v);
        return a > 0 ? std::min(left, (v * v - v2) / (2.0 * a)) : left;
    };
    double v = top;
    if (!canCoast(s.piece, s.x + way_to(v), v)) {
        double low = s.v;
        double high = top;
        for (int i = 0; i < TimingTuning::RISE_STEPS; ++i) {
            const double middle = 0.5 * (low + high);
            (canCoast(s.piece, s.x + way_to(middle), middle) ? low : high) = middle;
        }
        v = low;
    }
    const bool isWorthIt = v > s.v * (1.0 + TimingTuning::RISE_WORTH) &&
                           (v == top || v - s.v > TimingTuning::PART_RISE_WORTH * v);
    if (isWorthIt) {
        emit_phase(way_to(v), v);
    }
    return isWorthIt;
}

/// Keeps the speed until it may rise or must fall.
void Planner::emit_coast(double cap, double out2) noexcept {
    const State &s = planned_;
    const Piece &p = store_.piece(s.piece);
    const double left = p.length - s.x;
    const double v2 = s.v * s.v;
    const double brake = v2 > out2 ? (v2 - out2) / (2.0 * p.acceleration.at(v2)) : 0.0;
    double way = std::max(0.0, left - brake);
    const double since_s = s.v < cap ? s.coasting.since_fall_s : s.coasting.since_rise_s;
    const double wait = filter_s() - since_s;
    if (wait > TimingTuning::SOON && s.v != cap) {
        way = std::min(way, s.v * wait);
    }
    emit_phase(std::max(way, 1e-9 * left), s.v);
}

/// Appends the next phase or two; false when the plan ends here for now.
bool Planner::emit_filtered() noexcept {
    State &s = planned_;
    const Piece &p = store_.piece(s.piece);
    const bool isLast = s.piece == last_piece_;
    looked_at_ = std::max(looked_at_, s.piece);
    isAtEndOfPath_ = isLast && s.x >= p.length;
    if (s.x >= p.length || (s.v <= 0 && p.length - s.x < TimingTuning::AT_END)) {
        if (isLast || (s.v <= 0 && isPlanEnd(s.piece + 1))) {
            return false;
        }
        s = {s.piece + 1, 0, s.v, s.coasting};
        return true;
    }
    const double cap = cap_of(s.piece);
    const bool isRoom = plan_end_ + PHASE_CAPACITY / 2 - oldest_phase_ < PHASE_CAPACITY;
    if (!isRoom || (s.v <= 0 && cap <= 0)) {
        return false;
    }
    const double tau = filter_s();
    if (s.v <= 0) {
        const PiecePlan &plan = piece_plan(s.piece);
        const double wait = (s.x <= 0 && plan.isStopBefore ? plan.dwell_s : tau) - s.coasting.since_fall_s;
        if (wait > TimingTuning::SOON) {
            emit_wait(wait);
        }
        s.coasting = {};
        return emit_rise(cap);
    }
    const double v2 = s.v * s.v;
    const double left = p.length - s.x;
    const double out2 = isLast ? 0.0 : piece_plan(s.piece + 1).v2_in;
    const bool mustFall = v2 >= p.acceleration.highest_before(out2, left) * (1.0 - TimingTuning::SAME_SPEED);
    const double a = p.acceleration.at(v2);
    if (s.v > cap * (1.0 + TimingTuning::SAME_SPEED) && s.coasting.since_rise_s >= tau - TimingTuning::SOON) {
        const double excess = v2 - cap * cap;
        const bool isShort = excess < 2.0 * a * left;
        emit_phase(isShort ? excess / (2.0 * a) : left, isShort ? cap : std::sqrt(v2 - 2.0 * a * left));
    } else if (mustFall) {
        const double slowest2 = v2 - 2.0 * a * left;
        const bool isFit = slowest2 <= out2 + TimingTuning::STOP_FIT * v2;
        const double end = std::sqrt(isFit ? std::min(out2, v2) : slowest2);
        emit_phase(left, end > s.v * (1.0 - TimingTuning::SAME_SPEED) ? s.v : end);
        s.x = p.length;
    } else {
        const bool mayRise = s.coasting.since_fall_s >= tau - TimingTuning::SOON &&
                             s.v < cap * (1.0 - TimingTuning::SAME_SPEED);
        if (!mayRise || !emit_rise(cap)) {
            emit_coast(cap, out2);
        }
    }
    const double rounding = TimingTuning::ROUND_END * p.length;
    const bool isAtEnd = p.length - s.x <= rounding;
    s.x = isAtEnd ? p.length : s.x;
    if (isAtEnd && s.v > 0 && out2 <= 0 && s.v * s.v <= 4.0 * p.acceleration.at(0) * rounding) {
        // Braking from here takes less way than rounding.
        s.v = 0;
        emit_wait(settings_.period_s);
    }
    return true;
}

/// From the end of the plan to a stop; false when there is no room for it.
bool Planner::emit_tail() noexcept {
    State &s = planned_;
    while (s.v > 0) {
        if (plan_end_ + TimingTuning::PHASES_PER_STOP - oldest_phase_ >= PHASE_CAPACITY) {
            return false;
        }
        const Piece &p = store_.piece(s.piece);
        looked_at_ = std::max(looked_at_, s.piece);
        const double left = p.length - s.x;
        if (!(left > 0)) {
            if (s.piece == last_piece_) {
                return s.v <= 0;
            }
            s = {s.piece + 1, 0, s.v, s.coasting};
            continue;
        }
        const double v2 = s.v * s.v;
        const double out2 = s.piece == last_piece_ ? 0.0 : piece_plan(s.piece + 1).v2_in;
        const double wait = filter_s() - s.coasting.since_rise_s;
        const bool mayCoast =
            v2 < p.acceleration.highest_before(out2, left) * (1.0 - TimingTuning::SAME_SPEED);
        if (wait > TimingTuning::SOON && mayCoast) {
            emit_coast(0, out2);
            if (s.x > p.length * (1.0 - TimingTuning::ROUND_END)) {
                s.x = p.length;
            }
            continue;
        }
        const double a = p.acceleration.at(v2);
        const double slowest2 = v2 - 2.0 * a * left;
        const bool isStop = s.piece == last_piece_ || piece_plan(s.piece + 1).isStopBefore;
        if (isStop || slowest2 <= TimingTuning::STOP_FIT * v2) {
            // A stop that misses the end by rounding is fitted to it.
            emit_phase(slowest2 < -TimingTuning::STOP_FIT * v2 ? v2 / (2.0 * a) : left, 0);
            return true;
        }
        emit_phase(left, std::sqrt(slowest2));
        s.x = p.length;
    }
    return true;
}

bool Planner::replan_filtered(const Snapshot &now, State from, bool isStop) noexcept {
    const Sequence begin = plan_end_;
    const double standing =
        TimingTuning::STANDING * store_.piece(from.piece).acceleration.at(0) * settings_.period_s;
    from.v = from.v < standing ? 0.0 : from.v;
    const double delay = start_delay_s_;
    ++replan_;
    isAfterDriven_ = false;
    isRefused_ = false;
    eased_excess_ = UNLIMITED;
    eased_tick_ = 0;
    gentle_ = {};
    for (int n = 0; n < TimingTuning::ATTEMPTS; ++n) {
        plan_end_ = begin;
        planned_ = from;
        planned_s_ = 0;
        looked_at_ = from.piece;
        if (delay > 0 && from.v <= 0) {
            emit_wait(delay);
        }
        const Sequence waited = plan_end_;
        if (isStop && from.v <= 0) {
            emit_wait(settings_.period_s);
        }
        while (!isStop && planned_s_ < delay + settings_.horizon_s && emit_filtered()) {
        }
        const bool isAtEnd = isAtEndOfPath_;
        const double until_s = planned_s_;
        const bool isEmpty = plan_end_ == waited && from.v <= 0;
        if (isEmpty || !emit_tail() || isStopPassed(begin)) {
            break;  // the plan before this one stays in force, with its stop
        }
        isAtEndOfPath_ = isAtEnd;
        planned_s_ = until_s;
        if (isPlanSound(now, from, begin)) {
            Commit commit;
            commit.plan = plan_ + 1;
            commit.isSwitch = true;
            commit.switch_cycle = now.cycle + settings_.latency;
            commit.brakes = now.brakes;
            commit.begin = begin;
            commit.end = plan_end_;
            commit.filter = filter_;
            commit.isStop = isStop;
            if (!store_.commits.push(commit)) {
                break;
            }
            start_delay_s_ = 0;
            ++plan_;
            plan_ends_[plan_ % plan_ends_.size()] = plan_end_;
            plan_brakes_ = now.brakes;
            switch_cycle_ = commit.switch_cycle;
            plan_begin_ = begin;
            changed_from_ = 0;
            isStopPlan_ = isStop;
            return true;
        }
        isRefused_ = true;
        if (!ease(from)) {
            break;
        }
    }
    plan_end_ = begin;
    if (isAfterDriven_) {
        take_back_easing();
    }
    return false;
}

bool Planner::take_stuck() noexcept {
    const bool isStuck = refusals_ == TimingTuning::MOST_REFUSALS;
    refusals_ += isStuck ? 1 : 0;
    return isStuck;
}

void Planner::update_filtered(const Snapshot &now) noexcept {
    const bool isGone = now.drops != drops_ || (now.isDropping && now.motion == Motion::REST);
    if (isGone || now.motion == Motion::BRAKE || now.motion == Motion::LOCKED) {
        return;
    }
    oldest_piece_ = std::max(first_piece_, now.piece);
    oldest_phase_ = now.motion == Motion::FOLLOW ? now.phase : plan_begin_;
    if (last_piece_ >= oldest_piece_) {
        pass_backward(last_piece_, false);
    }
    const bool isTaken = now.plan == plan_;
    const bool isPending = !isTaken && now.cycle < switch_cycle_ && now.brakes == plan_brakes_;
    const bool mustStop = now.isHeld || now.isDropping;
    State from;
    if (now.motion == Motion::REST) {
        const bool isReady = !mustStop && !isPending && (filter_ == now.filter || now.isSettled);
        const bool isFree = isReady && start_state(now, from);
        if (isFree && isPassStart(from)) {
            if (now.isSettled && !isBarrier(from.piece)) {
                start_pass(now, from);
            }
        } else if (isFree && !isBeforeBarrier(from)) {
            const bool isPlanned = replan_filtered(now, from, false);
            refusals_ = isPlanned || !isRefused_ || !now.isSettled ? 0 : refusals_ + 1;
        }
        return;
    }
    const double now_s =
        (static_cast<double>(now.cycle) - static_cast<double>(switch_cycle_)) * settings_.period_s;
    const bool isShort = !isAtEndOfPath_ && planned_s_ - now_s < TimingTuning::RENEWAL * settings_.horizon_s;
    const bool isChanged = changed_from_ != 0 && changed_from_ <= looked_at_ + 1;
    const bool isStopMade = isStopPlan_ && (isTaken || isPending);
    const bool isDue = mustStop ? !isStopMade : isStopMade || !isTaken || isShort || isChanged;
    if (isDue && (!isPending || mustStop) && predict(now, from) && !isBeforeBarrier(from)) {
        replan_filtered(now, from, mustStop);
    }
}

}  // namespace mw::traj
