// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/tap_follower.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/follow/closing_speed.hh"

namespace mw::trajectory {

namespace {

/// Revolutions until a spindle of this speed is stopped.
double overrun_of(double speed, double ramp) noexcept {
    return ramp > 0 ? 0.5 * speed * speed / ramp : 0.0;
}

}  // namespace

void TapFollower::begin(const TapTerms &terms, const SpindleReading &spindle, double ahead_s) noexcept {
    *this = {};
    terms_ = terms;
    phase_ = TapPhase::WAITING;
    direction_ = spindle.turns_per_s < 0 ? -1.0 : 1.0;
    const double v = terms.per_turn * std::abs(spindle.turns_per_s);
    const double a = TapTuning::MEETING_SHARE * terms.acceleration;
    const double run_in = 0.5 * v * v / (a * terms.per_turn);
    // The helix goes through the start at a whole turn, so that a hole may be tapped again.
    origin_ = std::ceil(direction_ * (spindle.turns + spindle.turns_per_s * ahead_s) + run_in);
}

void TapFollower::stop(const SpindleReading &spindle) noexcept {
    if (phase_ == TapPhase::STOPPING || phase_ == TapPhase::OVER) {
        return;
    }
    const bool isUnderWay = isMet_ && phase_ != TapPhase::HOME && !isLost_;
    const double ramp = spindle.ramp_at(spindle.turns_per_s);
    run_out_ = ramp > 0 ? TapTuning::RUN_OUT * overrun_of(spindle.turns_per_s, ramp) + 1.0
                        : TapTuning::UNKNOWN_RUN_OUT;
    run_out_ = isUnderWay ? run_out_ : -1.0;
    stop_turned_ = direction_ * spindle.turns - origin_;
    isStopped_ = true;
    phase_ = TapPhase::STOPPING;
}

TapFollower::Turning TapFollower::read(const SpindleReading &spindle, double dt,
                                       double mean_s) const noexcept {
    // The mean over tau of positions that are half of it ahead is late by the square's part: the last term.
    const double ahead = dt + 0.5 * mean_s;
    const double bend = 0.5 * dt * dt + 0.5 * dt * mean_s + mean_s * mean_s / 12.0;
    Turning t;
    t.turned = direction_ * spindle.turns - origin_;
    t.speed = direction_ * spindle.turns_per_s;
    t.overrun = overrun_of(spindle.turns_per_s, spindle.ramp_at(spindle.turns_per_s));
    const double change = direction_ * spindle.turns_per_s2;
    t.helix_x = terms_.per_turn * (t.turned + t.speed * ahead + change * bend);
    t.helix_v = terms_.per_turn * (t.speed + change * ahead);
    return t;
}

/// What the measured angle says of where the tap is.
void TapFollower::decide(const Turning &t, double dt) noexcept {
    const double cycle = 0.5 * std::abs(t.speed) * dt;  // what the command waits for on average
    switch (phase_) {
    case TapPhase::WAITING: phase_ = isMet_ ? TapPhase::IN : TapPhase::WAITING; [[fallthrough]];
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

/// Speed with which the tool meets the helix or keeps to it.
double TapFollower::following_speed(const Turning &t, double dt) noexcept {
    const double a = terms_.acceleration;
    // How far the tool would be ahead of the helix if it went at the helix's speed.
    const double gap = x_ + t.helix_v * dt - t.helix_x;
    const double part = std::abs(gap) / terms_.per_turn;
    isMet_ = isMet_ || (part < TapTuning::MET && std::abs(v_ - t.helix_v) < a * dt);
    isLost_ = isLost_ || (isMet_ && part > TapTuning::LOST);
    const double back = closing_speed(gap, TapTuning::MEETING_SHARE * a, dt);
    const double wanted =
        t.helix_v - (isMet_ ? std::clamp(TapTuning::GAIN * gap, -std::abs(back), std::abs(back)) : back);
    return isMet_ ? wanted : std::max(0.0, wanted);
}

double TapFollower::wanted_speed(const Turning &t, double dt) noexcept {
    const double a = terms_.acceleration;
    switch (phase_) {
    // Braked for in steps of whole cycles that end there: who goes beyond it turns the drive's play about.
    case TapPhase::HOME:
        return -std::copysign(speed_within(std::abs(x_), TapTuning::MEETING_SHARE * a * dt, dt), x_);
    case TapPhase::OVER: return 0;
    case TapPhase::STOPPING: {
        const bool isFollowing = !isLost_ && std::abs(t.turned - stop_turned_) <= run_out_ &&
                                 std::abs(t.speed) > TapTuning::STANDING;
        if (!isFollowing) {
            run_out_ = -1;
            return 0;
        }
        break;
    }
    case TapPhase::WAITING:
    case TapPhase::IN:
    case TapPhase::TURNING:
    case TapPhase::BACK:
    case TapPhase::LEAVING: break;
    }
    const double speed = following_speed(t, dt);
    return isLost_ ? 0.0 : speed;
}

void TapFollower::step(const SpindleReading &spindle, double dt, double mean_s) noexcept {
    const Turning t = read(spindle, dt, mean_s);
    decide(t, dt);
    double wanted = wanted_speed(t, dt);
    if (isLost_) {
        stop(spindle);
    }
    const double a = terms_.acceleration;
    const double round = 0.125 * a * dt * dt;  // what a stop in whole cycles may go beyond
    const double up = std::max(0.0, closing_speed(terms_.high - round - x_, a, dt));
    const double down = std::max(0.0, closing_speed(x_ - round - terms_.low, a, dt));
    wanted = std::clamp(wanted, -std::min(down, terms_.velocity), std::min(up, terms_.velocity));
    v_ = std::clamp(wanted, v_ - a * dt, v_ + a * dt);
    x_ += v_ * dt;
    const bool isHome =
        phase_ == TapPhase::HOME && std::abs(x_) <= ExecutorTuning::ARRIVED && std::abs(v_) <= a * dt;
    const bool isStopped = phase_ == TapPhase::STOPPING && run_out_ < 0 && v_ == 0.0;
    if (isHome) {
        x_ = 0;
        v_ = 0;
    }
    phase_ = isHome || isStopped ? TapPhase::OVER : phase_;
}

double TapFollower::spindle_factor() const noexcept {
    if (isStopped_) {
        return 0;
    }
    const bool isTurnedBack = phase_ == TapPhase::TURNING || phase_ == TapPhase::BACK;
    return isTurnedBack ? -terms_.back_scale : 1.0;
}

}  // namespace mw::trajectory
