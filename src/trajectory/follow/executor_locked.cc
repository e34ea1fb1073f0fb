// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that are locked to the angle of a spindle: threads. The speed of the coming cycle is the greatest
// that meets the helix without passing it, within what the path allows. Formulas: docs/developer/planner.md.
#include <algorithm>
#include <cmath>

#include "trajectory/follow/closing_speed.hh"
#include "trajectory/follow/executor.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

AccelBound part_of(const AccelBound &bound, double share) noexcept {
    AccelBound out = bound;
    for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
        out.alpha[i] *= share;
        out.beta[i] *= share;
    }
    return out;
}

}  // namespace

/// Where the spindle will be at the end of this cycle, or as much later as the mean is behind, and how fast
/// it will turn then. The mean over tau of places that are half of it ahead is late by the square's part.
Executor::Turned Executor::turned() const noexcept {
    const SpindleReading s = reading();
    const double mean_s = static_cast<double>(state_.filter - 1) * period_;
    const double ahead = period_ + 0.5 * mean_s;
    const double bend = 0.5 * period_ * (period_ + mean_s) + mean_s * mean_s / 12.0;
    return {lock_.pass.direction * (s.turns + s.turns_per_s * ahead + s.turns_per_s2 * bend),
            lock_.pass.direction * (s.turns_per_s + s.turns_per_s2 * ahead)};
}

/// The pass begins so that its helix goes through the start at a whole turn, whatever the speed.
bool Executor::take_pass(const Commit &commit) noexcept {
    const bool isFree = !state_.isHeld && !state_.isDropping && commit.brakes == state_.brakes;
    if (!isFree || !isAtRest()) {
        return false;
    }
    lock_ = {};
    lock_.pass = commit.pass;
    lock_.came_from = commit.pass.first;
    state_.plan = commit.plan;
    if (commit.filter != state_.filter) {
        state_.filter = commit.filter;
        mean_.reset(leader_, state_.filter, state_.tick);
    }
    state_.motion = Motion::LOCKED;
    state_.isOnCurve = false;
    state_.piece = commit.pass.first;
    state_.x = 0;
    state_.v = 0;
    const Piece &piece = store_.piece(state_.piece);
    if (commit.pass.isTap) {
        tap_.begin(commit.pass.tap, reading(), 0.5 * static_cast<double>(state_.filter + 1) * period_);
        return true;
    }
    const Turned spindle = turned();
    const double v = piece.per_turn * std::max(0.0, spindle.per_s);
    const double a = ExecutorTuning::MEETING_SHARE * commit.pass.share * piece.acceleration.at(0);
    const double run_in = a > 0 && piece.per_turn > 0 ? 0.5 * v * v / (a * piece.per_turn) : 0.0;
    lock_.origin = std::ceil(spindle.turns + run_in);
    return true;
}

/// What the pieces that the last and the coming cycle touch leave for the path, at the speed that it may lead
/// to: differences of the samples span both.
double Executor::acceleration_left() const noexcept {
    const Piece &piece = store_.piece(state_.piece);
    const double here = piece.acceleration.at(state_.v * state_.v);
    const double v = state_.v + here * period_;
    double left =
        std::min(piece.acceleration.at(v * v), store_.piece(lock_.came_from).acceleration.at(v * v));
    const bool isNear = state_.x + v * period_ >= piece.length && state_.piece < lock_.pass.last;
    if (isNear) {
        left = std::min(left, store_.piece(state_.piece + 1).acceleration.at(v * v));
    }
    return left;
}

/// The speed for the coming cycle.
double Executor::locked_speed() noexcept {
    const Piece &piece = store_.piece(state_.piece);
    const Turned spindle = turned();
    const double left = acceleration_left();
    const double trim = lock_.pass.trim * left;
    const double a = lock_.wasOn ? trim : lock_.pass.share * left;
    const double helix_v = piece.per_turn * spindle.per_s;
    const double helix_x = piece.per_turn * (spindle.turns - lock_.origin - lock_.passed_turns);
    // How far the tool would be ahead of the helix if it went at the helix's speed.
    const double gap = state_.x + helix_v * period_ - helix_x;
    const double part = std::abs(gap) / piece.per_turn;
    // With what is left to follow, the rest of the speed is made good within what counts as lost.
    const double slower = state_.v - helix_v;
    const bool isAsFast = 0.5 * slower * slower <= trim * ExecutorTuning::LOST * piece.per_turn;
    // A rough encoder may never let it be met exactly.
    lock_.near_cycles = part < ExecutorTuning::NEAR ? lock_.near_cycles + 1 : 0;
    const bool isCrossing = isAsFast && gap * lock_.gap < 0;
    lock_.crossings += isCrossing ? 1 : 0;
    lock_.gap = gap;
    const bool isRough =
        lock_.near_cycles >= ExecutorTuning::NEAR_CYCLES || lock_.crossings >= ExecutorTuning::CROSSINGS;
    const bool isMet = part < ExecutorTuning::MET && std::abs(state_.v - helix_v) < a * period_;
    lock_.isOn = lock_.isOn ? part < ExecutorTuning::LOST : isMet || isRough;
    lock_.wasOn = lock_.wasOn || lock_.isOn;
    // Who is behind comes to the helix faster than it, and has to get slower.
    const double closing = ExecutorTuning::MEETING_SHARE * (gap > 0 ? a : std::min(a, trim));
    const double wanted =
        helix_v - (lock_.isOn ? ExecutorTuning::GAIN * gap : closing_speed(gap, closing, period_));
    const double fall = lock_.wasDescending ? 0.5 : 1.0;
    const double low = std::max(0.0, state_.v - fall * trim * period_);
    return std::clamp(std::min(wanted, piece.v_most), low, state_.v + a * period_);
}

