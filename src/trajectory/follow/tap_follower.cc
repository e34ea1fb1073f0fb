// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/tap_follower.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

void TapFollower::begin(const TapTerms &terms, const SpindleReading &spindle, double dt) noexcept {
    *this = {};
    terms_ = terms;
    phase_ = TapPhase::WAITING;
    direction_ = spindle.turns_per_s < 0 ? -1.0 : 1.0;
    limits_ = {terms.velocity, terms.acceleration, usable_jerk(terms.jerk, terms.acceleration, dt)};
    pursuit_.begin(following_rate(terms.per_turn, spindle.step, limits_.jerk, dt),
                   std::max(TapTuning::MET, TapTuning::MET_STEPS * spindle.step) * terms.per_turn);
    const double run_in = run_in_distance(terms.per_turn * std::abs(spindle.turns_per_s), limits_);
    // The helix passes the start at a full revolution, so that a hole can be tapped again.
    origin_ = std::ceil(direction_ * spindle.turns + run_in / terms.per_turn);
}

void TapFollower::stop(const SpindleReading &spindle) noexcept {
    if (phase_ == TapPhase::STOPPING || phase_ == TapPhase::OVER) {
        return;
    }
    const bool under_way = pursuit_.hasMet() && phase_ != TapPhase::HOME && !lost_;
    const double overrun = spindle.overrun();
    run_out_ = overrun > 0 ? TapTuning::RUN_OUT * overrun + 1.0 : TapTuning::UNKNOWN_RUN_OUT;
    run_out_ = under_way ? run_out_ : -1.0;
    stop_turned_ = direction_ * spindle.turns - origin_;
    stopped_ = true;
    phase_ = TapPhase::STOPPING;
}

TapFollower::Turning TapFollower::read(const SpindleReading &spindle) const noexcept {
    Turning t;
    t.turned = direction_ * spindle.turns - origin_;
    t.speed = direction_ * spindle.turns_per_s;
    t.overrun = spindle.overrun();
    t.helix = {terms_.per_turn * t.turned, terms_.per_turn * t.speed,
               terms_.per_turn * direction_ * spindle.turns_per_s2};
    return t;
}

/// Updates the phase from the measured angle.
void TapFollower::decide(const Turning &t, double dt) noexcept {
    const double cycle = 0.5 * std::abs(t.speed) * dt;  // average delay until the command takes effect
    switch (phase_) {
    case TapPhase::WAITING: phase_ = pursuit_.hasMet() ? TapPhase::IN : TapPhase::WAITING; [[fallthrough]];
    case TapPhase::IN: {
        const double left = terms_.depth / terms_.per_turn - t.turned;
        phase_ = left <= t.overrun + cycle ? TapPhase::TURNING : phase_;
        break;
    }
    case TapPhase::TURNING: phase_ = t.speed < 0 ? TapPhase::BACK : phase_; break;
    case TapPhase::BACK: {
        const double room = -0.5 * terms_.low / terms_.per_turn;
        const double left = t.turned + std::min(TapTuning::CLEARANCE, room);
        phase_ = left <= t.overrun + cycle ? TapPhase::LEAVING : phase_;
        break;
    }
    case TapPhase::LEAVING: phase_ = t.speed >= 0 ? TapPhase::HOME : phase_; break;
    case TapPhase::HOME:
    case TapPhase::STOPPING:
    case TapPhase::OVER: break;
    }
}

/// While the tap stops, the tool follows the spindle until the spindle has run down.
bool TapFollower::isFollowing(const Turning &t) noexcept {
    if (phase_ != TapPhase::STOPPING) {
        return true;
    }
    if (lost_ || std::abs(t.turned - stop_turned_) > run_out_ || std::abs(t.speed) <= TapTuning::STANDING) {
        run_out_ = -1;
    }
    return run_out_ >= 0;
}

