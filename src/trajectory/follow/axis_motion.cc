// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/axis_motion.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

namespace {

/// Fraction of a cycle below which a motion counts as complete. Two axes that brake together then stop in the
/// same cycle.
constexpr double TIME_ROUNDING = 1e-9;

/// Moves with constant acceleration for at most `span` [s]. Returns the rest of `dt` [s].
double go(double &p, double &v, double a, double span, double dt) noexcept {
    const double t = std::clamp(span, 0.0, dt);
    p += t * (v + 0.5 * a * t);
    v += a * t;
    return dt - t;
}

/// Acceleration that stops exactly at the target if, because of rounding, `a` would pass it. Past the target
/// may be past a soft limit.
double fitted(double a, double travel, double velocity) noexcept {
    constexpr double ROUNDING = 1e-9;
    const double needed = travel * velocity > 0 ? 0.5 * velocity * velocity / std::abs(travel) : 0.0;
    return needed > a && needed <= a * (1.0 + ROUNDING) ? needed : a;
}

/// Distance of a stop from a speed, with acceleration 0 at the start.
double braking_distance(double v, double acceleration, double jerk) noexcept {
    const double time = v * jerk > acceleration * acceleration ? v / acceleration + acceleration / jerk
                                                               : 2 * std::sqrt(v / jerk);
    return 0.5 * v * time;
}

/// The fastest motion over a distance to standstill: a change of speed, a cruise, a stop. Its direction is
/// positive.
struct TravelPlan {
    SpeedChange to_speed;
    double speed = 0, cruise_s = 0;
    SpeedChange to_rest;
};

TravelPlan plan_travel(const MotionState &from, double travel, const MotionLimits &limits) noexcept {
    const auto distance = [&](double v) {
        return speed_change(from, v, limits.acceleration, limits.jerk).distance +
               braking_distance(v, limits.acceleration, limits.jerk);
    };
    double speed = limits.velocity;
    double left = travel - distance(speed);
    if (left < 0) {
        // Above the speed at which the acceleration reaches 0, the distance increases with the speed. Below
        // that speed, the motion brakes less than it could.
        const double settled = std::clamp(settled_speed(from, limits.jerk), 0.0, limits.velocity);
        const bool isAbove = distance(settled) <= travel;
        const double low = isAbove ? settled : 0.0;
        const double span = (isAbove ? limits.velocity : settled) - low;
        // The search uses the cube root, because a short distance needs a low speed that is exact to the last
        // digit.
        const auto at = [&](double root) { return low + span * root * root * root; };
        speed = at(highest_allowed(0.0, 1.0, [&](double root) { return distance(at(root)) <= travel; }));
        left = std::max(0.0, travel - distance(speed));
    }
    TravelPlan out;
    out.to_speed = speed_change(from, speed, limits.acceleration, limits.jerk);
    out.speed = speed;
    out.cruise_s = speed > 0 ? left / speed : 0.0;
    out.to_rest = speed_change({0, speed, 0}, 0, limits.acceleration, limits.jerk);
    return out;
}

/// Time at which the velocity is 0 in a part that begins and ends with opposite signs: j t^2 / 2 + a t + v =
/// 0.
double time_to_turn(const MotionState &from, const SpeedChange::Part &part) noexcept {
    const double root = std::sqrt(std::max(0.0, from.a * from.a - 2 * part.jerk * from.v));
    for (const double side : {1.0, -1.0}) {
        const double divisor = from.a + side * root;
        const double t = divisor != 0 ? -2 * from.v / divisor : -1.0;
        if (t >= 0 && t <= part.duration) {
            return t;
        }
    }
    return part.duration;
}

}  // namespace

SpeedChange AxisMotion::stopping() const noexcept {
    if (max_jerk > 0 && max_acceleration > 0) {
        return speed_change({0, velocity, acceleration}, 0, max_acceleration, max_jerk);
    }
    SpeedChange out;
    out.duration = max_acceleration > 0 ? std::abs(velocity) / max_acceleration : 0.0;
    out.distance = 0.5 * velocity * out.duration;
    return out;
}

double AxisMotion::stop_position(const SpeedChange &stop, double t) const noexcept {
    if (t >= stop.duration) {
        return position + stop.distance;
    }
    if (!(max_jerk > 0)) {
        return position + t * (velocity - 0.5 * std::copysign(max_acceleration, velocity) * t);
    }
    MotionState state{0, velocity, acceleration};
    follow(state, stop, t);
    return position + state.x;
}

double AxisMotion::rest() const noexcept {
    return position + stopping().distance;
}

void AxisMotion::add_reach(double &low, double &high) const noexcept {
    add_stop(low, high);
    low = std::min(low, target);
    high = std::max(high, target);
}