/// Brakes to the end of the piece when the next cycle at this speed would come too near to it. True while it
/// does, or when an abort asks for it.
bool Executor::descend(double v) noexcept {
    const Piece &piece = store_.piece(state_.piece);
    const AccelBound bound = part_of(piece.acceleration, lock_.pass.share);
    const double left = piece.length - state_.x;
    if (lock_.descent > 0 || state_.isDropping) {
        return true;
    }
    const double after = std::max(0.0, left - std::max(v, state_.v) * period_);
    const double highest2 = after > 0 ? bound.highest_before(piece.v2_out, after) : piece.v2_out;
    if (std::max(v, state_.v) * std::max(v, state_.v) <= highest2) {
        return false;
    }
    lock_.descent = std::max(0.0, 0.5 * (state_.v * state_.v - piece.v2_out) / std::max(left, 1e-300));
    return lock_.descent > 0;
}

/// On to the next piece with what is left of the way; come to rest behind the last one.
double Executor::leave_piece(double x) noexcept {
    const Piece &piece = store_.piece(state_.piece);
    lock_.descent = 0;
    if (state_.piece == lock_.pass.last) {
        come_to_rest();
        return piece.length;
    }
    lock_.passed_turns += piece.length / piece.per_turn;
    ++state_.piece;
    return x - piece.length;
}

SpindleReading Executor::reading() const noexcept {
    return spindles_[static_cast<std::size_t>(lock_.pass.spindle)].reading();
}

/// One cycle of a tap: its line is the first piece, and the way back the rest of the pass.
void Executor::advance_tap() noexcept {
    const SpindleReading spindle = reading();
    if (state_.isDropping) {
        tap_.stop(spindle);
    }
    tap_.step(spindle, period_, static_cast<double>(state_.filter - 1) * period_);
    state_.x = tap_.x();
    state_.v = tap_.v();
    out_.tap = {lock_.pass.spindle, tap_.spindle_factor(), tap_.isLost()};
    if (!tap_.isOver()) {
        return;
    }
    if (!state_.isDropping && !tap_.isLost()) {
        state_.piece = lock_.pass.last;
        state_.x = store_.piece(lock_.pass.last).length;
    }
    come_to_rest();
}

/// One cycle of a pass.
void Executor::step_locked() noexcept {
    lock_.pass.isTap ? advance_tap() : advance_locked();
    state_.coasting.pass(-1, period_);  // for the plan that follows: the speed may just have fallen
}

void Executor::advance_locked() noexcept {
    const double wanted = locked_speed();
    lock_.came_from = state_.piece;
    const bool isDescending = descend(wanted);
    lock_.gain.take(isDescending ? 0.0 : (wanted - state_.v) / period_, state_.filter);
    if (!isDescending) {
        state_.v = wanted;
        state_.x += wanted * period_;
        lock_.wasDescending = false;
        for (int n = 0;
             n < ExecutorTuning::MOST_PIECES_PER_CYCLE && state_.x >= store_.piece(state_.piece).length;
             ++n) {
            if (state_.motion != Motion::LOCKED) {
                break;
            }
            state_.x = leave_piece(state_.x);
        }
        return;
    }
    double dt = period_;
    for (int n = 0; n < ExecutorTuning::MOST_PIECES_PER_CYCLE && dt > 0 && state_.motion == Motion::LOCKED;
         ++n) {
        const Piece &piece = store_.piece(state_.piece);
        const double left = piece.length - state_.x;
        const double a = state_.isDropping
                             ? lock_.dropping_acceleration(piece.acceleration.at(state_.v * state_.v))
                             : lock_.descent;
        const double stop_s = a > 0 ? state_.v / a : 0.0;
        const double end_v2 = std::max(0.0, state_.v * state_.v - 2.0 * a * left);
        const bool isAtEnd = end_v2 > 0 || (!state_.isDropping && piece.v2_out > 0);
        const double end_s = 2.0 * left / std::max(state_.v + std::sqrt(end_v2), 1e-300);
        lock_.wasDescending = true;
        if (isAtEnd && end_s <= dt) {
            dt -= end_s;
            state_.v = std::sqrt(end_v2);
            state_.x = leave_piece(piece.length);
            if (!state_.isDropping && state_.motion == Motion::LOCKED) {
                state_.x += state_.v * dt;
                dt = 0;
            }
            continue;
        }
        if (stop_s <= dt) {
            state_.x =
                state_.isDropping ? std::min(piece.length, state_.x + 0.5 * state_.v * stop_s) : piece.length;
            lock_.descent = 0;
            come_to_rest();
            return;
        }
        state_.x = std::min(piece.length, state_.x + dt * (state_.v - 0.5 * a * dt));
        state_.v = std::max(0.0, state_.v - a * dt);
        dt = 0;
    }
}

}  // namespace mw::trajectory
