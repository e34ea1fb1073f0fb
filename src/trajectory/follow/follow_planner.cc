// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/follow_planner.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace mw::trajectory {

namespace {

/// Rounding error of a position.
constexpr double ROUNDING = 1e-10;

void limit(AxisMotion &motion, const FollowLimits &limits) noexcept {
    motion.max_velocity = limits.velocity;
    motion.max_acceleration = limits.acceleration;
    motion.max_jerk = limits.jerk;
}

/// Speed of the fastest stop when its acceleration has fallen to 0.
double settled(const AxisMotion &motion) noexcept {
    return motion.max_jerk > 0 ? settled_speed({0, motion.velocity, motion.acceleration}, motion.max_jerk)
                               : motion.velocity;
}

/// True if the stop from this state keeps the velocity limit and the range, or exceeds them by no more than
/// the stop from `before`.
bool hasStop(const AxisMotion &motion, const AxisMotion &before, const FollowLimits &limits) noexcept {
    if (std::abs(settled(motion)) > std::max(limits.velocity, std::abs(settled(before))) * (1.0 + 1e-9)) {
        return false;
    }
    double low = std::min(limits.low, before.position);
    double high = std::max(limits.high, before.position);
    before.add_stop(low, high);
    double least = motion.position;
    double most = motion.position;
    motion.add_stop(least, most);
    return least >= low - ROUNDING && most <= high + ROUNDING;
}

}  // namespace

void FollowPlanner::reset(double at) noexcept {
    motion_.reset(at);
    wanted_ = at;
    wanted_velocity_ = velocity_ = acceleration_ = 0;
}

void FollowPlanner::shift(double by) noexcept {
    motion_.renumber(motion_.position + by, by);
    wanted_ += by;
}

void FollowPlanner::follow(double wanted, const FollowLimits &limits, double dt) noexcept {
    if (!(limits.acceleration > 0) || !(limits.velocity > 0)) {
        reset(motion_.position);
        return;
    }
    limit(motion_, limits);
    const double before = motion_.position;
    const double commanded = std::clamp(wanted, std::min(limits.low, before), std::max(limits.high, before));
    const Wanted now = wanted_at(commanded, limits, dt);
    if (!take(now, limits, dt) && !pursue(now, limits, dt)) {
        // A motion that can stop within the range can also move to a position within the range.
        motion_.target = commanded;
        motion_.step(dt);
    }
    wanted_velocity_ = now.velocity;
    wanted_ = commanded;
    record(before, dt);
}

/// If the position moves faster than the velocity limit, it counts as a jump. If it accelerates too fast, its
/// acceleration counts as 0.
FollowPlanner::Wanted FollowPlanner::wanted_at(double commanded, const FollowLimits &limits,
                                               double dt) const noexcept {
    constexpr double SHARE = 0.5;  // part of the acceleration; the rest is for catching up
    const double moved = (commanded - wanted_) / dt;
    const double velocity = std::abs(moved) <= limits.velocity ? moved : 0.0;
    const double rise = (velocity - wanted_velocity_) / dt;
    return {commanded, velocity, std::abs(rise) <= SHARE * limits.acceleration ? rise : 0.0};
}

void FollowPlanner::record(double before, double dt) noexcept {
    const double velocity = (motion_.position - before) / dt;
    acceleration_ = (velocity - velocity_) / dt;
    velocity_ = velocity;
}

/// Moves to the position in this cycle, if the samples keep the limits and can follow the position
/// afterwards.
bool FollowPlanner::take(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept {
    const double commanded = wanted.commanded;
    const double v = (commanded - motion_.position) / dt;
    // Assumes the velocity of the position for the next cycle, and its acceleration after that.
    const std::array<double, 4> a{acceleration_, (v - velocity_) / dt,
                                  (wanted.velocity - v) / dt + wanted.acceleration, wanted.acceleration};
    constexpr double SLACK = 1.0 + 1e-9;
    bool isWithin = std::abs(v) <= limits.velocity * SLACK;
    for (std::size_t n = 1; n < a.size(); ++n) {
        isWithin = isWithin && std::abs(a[n]) <= limits.acceleration * SLACK &&
                   (!(limits.jerk > 0) || std::abs(a[n] - a[n - 1]) <= limits.jerk * dt * SLACK);
    }
    if (!isWithin) {
        return false;
    }
    AxisMotion next = motion_;
    next.position = next.target = commanded;
    // The difference of two samples is the average velocity between them.
    next.velocity = v + 0.5 * a[1] * dt;
    next.acceleration = limits.jerk > 0 ? a[1] : 0.0;
    if (v == 0.0 && wanted.velocity == 0.0) {
        next.velocity = next.acceleration = 0;
    }
    if (!hasStop(next, motion_, limits)) {
        return false;
    }
    motion_ = next;
    return true;
}

/// Catches up: moves to standstill relative to the position, with its current velocity and acceleration.
bool FollowPlanner::pursue(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept {
    const double bend = limits.jerk > 0 ? wanted.acceleration : 0.0;
    const double commanded = wanted.commanded;
    const double speed = wanted.velocity;
    AxisMotion relative = motion_;
    relative.position = motion_.position - (commanded - speed * dt);
    relative.velocity = motion_.velocity - (speed - 0.5 * bend * dt);
    relative.acceleration = motion_.acceleration - bend;
    relative.target = 0;
    const double ahead = relative.rest() < 0 ? 1.0 : -1.0;  // direction to the position
    relative.max_velocity = std::max(0.0, limits.velocity - speed * ahead);
    relative.max_acceleration = limits.acceleration - std::abs(bend);
    relative.step(dt);
    AxisMotion next = motion_;
    next.position = commanded + relative.position;
    next.velocity = relative.velocity + speed + 0.5 * bend * dt;
    next.acceleration = relative.acceleration + bend;
    next.target = commanded;
    if (!hasStop(next, motion_, limits)) {
        return false;
    }
    motion_ = next;
    return true;
}

void FollowPlanner::brake(const FollowLimits &limits, double dt) noexcept {
    const double before = motion_.position;
    limit(motion_, limits);
    motion_.stop();
    motion_.step(dt);
    wanted_ = motion_.position;
    wanted_velocity_ = 0;
    record(before, dt);
}

}  // namespace mw::trajectory
