// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/pass_follower.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

double PassLeg::turns_at(double s) const noexcept {
    const double u = s - start_s;
    const double rise = length > 0 ? (per_unit_out - per_unit_in) / length : 0.0;
    return turns + u * (per_unit_in + 0.5 * u * rise);
}

double PassLeg::per_unit_at(double s) const noexcept {
    const double part = length > 0 ? std::clamp((s - start_s) / length, 0.0, 1.0) : 0.0;
    return per_unit_in + part * (per_unit_out - per_unit_in);
}

void PassFollower::begin(const PathStore &store, const Pass &pass, const SpindleReading &spindle,
                         double dt) noexcept {
    *this = {};
    pass_ = pass;
    leg_ = pass.first;
    state_.x = pass.start_s;
    limits_ = {0, pass.acceleration, usable_jerk(pass.jerk, pass.acceleration, dt)};
    const double per_unit = store.leg(leg_).per_unit_in;
    const double per_turn = 1.0 / per_unit;
    pursuit_.begin(following_rate(per_turn, spindle.step, limits_.jerk, dt), 0);
    const double speed = pass.direction * spindle.turns_per_s;
    const double run_in = run_in_distance(std::max(0.0, speed) * per_turn, limits_) * per_unit;
    origin_ = std::ceil(pass.direction * spindle.turns + run_in);
}

HelixState PassFollower::helix(const PassLeg &leg, const SpindleReading &spindle) const noexcept {
    const double turned = pass_.direction * spindle.turns - origin_;
    const double per_turn = 1.0 / leg.per_unit_at(state_.x);
    return {state_.x + (turned - leg.turns_at(state_.x)) * per_turn,
            pass_.direction * spindle.turns_per_s * per_turn,
            pass_.direction * spindle.turns_per_s2 * per_turn};
}

/// True if the speed at the end of the leg can be reached from this state within the leg.
bool PassFollower::canStop(const MotionState &next, const PassLeg &leg) const noexcept {
    if (settled_speed(next, limits_.jerk) <= leg.v_out && leg.v_out > 0) {
        return true;
    }
    return next.x + speed_change(next, leg.v_out, limits_.acceleration, limits_.jerk).distance <=
           leg.start_s + leg.length;
}

/// True if the speed is allowed on all legs up to `next`, and the remaining distance is long enough.
bool PassFollower::isAllowed(const PathStore &store, const MotionState &next) const noexcept {
    const double highest = std::max(next.v, settled_speed(next, limits_.jerk));
    Sequence leg = leg_;
    for (int n = 0; n < MOST_LEGS_PER_CYCLE; ++n) {
        const PassLeg &here = store.leg(leg);
        if (highest > here.v_most) {
            return false;
        }
        if (next.x < here.start_s + here.length || leg == pass_.last) {
            return canStop(next, here);
        }
        ++leg;
    }
    return false;
}

/// The lowest jerk with which the tool does not reverse.
double PassFollower::lowest_jerk(double low, double high, double dt) const noexcept {
    if (state_.v <= 0 && state_.a <= 0) {
        return 0;
    }
    return -highest_allowed(-high, -low, [&](double negative) {
        const MotionState next = state_.after(-negative, dt);
        return next.v >= 0 && settled_speed(next, limits_.jerk) >= 0;
    });
}

/// Begins the stop of the last leg if `jerk` would make the rest too short. The stop begins within the cycle,
/// at the time after which it ends exactly at the end of the leg.
bool PassFollower::begin_stop(const PathStore &store, double jerk, double dt) noexcept {
    const PassLeg &last = store.leg(pass_.last);
    const double end = last.start_s + last.length;
    const auto end_of_stop = [&](double t) {
        const MotionState at = state_.after(jerk, t);
        return at.x + speed_change(at, 0, limits_.acceleration, limits_.jerk).distance;
    };
    if (leg_ != pass_.last || end_of_stop(dt) <= end) {
        return false;
    }
    const double t = highest_allowed(0, dt, [&](double after) { return end_of_stop(after) <= end; });
    state_ = state_.after(jerk, t);
    stop_.begin(speed_change(state_, 0, limits_.acceleration, limits_.jerk));
    stopping_ = true;
    return stop_.advance(state_, dt - t);
}

bool PassFollower::step(const PathStore &store, const SpindleReading &spindle, double dt) noexcept {
    if (must_stop_ && !stopping_) {
        stop_.begin(speed_change(state_, 0, limits_.acceleration, limits_.jerk));
        stopping_ = true;
    }
    bool over = false;
    if (stopping_) {
        over = stop_.advance(state_, dt);
    } else {
        const double low_a = std::max(-limits_.jerk, (-limits_.acceleration - state_.a) / dt);
        const double high_a = std::min(limits_.jerk, (limits_.acceleration - state_.a) / dt);
        // The tool must not reverse.
        const double low = lowest_jerk(low_a, high_a, dt);
        const double wanted =
            pursuit_.jerk(helix(store.leg(leg_), spindle), state_, limits_, dt, low, high_a);
        if (begin_stop(store, wanted, dt)) {
            over = true;
        } else if (!stopping_) {
            const double jerk = highest_allowed(
                low, wanted, [&](double higher) { return isAllowed(store, state_.after(higher, dt)); });
            state_ = state_.after(jerk, dt);
        }
    }
    for (int n = 0; n < MOST_LEGS_PER_CYCLE && leg_ < pass_.last; ++n) {
        if (state_.x < store.leg(leg_).start_s + store.leg(leg_).length) {
            break;
        }
        ++leg_;
    }
    if (over && !must_stop_) {
        state_.x = pass_.end_s;
    }
    state_.v = over ? 0 : state_.v;
    return !over;
}

}  // namespace mw::trajectory