double TapFollower::place_at_rest(const MotionState &from) const noexcept {
    return from.x + speed_change(from, 0, limits_.acceleration, limits_.jerk).distance;
}

/// True if, on the side +1 or -1, the state is within the speed limit and can stop within the range of the
/// line.
bool TapFollower::isWithin(const MotionState &next, double side) const noexcept {
    const double settled = settled_speed(next, limits_.jerk);
    const double wall = side > 0 ? terms_.high : -terms_.low;
    return std::max(side * next.v, side * settled) <= limits_.velocity && side * place_at_rest(next) <= wall;
}

TapFollower::JerkRange TapFollower::jerk_range(double dt) const noexcept {
    const double low = std::max(-limits_.jerk, (-limits_.acceleration - state_.a) / dt);
    const double high = std::min(limits_.jerk, (limits_.acceleration - state_.a) / dt);
    // Before the tool reaches the helix, it must not reverse.
    const bool waiting = phase_ == TapPhase::WAITING;
    JerkRange range;
    range.low = -highest_allowed(-high, -low, [&](double negative) {
        const MotionState next = state_.after(-negative, dt);
        return waiting ? next.v >= 0 && settled_speed(next, limits_.jerk) >= 0 : isWithin(next, -1);
    });
    range.low = waiting && state_.v <= 0 && state_.a <= 0 ? std::max(0.0, range.low) : range.low;
    range.high = highest_allowed(low, high, [&](double jerk) { return isWithin(state_.after(jerk, dt), 1); });
    return range;
}

void TapFollower::follow(const Turning &t, double dt) noexcept {
    const JerkRange range = jerk_range(dt);
    const double wanted = pursuit_.jerk(t.helix, state_, limits_, dt, range.low, range.high);
    state_ = state_.after(std::clamp(wanted, std::min(range.low, range.high), range.high), dt);
    lost_ = lost_ || (pursuit_.hasMet() && std::abs(pursuit_.ahead()) > TapTuning::LOST * terms_.per_turn);
}

/// Begins a stop in the least time from the current state.
void TapFollower::begin_run(double dt) noexcept {
    run_.begin(speed_change(state_, 0, limits_.acceleration, limits_.jerk));
    running_ = true;
    run_.advance(state_, dt);
}

/// Moves to the start in the least time, without passing it. A reversal there would include the backlash of
/// the drive.
void TapFollower::go_home(double dt) noexcept {
    const JerkRange range = jerk_range(dt);
    const double side = place_at_rest(state_) < 0 ? 1.0 : -1.0;
    const double toward = side > 0 ? range.high : range.low;
    const auto isShort = [&](double time) { return side * place_at_rest(state_.after(toward, time)) <= 0; };
    const double t = highest_allowed(0, dt, isShort);
    state_ = state_.after(toward, t);
    if (t < dt) {
        begin_run(dt - t);
    }
}

void TapFollower::step(const SpindleReading &spindle, double dt) noexcept {
    const Turning t = read(spindle);
    decide(t, dt);
    if (phase_ == TapPhase::OVER) {
        return;
    }
    const bool was_following = !running_ && phase_ != TapPhase::HOME && isFollowing(t);
    if (running_) {
        const bool is_rest = run_.advance(state_, dt);
        if (is_rest) {
            state_.v = 0;
            const bool is_home = phase_ == TapPhase::HOME;
            state_.x = is_home ? 0.0 : state_.x;
            phase_ = TapPhase::OVER;
        }
    } else if (was_following) {
        follow(t, dt);
    } else if (phase_ == TapPhase::HOME) {
        go_home(dt);
    } else {
        begin_run(dt);
    }
    if (lost_) {
        stop(spindle);
    }
}

double TapFollower::spindle_factor() const noexcept {
    if (stopped_) {
        return 0;
    }
    const bool turned_back = phase_ == TapPhase::TURNING || phase_ == TapPhase::BACK;
    return turned_back ? -terms_.back_scale : 1.0;
}

}  // namespace mw::trajectory
