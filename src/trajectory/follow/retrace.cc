// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/retrace.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory {

namespace {

/// SHARES: part of the acceleration limit for the squared rate and the change of the rate together.
/// TURN_SHARE, JERK_SHARE: parts of the jerk limit for the terms 3 A r alpha and V j. With the cube of
/// HIGHEST_RATE, the sum for the jerk is below 1.
constexpr double SHARES = 0.96, TURN_SHARE = 0.25, JERK_SHARE = 0.3;
constexpr double FASTEST_CHANGE = 50;  ///< maximum change of the rate [1/s]
/// A position between samples depends on up to this number of samples on each side.
constexpr std::int64_t BESIDE = 4;

/// Maximum change of the rate [1/s] at a rate, for samples with this use of the limits.
double change_of_rate(const Retrace::Use &use, double rate) noexcept {
    double change = FASTEST_CHANGE;
    const double share = SHARES - rate * rate;
    change = use.v_over_a > 0 ? std::min(change, share / use.v_over_a) : change;
    return use.a_over_j > 0 ? std::min(change, TURN_SHARE / (3.0 * Retrace::HIGHEST_RATE * use.a_over_j))
                            : change;
}

}  // namespace

void Retrace::clear() noexcept {
    count_ = 0;
    standing_ = 0;
    isAway_ = false;
}

bool Retrace::record(const geometry::Pose &pose) noexcept {
    const bool isSame = count_ > 0 && pose == samples_[(count_ - 1) % CAPACITY];
    standing_ = isSame ? standing_ + 1 : 0;
    if (standing_ > STANDING) {
        return false;
    }
    const std::uint64_t slot = count_ % CAPACITY;
    if (slot % BLOCK == 0) {
        blocks_[slot / BLOCK] = {};
    }
    samples_[slot] = pose;
    ++count_;
    return count_ % BLOCK == 0;
}

void Retrace::include(const Use &use) noexcept {
    if (count_ == 0) {
        return;
    }
    Use &block = blocks_[(count_ - 1) % CAPACITY / BLOCK];
    block.v_over_a = std::max(block.v_over_a, use.v_over_a);
    block.v_over_j = std::max(block.v_over_j, use.v_over_j);
    block.a_over_j = std::max(block.a_over_j, use.a_over_j);
}

/// The sample `back` before the newest, clamped to the first and last sample.
const geometry::Pose &Retrace::sample(std::int64_t back) const noexcept {
    const auto most = static_cast<std::int64_t>(std::min(count_, CAPACITY)) - 1;
    const auto n = static_cast<std::uint64_t>(std::clamp<std::int64_t>(back, 0, most));
    return samples_[(count_ - 1 - n) % CAPACITY];
}

/// Cubic B-spline with the samples as control points. Its derivatives are averages of the differences of
/// samples.
geometry::Pose Retrace::pose_at(double samples) const noexcept {
    const double floor = std::floor(samples);
    const double f = samples - floor;
    const auto back = -static_cast<std::int64_t>(floor);
    const double g = 1.0 - f;
    const double f2 = f * f;
    const geometry::Pose &mid = sample(back);
    // Differences to one sample reduce the rounding error.
    const auto off = [&](std::int64_t n) { return sample(n) - mid; };
    const geometry::Pose sum = off(back + 1) * (g * g * g / 6.0) +
                               off(back - 1) * ((1.0 + 3.0 * f + 3.0 * f2 - 3.0 * f2 * f) / 6.0) +
                               off(back - 2) * (f2 * f / 6.0);
    return mid + sum;
}

/// Maximum use of the limits of the samples from `newest` to `oldest` before the newest one, and of adjacent
/// samples.
Retrace::Use Retrace::most_between(std::int64_t newest, std::int64_t oldest) const noexcept {
    const auto kept = static_cast<std::int64_t>(std::min(count_, CAPACITY)) - 1;
    const auto last = static_cast<std::int64_t>(count_) - 1;
    constexpr auto block = static_cast<std::int64_t>(BLOCK);
    const std::int64_t first_block = (last - std::clamp<std::int64_t>(oldest + BESIDE, 0, kept)) / block;
    const std::int64_t last_block = (last - std::clamp<std::int64_t>(newest - BESIDE, 0, kept)) / block;
    Use most;
    for (std::int64_t n = first_block; n <= last_block; ++n) {
        const Use &use = blocks_[static_cast<std::uint64_t>(n) % (CAPACITY / BLOCK)];
        most.v_over_a = std::max(most.v_over_a, use.v_over_a);
        most.v_over_j = std::max(most.v_over_j, use.v_over_j);
        most.a_over_j = std::max(most.a_over_j, use.a_over_j);
    }
    return most;
}

void Retrace::start() noexcept {
    const Use most = most_between(0, CAPACITY);
    way_.reset(0);
    change_ = change_of_rate(most, HIGHEST_RATE);
    way_.max_acceleration = change_;
    way_.max_jerk = most.v_over_j > 0 ? JERK_SHARE / most.v_over_j : 0.0;
    isAway_ = true;
}

/// Brakes with the limits of the samples that the stop passes. They may allow more than the fastest sample of
/// all.
void Retrace::stop(double dt) noexcept {
    if (way_.isAtRest()) {
        return;
    }
    way_.max_acceleration = change_;
    double newest = way_.position;
    double oldest = way_.position;
    way_.add_reach(oldest, newest);
    const Use use =
        most_between(static_cast<std::int64_t>(-newest / dt), static_cast<std::int64_t>(-oldest / dt));
    const double rate = std::min(HIGHEST_RATE, std::abs(way_.velocity));
    way_.max_acceleration = change_of_rate(use, rate);
    way_.stop();
}

geometry::Pose Retrace::step(double dt, int direction, double rate) noexcept {
    if (!isAway_) {
        start();
    }
    const auto kept = static_cast<double>(std::min(count_, CAPACITY)) - 3.0;
    way_.max_velocity = std::min(rate, HIGHEST_RATE);
    if (direction == 0) {
        stop(dt);
    } else {
        way_.max_acceleration = change_;
        way_.target = direction < 0 ? -kept * dt : 0.0;
    }
    way_.step(dt);
    if (way_.isAtRest() && way_.position == 0.0) {
        isAway_ = direction < 0;
        return sample(0);
    }
    return pose_at(way_.position / dt);
}

}  // namespace mw::trajectory
