// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/axis_motion.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::trajectory {

double stop_position(double position, double velocity, double acceleration) noexcept {
    return acceleration > 0 ? position + velocity * std::abs(velocity) / (2.0 * acceleration) : position;
}

void AxisMotion::stop() noexcept {
    const double place = stop_position(position, velocity, max_acceleration);
    // Who brakes to its target already comes to it, whatever whole cycles make of the way.
    constexpr double CYCLES = 1e-3;
    const bool isBehind = std::abs(place - target) <= CYCLES * std::abs(place - position) &&
                          std::abs(place - position) > std::abs(target - position);
    if (!isBehind) {
        target = brake_target_ = place;
        isBraking_ = velocity != 0.0;
    }
}

namespace {

/// Moves on with constant acceleration for at most `span`; returns the time left of dt.
double go(double &p, double &v, double a, double span, double dt) noexcept {
    const double t = std::clamp(span, 0.0, dt);
    p += t * (v + 0.5 * a * t);
    v += a * t;
    return dt - t;
}

}  // namespace

/// The acceleration that brakes to the target where `a` would lead beyond it by what rounding of `a` from
/// cycle to cycle makes of the way: at a soft limit that is beyond the limit.
double fitted(double a, double way, double velocity) noexcept {
    constexpr double ROUNDING = 1e-5;
    const double needed = way * velocity > 0 ? 0.5 * velocity * velocity / std::abs(way) : 0.0;
    return needed > a && needed <= a * (1.0 + ROUNDING) ? needed : a;
}

/// Where it ends follows from what it may do on the way: were the place kept, less acceleration would lead
/// beyond it, and a place that is asked for anew in every cycle would never be braked for.
void AxisMotion::brake(double dt) noexcept {
    const double sign = velocity < 0 ? -1.0 : 1.0;
    double p = 0;
    double v = std::abs(velocity);
    // Not a cycle more for what rounding leaves: two that brake together rest together.
    constexpr double ROUNDING = 1e-9;
    const double left = go(p, v, -max_acceleration, v / max_acceleration, dt);
    const bool isOver = left > 0 || v <= ROUNDING * max_acceleration * dt;
    position += sign * p;
    velocity = isOver ? 0.0 : sign * v;
    target = brake_target_ = stop_position(position, velocity, max_acceleration);
    isBraking_ = velocity != 0.0;
}

void AxisMotion::step(double dt) noexcept {
    if (!(max_acceleration > 0) || isAtRest()) {
        velocity = max_acceleration > 0 ? velocity : 0.0;
        return;
    }
    isBraking_ = isBraking_ && target == brake_target_;
    if (isBraking_) {
        brake(dt);
        return;
    }
    const double a = fitted(max_acceleration, target - position, velocity);
    // Turned so that the target lies beyond the place where braking now would lead.
    const double sign = target >= stop_position(position, velocity, a) ? 1.0 : -1.0;
    const double d = (target - position) * sign;
    double p = 0;
    double v = velocity * sign;
    double left = dt;
    const double rise2 = a * d + 0.5 * v * v;
    const double peak = std::min(std::max(0.0, max_velocity), std::sqrt(std::max(0.0, rise2)));
    if (v > peak) {
        left = go(p, v, -a, (v - peak) / a, left);
    } else {
        left = go(p, v, a, (peak - v) / a, left);
    }
    if (left > 0) {
        v = peak;
        const double brake = peak * peak / (2.0 * a);
        const double cruise = peak > 0 ? std::max(0.0, (d - p - brake) / peak) : left;
        left = go(p, v, 0, cruise, left);
        if (left > 0) {
            left = go(p, v, -a, peak / a, left);
            if (left > 0) {
                position = target;
                velocity = 0;
                return;
            }
        }
    }
    position += p * sign;
    velocity = v * sign;
    // Who comes to rest and may not go on is there, whatever rounding of the way leaves: else it never rests.
    constexpr double ROUNDING = 1e-7;
    const bool isThere = velocity == 0.0 && std::abs(target - position) <= ROUNDING * a * dt * dt;
    position = isThere ? target : position;
}

