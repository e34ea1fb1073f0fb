// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/jogs.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mw::motion {

namespace {

std::size_t index(int i) noexcept {
    return static_cast<std::size_t>(i);
}

CommandResult result_of(const JogTarget &target, Reason reason) noexcept {
    return mw::motion::result_of(target.index, reason);
}

std::uint32_t bit_of(const JogTarget &target) noexcept {
    static_assert(MAX_JOINTS + MAX_AXES <= 32);
    return 1U << (target.isJoint ? target.index : MAX_JOINTS + target.index);
}

JogTarget target_of_bit(int bit) noexcept {
    return {bit < MAX_JOINTS, bit < MAX_JOINTS ? bit : bit - MAX_JOINTS};
}

Reason check_lease(const JogContinuous &command) noexcept {
    const bool isNone = command.lease_s == 0.0 && !command.isRenewal;
    const bool isInRange = command.lease_s >= SHORTEST_JOG_LEASE_S && command.lease_s <= LONGEST_JOG_LEASE_S;
    return isNone || isInRange ? Reason::NONE : Reason::OUT_OF_RANGE;
}

}  // namespace

Reason Jogs::start(const JogTarget &target, const JogMove &move, const JogSituation &s) noexcept {
    const Reason reason = at(target).start(move, s);
    if (reason == Reason::NONE) {
        leased_ &= ~bit_of(target);
        teleop_stopped_ = teleop_stopped_ && target.isJoint;
        override_used_ = override_used_ || limits_overridden_;
    }
    return reason;
}

/// Jogs to the end of the range.
Reason Jogs::start_continuous(const JogTarget &target, double velocity, const JogSituation &s) noexcept {
    const double end = velocity > 0 ? s.range.high : s.range.low;
    return start(target, {end, velocity, JogSource::KEYBOARD}, s);
}

void Jogs::begin_lease(const JogContinuous &command, std::int64_t time_ns) noexcept {
    at(command.target).begin_lease(command.lease_s, command.velocity > 0, time_ns);
    leased_ |= bit_of(command.target);
}

bool Jogs::isRenewable(const JogContinuous &command) const noexcept {
    const bool isLive = command.lease_s > 0 && (leased_ & bit_of(command.target)) != 0;
    return isLive && at(command.target).lease().isForward == (command.velocity > 0);
}

Reason Jogs::start_leased(const JogContinuous &command, const JogSituation &s) noexcept {
    const double here = at(command.target).motion().position;
    const bool isAtEnd = command.velocity > 0 ? here >= s.range.high : here <= s.range.low;
    if (isAtEnd) {
        return Reason::BEYOND_SOFT_LIMIT;
    }
    const Reason reason = start_continuous(command.target, command.velocity, s);
    if (reason == Reason::NONE && command.lease_s > 0) {
        begin_lease(command, s.time_ns);
    }
    return reason;
}

CommandResult Jogs::start_to(const JogTarget &target, double position, double velocity,
                             const JogSituation &s) noexcept {
    return result_of(target, velocity > 0 ? start(target, {position, velocity, JogSource::KEYBOARD}, s)
                                          : Reason::OUT_OF_RANGE);
}

bool Jogs::hasTarget(const JogTarget &target) const noexcept {
    return target.index >= 0 && target.index < (target.isJoint ? num_joints_ : MAX_AXES);
}

Reason Jogs::check(const JogTarget &target, double direction, const JogSituation &s) const noexcept {
    if (!hasTarget(target)) {
        return target.isJoint ? Reason::NO_SUCH_JOINT : Reason::NO_SUCH_AXIS;
    }
    if (!s.isReady) {
        return Reason::NOT_ENABLED;
    }
    if (s.mode != (target.isJoint ? Mode::FREE : Mode::TELEOP)) {
        return Reason::WRONG_MODE;
    }
    if (s.isHoming) {
        return Reason::HOMING;
    }
    if (s.isInhibited) {
        return Reason::JOG_INHIBITED;
    }
    if (!s.isMovable) {
        return target.isJoint ? Reason::JOINT_INACTIVE : Reason::NO_SUCH_AXIS;
    }
    if (s.isDriven) {
        return Reason::DRIVEN_BY_PIN;
    }
    if (s.isBesideIndexer) {
        return Reason::INDEXER_ALONE;
    }
    if (s.isSynchronised) {
        return Reason::SYNCHRONISED_JOINT;
    }
    const bool isIntoLimit = (direction > 0 && s.isOnPosLimit) || (direction < 0 && s.isOnNegLimit);
    return isIntoLimit ? Reason::ON_HARD_LIMIT : Reason::NONE;
}