void AxisMotion::add_stop(double &low, double &high) const noexcept {
    const SpeedChange stop = stopping();
    const auto add = [&](double point) {
        low = std::min(low, point);
        high = std::max(high, point);
    };
    add(position);
    add(position + stop.distance);
    // If the acceleration opposes the velocity, the motion may reverse before it stops.
    MotionState state{position, velocity, acceleration};
    for (const SpeedChange::Part &part : stop.parts) {
        const MotionState next = state.after(part.jerk, part.duration);
        if (state.v * next.v < 0) {
            add(state.after(part.jerk, time_to_turn(state, part)).x);
        }
        state = next;
    }
}

void AxisMotion::end_at(double point) noexcept {
    position = point;
    velocity = acceleration = 0;
}

void AxisMotion::stop() noexcept {
    const double point = rest();
    // A motion that already brakes to its target must reach it in spite of the rounding error of the
    // distance.
    constexpr double CYCLES = 1e-3;
    const bool isBehind = std::abs(point - target) <= CYCLES * std::abs(point - position) &&
                          std::abs(point - position) > std::abs(target - position);
    if (!isBehind) {
        target = brake_target_ = point;
        isBraking_ = velocity != 0.0 || acceleration != 0.0;
    }
}

/// The target of a stop follows from the current limits. A fixed target would be passed if the acceleration
/// limit were lowered, and a stop that is requested in every cycle would never begin to brake.
void AxisMotion::brake(double dt) noexcept {
    bool isOver = false;
    if (max_jerk > 0) {
        const SpeedChange stop = stopping();
        MotionState state{0, velocity, acceleration};
        isOver = stop.duration <= dt * (1.0 + TIME_ROUNDING);
        follow(state, stop, dt);
        position += isOver ? stop.distance : state.x;
        velocity = state.v;
        acceleration = state.a;
    } else {
        const double sign = velocity < 0 ? -1.0 : 1.0;
        double p = 0;
        double v = std::abs(velocity);
        const double left = go(p, v, -max_acceleration, v / max_acceleration, dt);
        isOver = left > 0 || v <= TIME_ROUNDING * max_acceleration * dt;
        position += sign * p;
        velocity = sign * v;
        acceleration = 0;
    }
    if (isOver) {
        end_at(position);
    }
    target = brake_target_ = rest();
    isBraking_ = !isOver;
}

void AxisMotion::step(double dt) noexcept {
    if (!(max_acceleration > 0) || isAtRest()) {
        if (!(max_acceleration > 0)) {
            velocity = acceleration = 0;
        }
        return;
    }
    isBraking_ = isBraking_ && target == brake_target_;
    if (isBraking_) {
        brake(dt);
        return;
    }
    max_jerk > 0 ? step_with_jerk(dt) : step_without_jerk(dt);
    // At standstill, a distance within rounding counts as 0. Otherwise the motion would never end if the
    // velocity limit is 0.
    constexpr double ROUNDING = 1e-7;
    const bool isStill = velocity == 0.0 && acceleration == 0.0;
    if (isStill && std::abs(target - position) <= ROUNDING * max_acceleration * dt * dt) {
        position = target;
    }
}

void AxisMotion::step_with_jerk(double dt) noexcept {
    const double travel = target - position;
    const double side = travel >= stopping().distance ? 1.0 : -1.0;
    MotionState state{0, side * velocity, side * acceleration};
    const TravelPlan plan =
        plan_travel(state, side * travel, {std::max(0.0, max_velocity), max_acceleration, max_jerk});
    const double time = plan.to_speed.duration + plan.cruise_s + plan.to_rest.duration;
    if (max_velocity > 0 && time <= dt * (1.0 + TIME_ROUNDING)) {
        end_at(target);
        return;
    }
    double left = follow(state, plan.to_speed, dt);
    if (left > 0) {
        state.v = plan.speed;
        const double cruise = std::min(left, plan.cruise_s);
        state.x += plan.speed * cruise;
        follow(state, plan.to_rest, left - cruise);
    }
    position += side * state.x;
    velocity = side * state.v;
    acceleration = side * state.a;
}

void AxisMotion::step_without_jerk(double dt) noexcept {
    acceleration = 0;
    const double a = fitted(max_acceleration, target - position, velocity);
    // The direction is chosen so that the target is ahead of the position where braking now would end.
    const double rest = position + velocity * std::abs(velocity) / (2.0 * a);
    const double sign = target >= rest ? 1.0 : -1.0;
    const double d = (target - position) * sign;
    double p = 0;
    double v = velocity * sign;
    double left = dt;
    const double rise2 = a * d + 0.5 * v * v;
    const double peak = std::min(std::max(0.0, max_velocity), std::sqrt(std::max(0.0, rise2)));
    left = v > peak ? go(p, v, -a, (v - peak) / a, left) : go(p, v, a, (peak - v) / a, left);
    if (left > 0) {
        v = peak;
        const double braking = peak * peak / (2.0 * a);
        const double cruise = peak > 0 ? std::max(0.0, (d - p - braking) / peak) : left;
        left = go(p, v, 0, cruise, left);
        if (left > 0) {
            left = go(p, v, -a, peak / a, left);
            if (left > 0) {
                end_at(target);
                return;
            }
        }
    }
    position += p * sign;
    velocity = v * sign;
}

}  // namespace mw::trajectory
