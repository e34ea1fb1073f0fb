// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/follow_planner.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/follow/speed_within.hh"

namespace mw::trajectory {

void FollowPlanner::reset(double at, const FollowLimits &limits, double dt) noexcept {
    position_ = leader_ = wanted_ = at;
    velocity_ = leader_speed_ = 0;
    const bool hasJerk = limits.jerk > 0 && limits.acceleration > 0;
    const double samples = hasJerk ? std::ceil(2.0 * limits.acceleration / (limits.jerk * dt) - 1e-9) : 1.0;
    length_ = static_cast<std::uint32_t>(std::clamp(samples, 1.0, static_cast<double>(MOST_SAMPLES)));
    way_.fill(at);
    next_ = 0;
    still_ = length_;
}

/// A mean over so many samples swings its acceleration by at most twice that of the leader meanwhile.
double FollowPlanner::acceleration_of(const FollowLimits &limits, double dt) const noexcept {
    return limits.jerk > 0 ? std::min(limits.acceleration, 0.5 * limits.jerk * length_ * dt)
                           : limits.acceleration;
}

/// The leader moves at `speed`, as far as it can.
void FollowPlanner::lead(double speed, const FollowLimits &limits, double dt) noexcept {
    const double step = acceleration_of(limits, dt) * dt;
    const double most = std::clamp(speed_within(limits.high - leader_, step, dt), 0.0, limits.velocity);
    const double least = -std::clamp(speed_within(leader_ - limits.low, step, dt), 0.0, limits.velocity);
    const double kept = std::clamp(speed, least, most);
    leader_speed_ = std::clamp(kept, leader_speed_ - step, leader_speed_ + step);
    leader_ += leader_speed_ * dt;
}

void FollowPlanner::follow(double wanted, const FollowLimits &limits, double dt) noexcept {
    if (!(limits.acceleration > 0) || !(limits.velocity > 0)) {
        velocity_ = leader_speed_ = 0;
        return;
    }
    const double to = std::clamp(wanted, std::min(limits.low, leader_), std::max(limits.high, leader_));
    const double moved = (to - wanted_) / dt;
    // What moves faster than the coordinate can has stepped: it stands where it is now.
    const double its_speed = std::abs(moved) <= limits.velocity ? moved : 0.0;
    const double lag = to - its_speed * dt - leader_;
    const double step = acceleration_of(limits, dt) * dt;
    lead(its_speed + std::copysign(speed_within(std::abs(lag), step, dt), lag), limits, dt);
    constexpr double ROUNDING = 1e-9;  // of a step of acceleration
    leader_ = std::abs(leader_ - to) <= ROUNDING * step * dt ? to : leader_;
    wanted_ = to;
    take(dt);
}

void FollowPlanner::brake(const FollowLimits &limits, double dt) noexcept {
    if (limits.acceleration > 0) {
        lead(0, limits, dt);
    }
    wanted_ = leader_;
    take(dt);
}

void FollowPlanner::take(double dt) noexcept {
    way_[next_] = leader_;
    next_ = next_ + 1 >= length_ ? 0 : next_ + 1;
    double sum = 0;
    for (std::uint32_t n = 0; n < length_; ++n) {
        sum += way_[n] - leader_;
    }
    const double before = position_;
    position_ = leader_ + sum / length_;
    velocity_ = (position_ - before) / dt;
    still_ = velocity_ == 0.0 && leader_speed_ == 0.0 ? std::min(still_ + 1, length_) : 0;
}

}  // namespace mw::trajectory
