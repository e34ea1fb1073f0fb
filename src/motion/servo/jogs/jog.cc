// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/jog.hh"

#include <algorithm>
#include <cmath>

#include "base/duration.hh"

namespace mw::motion {
namespace {

/// Rounding of a position at the end of the range.
constexpr double RANGE_ROUNDING = 1e-9;

}  // namespace

Reason Jog::start(const JogMove &move, const JogSituation &s) noexcept {
    if (!std::isfinite(move.position) || !std::isfinite(move.velocity)) {
        return Reason::NOT_A_NUMBER;
    }
    // From outside the limits a move may go back, but not further out.
    const double low = std::min(s.range.low, motion_.position);
    const double high = std::max(s.range.high, motion_.position);
    if (move.position < low - RANGE_ROUNDING || move.position > high + RANGE_ROUNDING) {
        return Reason::BEYOND_SOFT_LIMIT;
    }
    motion_.target = std::clamp(move.position, low, high);
    wanted_ = {std::min(std::abs(move.velocity), s.limits.velocity), s.limits.acceleration, s.limits.jerk};
    if (!s.isShared) {
        set_limits(wanted_);
    }
    brake_acceleration_ = wanted_.acceleration;
    max_velocity_ = UNBOUNDED;
    source_ = move.source;
    return Reason::NONE;
}

void Jog::renew(double velocity, const JogSituation &s) noexcept {
    wanted_.velocity = std::min(std::abs(velocity), s.limits.velocity);
    motion_.target = std::clamp(motion_.target, std::min(s.range.low, motion_.position),
                                std::max(s.range.high, motion_.position));
}

void Jog::begin_lease(double lease_s, bool isForward, std::int64_t time_ns) noexcept {
    lease_.length_ns = to_ns(lease_s);
    lease_.end_ns = time_ns + lease_.length_ns;
    lease_.isForward = isForward;
}

bool Jog::update_source() noexcept {
    if (source_ == JogSource::NONE) [[likely]] {
        return false;
    }
    if (motion_.isAtRest()) {
        source_ = JogSource::NONE;
    }
    return source_ != JogSource::NONE;
}

double Jog::turned(const WheelInput &wheel) noexcept {
    // Unsigned difference: counters overflow.
    const auto delta = static_cast<std::int32_t>(static_cast<std::uint32_t>(wheel.counts) -
                                                 static_cast<std::uint32_t>(wheel_counts_));
    const double distance = delta * wheel.scale;
    const bool isStill = !wheel.isEnabled || distance == 0.0;
    if (isStill) {
        const bool isVelocityWheel = source_ == JogSource::WHEEL && wheel.isVelocityMode;
        if (isVelocityWheel) {
            motion_.stop();
        }
        return 0;
    }
    const bool isOther = source_ == JogSource::KEYBOARD && !motion_.isAtRest();
    return isOther ? 0.0 : distance;
}

void Jog::reduce_acceleration(double fraction, bool isShared) noexcept {
    const bool isFraction = fraction > 0 && fraction <= 1;
    wanted_.acceleration *= isFraction ? fraction : 1.0;
    if (isShared) {
        // A stop uses the limits that the joints permit.
        brake_acceleration_ = wanted_.acceleration;
    } else {
        motion_.max_acceleration = wanted_.acceleration;
    }
}

void Jog::brake() noexcept {
    if (brake_acceleration_ > wanted_.acceleration) {
        wanted_.acceleration = brake_acceleration_;
        motion_.max_acceleration = brake_acceleration_;
    }
    motion_.stop();
}

void Jog::keep_within(const JogRange &range) noexcept {
    trajectory::AxisMotion &m = motion_;
    if (m.isAtRest()) {
        return;
    }
    const bool isLeaving = (m.position > range.high && m.target > m.position) ||
                           (m.position < range.low && m.target < m.position);
    if (isLeaving) {
        brake();
    } else {
        m.target = std::clamp(m.target, std::min(range.low, m.position), std::max(range.high, m.position));
    }
}

void Jog::home(const homing::JointCommand &command, const MotionLimits &limits) noexcept {
    if (command.move == homing::Move::NONE) {
        return;
    }
    const auto within = [](double value, double limit) { return value > 0 ? std::min(value, limit) : limit; };
    motion_.max_acceleration = within(command.acceleration, limits.acceleration);
    // A stop at a switch uses the full deceleration of the joint.
    motion_.max_jerk = command.isSmooth && limits.jerk > 0 ? within(command.jerk, limits.jerk) : 0.0;
    if (command.move == homing::Move::STOP) {
        motion_.stop();
        return;
    }
    wanted_.velocity = within(command.velocity, limits.velocity);
    max_velocity_ = within(command.most_velocity, limits.velocity);
    motion_.target = command.move == homing::Move::TO ? command.value : motion_.position + command.value;
}

void Jog::limit(double max_velocity, double scale) noexcept {
    if (!motion_.isAtRest()) {
        motion_.max_velocity = std::min(wanted_.velocity * scale, max_velocity);
    }
}

void Jog::set_limits(const MotionLimits &limits) noexcept {
    motion_.max_velocity = limits.velocity;
    motion_.max_acceleration = limits.acceleration;
    motion_.max_jerk = limits.jerk;
}

void Jog::step_joint(double max_velocity, double scale, double period_s) noexcept {
    motion_.max_velocity = std::min({wanted_.velocity * scale, max_velocity, max_velocity_});
    motion_.step(period_s);
}

}  // namespace mw::motion