void AxisTrajectory::stop() noexcept {
    if (length_ <= 1) {
        AxisMotion::stop();
        return;
    }
    leader_.max_acceleration = std::min(max_acceleration, most_acceleration_);
    leader_.stop();
    target = leader_.target;
}

double AxisTrajectory::rest_after(double dt) const noexcept {
    const AxisMotion &p = length_ > 1 ? static_cast<const AxisMotion &>(leader_) : *this;
    const double a = p.max_acceleration > 0 ? p.max_acceleration : max_acceleration;
    const double sign = target >= p.position ? 1.0 : -1.0;
    const double v = p.velocity + sign * a * dt;
    const double rest = stop_position(p.position + v * dt, v, a);
    // No farther than where it is going anyway.
    const double now = stop_position(p.position, p.velocity, a);
    return sign > 0 ? std::min(rest, std::max(target, now)) : std::max(rest, std::min(target, now));
}

void AxisTrajectory::add_reach(double &low, double &high) const noexcept {
    const auto add = [&](double place) {
        low = std::min(low, place);
        high = std::max(high, place);
    };
    add(position);
    add(target);
    if (length_ <= 1) {
        add(stop_position(position, velocity, max_acceleration));
        return;
    }
    add(stop_position(leader_.position, leader_.velocity, leader_.max_acceleration));
    for (std::uint32_t n = 0; n < length_; ++n) {
        add(origin_ + way_[n]);
    }
}

/// From rest: the mean is as long as the acceleration needs to turn about.
void AxisTrajectory::begin(double dt) noexcept {
    const double samples =
        std::ceil((mean_s > 0 ? mean_s / dt : 2.0 * max_acceleration / (max_jerk * dt)) - 1e-9);
    length_ = static_cast<std::uint32_t>(std::clamp(samples, 2.0, static_cast<double>(MOST_SAMPLES)));
    jerk_ = max_jerk > 0 ? max_jerk : std::numeric_limits<double>::infinity();
    most_acceleration_ = 0.5 * jerk_ * length_ * dt;
    leader_.reset(position);
    origin_ = position;
    way_.fill(0.0);
    sum_ = 0;
    rest_ = 0;
    next_ = 0;
    standing_ = 0;
}

/// Adds without losing what a double cannot hold (two-sum).
void AxisTrajectory::add(double x) noexcept {
    const double s = sum_ + x;
    const double back = s - sum_;
    rest_ += (sum_ - (s - back)) + (x - back);
    sum_ = s;
}

void AxisTrajectory::step(double dt) noexcept {
    const bool isSmooth = max_jerk > 0 || mean_s > 0;
    const bool isBeginning = length_ <= 1 && isSmooth && max_acceleration > 0 && velocity == 0.0;
    if (isBeginning && position != target) {
        begin(dt);
    }
    if (length_ <= 1) {
        AxisMotion::step(dt);
        return;
    }
    leader_.target = target;
    leader_.max_velocity = max_velocity;
    leader_.max_acceleration = std::min(max_acceleration, most_acceleration_);
    const double leader_before = leader_.position;
    leader_.step(dt);
    target = leader_.target;  // who brakes is told where that leads
    const double way = leader_.position - origin_;
    add(way);
    add(-way_[next_]);
    way_[next_] = way;
    next_ = next_ + 1 == length_ ? 0 : next_ + 1;
    // At the end of every cycle it rests also while it is sent a little on in each.
    const bool isOn = leader_.position != leader_before;
    standing_ = !leader_.isAtRest() ? 0 : isOn ? 1 : standing_ + 1;
    const double before = position;
    const bool isOver = standing_ >= length_;
    position = isOver ? target : origin_ + (sum_ + rest_) / length_;
    velocity = isOver ? 0.0 : (position - before) / dt;
    length_ = isOver ? 1 : length_;
}

}  // namespace mw::trajectory
