// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/exec/retrace.hh"

#include <algorithm>
#include <cmath>

namespace mw::traj {

namespace {

/// Shares of the limits for changes of the rate; with HIGHEST_RATE their sums stay below 1.
constexpr double ACCELERATION_SHARE = 0.4, TURN_SHARE = 0.25, JERK_SHARE = 0.3;
constexpr double FASTEST_CHANGE = 50;  ///< of the rate [1/s]

}  // namespace

void Retrace::clear() noexcept {
    count_ = 0;
    standing_ = 0;
    isAway_ = false;
}

void Retrace::record(const geom::Pose &pose, const Use &use) noexcept {
    const bool isSame = count_ > 0 && pose == sample(0);
    standing_ = isSame ? standing_ + 1 : 0;
    if (standing_ > STANDING) {
        return;
    }
    const std::uint64_t slot = count_ % CAPACITY;
    Use &block = blocks_[slot / BLOCK];
    if (slot % BLOCK == 0) {
        block = {};
    }
    block.v_over_a = std::max(block.v_over_a, use.v_over_a);
    block.v_over_j = std::max(block.v_over_j, use.v_over_j);
    block.a_over_j = std::max(block.a_over_j, use.a_over_j);
    samples_[slot] = pose;
    ++count_;
}

/// Sample `back` before the newest; beyond what there is, the outermost.
const geom::Pose &Retrace::sample(std::int64_t back) const noexcept {
    const auto most = static_cast<std::int64_t>(std::min(count_, CAPACITY)) - 1;
    const auto n = static_cast<std::uint64_t>(std::clamp<std::int64_t>(back, 0, most));
    return samples_[(count_ - 1 - n) % CAPACITY];
}

/// Cubic B-spline with the samples as control points: its derivatives are means of their differences.
geom::Pose Retrace::pose_at(double samples) const noexcept {
    const double floor = std::floor(samples);
    const double f = samples - floor;
    const auto back = -static_cast<std::int64_t>(floor);
    const double g = 1.0 - f;
    const double f2 = f * f;
    const geom::Pose &mid = sample(back);
    // As a difference from one of them: little is lost to rounding.
    const auto off = [&](std::int64_t n) { return sample(n) - mid; };
    const geom::Pose sum = off(back + 1) * (g * g * g / 6.0) +
                           off(back - 1) * ((1.0 + 3.0 * f + 3.0 * f2 - 3.0 * f2 * f) / 6.0) +
                           off(back - 2) * (f2 * f / 6.0);
    return mid + sum;
}

void Retrace::start() noexcept {
    Use most;
    for (std::uint64_t i = 0; i < CAPACITY / BLOCK && i * BLOCK < count_; ++i) {
        most.v_over_a = std::max(most.v_over_a, blocks_[i].v_over_a);
        most.v_over_j = std::max(most.v_over_j, blocks_[i].v_over_j);
        most.a_over_j = std::max(most.a_over_j, blocks_[i].a_over_j);
    }
    double change = FASTEST_CHANGE;
    change = most.v_over_a > 0 ? std::min(change, ACCELERATION_SHARE / most.v_over_a) : change;
    change = most.a_over_j > 0 ? std::min(change, TURN_SHARE / (3.0 * HIGHEST_RATE * most.a_over_j)) : change;
    way_.reset(0);
    way_.max_acceleration = change;
    way_.max_jerk = most.v_over_j > 0 ? JERK_SHARE / most.v_over_j : 0.0;
    isAway_ = true;
}

geom::Pose Retrace::step(double dt, int direction, double rate) noexcept {
    if (!isAway_) {
        start();
    }
    const auto kept = static_cast<double>(std::min(count_, CAPACITY)) - 3.0;
    way_.max_velocity = std::min(rate, HIGHEST_RATE);
    if (direction == 0) {
        way_.stop();
    } else {
        way_.target = direction < 0 ? -kept * dt : 0.0;
    }
    way_.step(dt);
    if (way_.isAtRest() && way_.position == 0.0) {
        isAway_ = direction < 0;
        return sample(0);
    }
    return pose_at(way_.position / dt);
}

}  // namespace mw::traj