CommandResult Jogs::take(const JogContinuous &command, const JogSituation &situation) noexcept {
    Reason reason = check(command.target, command.velocity, situation);
    if (reason == Reason::NONE) {
        reason = !std::isfinite(command.velocity) ? Reason::NOT_A_NUMBER
                 : command.velocity == 0.0        ? Reason::OUT_OF_RANGE
                                                  : check_lease(command);
    }
    if (reason != Reason::NONE) {
        return result_of(command.target, reason);
    }
    if (isRenewable(command)) {
        at(command.target).renew(command.velocity, situation);
        begin_lease(command, situation.time_ns);
        return result_of(command.target, Reason::NONE);
    }
    return result_of(command.target,
                     command.isRenewal ? Reason::NO_JOG_TO_RENEW : start_leased(command, situation));
}

CommandResult Jogs::take(const JogIncremental &command, const JogSituation &situation) noexcept {
    const Reason reason = check(command.target, command.distance, situation);
    if (reason != Reason::NONE) {
        return result_of(command.target, reason);
    }
    const double position = at(command.target).motion().target + command.distance;
    return start_to(command.target, position, command.velocity, situation);
}

CommandResult Jogs::take(const JogAbsolute &command, const JogSituation &situation) noexcept {
    const bool isKnown = hasTarget(command.target);
    const double way = isKnown ? command.position - at(command.target).motion().position : 0.0;
    const Reason reason = check(command.target, way, situation);
    return reason != Reason::NONE ? result_of(command.target, reason)
                                  : start_to(command.target, command.position, command.velocity, situation);
}

CommandResult Jogs::take(const JogStop &command) noexcept {
    if (!hasTarget(command.target)) {
        return result_of(command.target,
                         command.target.isJoint ? Reason::NO_SUCH_JOINT : Reason::NO_SUCH_AXIS);
    }
    Jog &jog = at(command.target);
    leased_ &= ~bit_of(command.target);
    if (jog.source() != JogSource::NONE) {
        jog.brake();
    }
    return result_of(command.target, Reason::NONE);
}

CommandResult Jogs::take(const OverrideLimits &command) noexcept {
    limits_overridden_ = command.isOn;
    override_used_ = false;
    return {};
}

Reason Jogs::check_axis(int axis, double velocity, const JogSituation &situation) const noexcept {
    const Reason reason = velocity == 0.0 ? Reason::NONE : check({false, axis}, velocity, situation);
    return reason == Reason::NONE && !std::isfinite(velocity) ? Reason::NOT_A_NUMBER : reason;
}

CommandResult Jogs::take(const SetTeleopVector &command, const JogSituation *situations) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        const Reason reason = check_axis(i, command.velocity[i], situations[i]);
        if (reason != Reason::NONE) {
            return result_of(i, reason);
        }
    }
    int count = 0;
    int locked = -1;
    for (int i = 0; i < MAX_AXES; ++i) {
        count += command.velocity[i] != 0.0 ? 1 : 0;
        locked = command.velocity[i] != 0.0 && situations[i].isLocked ? i : locked;
    }
    if (locked >= 0 && count > 1) {
        return result_of(locked, Reason::INDEXER_ALONE);
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        const JogTarget target{false, i};
        if (command.velocity[i] == 0.0) {
            take(JogStop{target});
        } else {
            start_continuous(target, command.velocity[i], situations[i]);
        }
    }
    return {};
}

JogTarget Jogs::end_lease(std::int64_t time_ns) noexcept {
    for (std::uint32_t left = leased_; left != 0; left &= left - 1) [[unlikely]] {
        const JogTarget target = target_of_bit(std::countr_zero(left));
        Jog &jog = at(target);
        if (time_ns < jog.lease().end_ns) {
            continue;
        }
        leased_ &= ~bit_of(target);
        if (!jog.isAtRest()) {
            jog.brake();
            return target;
        }
    }
    return {true, -1};
}

void Jogs::stop() noexcept {
    leased_ = 0;
    for (int j = 0; j < num_joints_; ++j) {
        joint_[index(j)].brake();
    }
    for (Jog &jog : axis_) {
        jog.brake();
    }
}

void Jogs::stop_at_once() noexcept {
    leased_ = 0;
    for (int j = 0; j < num_joints_; ++j) {
        joint_[index(j)].stop_at_once();
    }
    for (Jog &jog : axis_) {
        jog.stop_at_once();
    }
}

void Jogs::forget_sources() noexcept {
    leased_ = 0;
    for (int j = 0; j < num_joints_; ++j) {
        joint_[index(j)].forget_source();
    }
    for (Jog &jog : axis_) {
        jog.forget_source();
    }
}

void Jogs::reset_axes(const geometry::Pose &pose) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        axis_[index(i)].reset(pose[i]);
    }
}

void Jogs::rest_at(const double *joint_positions, const geometry::Pose &pose) noexcept {
    for (int j = 0; j < num_joints_; ++j) {
        joint_[index(j)].reset(joint_positions[j]);
    }
    reset_axes(pose);
    forget_sources();
}

void Jogs::start_at(const double *joint_positions, const geometry::Pose &pose, const Inputs &in) noexcept {
    rest_at(joint_positions, pose);
    for (int j = 0; j < num_joints_; ++j) {
        joint_[index(j)].set_wheel_counts(in.joint[index(j)].wheel.counts);
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        axis_[index(i)].set_wheel_counts(in.axis_wheel[index(i)].counts);
    }
}

bool Jogs::areJointsAtRest() const noexcept {
    for (int j = 0; j < num_joints_; ++j) {
        if (!joint_[index(j)].isAtRest()) {
            return false;
        }
    }
    return true;
}

bool Jogs::areAxesAtRest() const noexcept {
    for (const Jog &jog : axis_) {
        if (!jog.isAtRest()) {
            return false;
        }
    }
    return true;
}

void Jogs::jog_by_wheel(const JogTarget &target, double distance, const WheelInput &wheel,
                        const JogSituation &situation) noexcept {
    if (check(target, distance, situation) != Reason::NONE) {
        return;
    }
    Jog &jog = at(target);
    const trajectory::AxisMotion &m = jog.motion();
    const double position = std::clamp(m.target + distance, std::min(situation.range.low, m.position),
                                       std::max(situation.range.high, m.position));
    const JogMove move{position, situation.limits.velocity, JogSource::WHEEL};
    if (start(target, move, situation) == Reason::NONE) {
        jog.reduce_acceleration(wheel.accel_fraction, situation.isShared);
    }
}

void Jogs::settle(const Inputs &in) noexcept {
    bool isAnyJog = false;
    for (int j = 0; j < num_joints_; ++j) {
        Jog &jog = joint_[index(j)];
        jog.set_wheel_counts(in.joint[index(j)].wheel.counts);
        isAnyJog = jog.update_source() || isAnyJog;
    }
    for (std::uint32_t left = axes_; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        Jog &jog = axis_[index(i)];
        jog.set_wheel_counts(in.axis_wheel[index(i)].counts);
        isAnyJog = jog.update_source() || isAnyJog;
    }
    any_jogged_ = isAnyJog;
    if (override_used_ && !isAnyJog) [[unlikely]] {
        override_used_ = false;
        limits_overridden_ = false;
    }
}

}  // namespace mw::motion
