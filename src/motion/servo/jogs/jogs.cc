// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/jogs/jogs.hh"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/duration.hh"

namespace mw::motion {

namespace {

/// Rounding of a position at the end of the range.
constexpr double RANGE_ROUNDING = 1e-9;

std::size_t at(int i) noexcept {
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

/// False once the jog has stopped.
bool isJogged(Jog &jog) noexcept {
    if (jog.source == JogSource::NONE) [[likely]] {
        return false;
    }
    if (jog.planner.isAtRest()) {
        jog.source = JogSource::NONE;
    }
    return jog.source != JogSource::NONE;
}

struct JogMove {
    double position = 0, velocity = 0;
    JogSource source = JogSource::NONE;
};

/// A stop uses the full acceleration.
void brake(Jog &jog) noexcept {
    if (jog.brake_acceleration > jog.wanted.acceleration) {
        jog.wanted.acceleration = jog.brake_acceleration;
        jog.planner.max_acceleration = jog.brake_acceleration;
    }
    jog.planner.stop();
}

/// Sets the planner of a checked jog.
Reason start(Jogs &jogs, const JogTarget &target, const JogMove &move, const JogSituation &s) noexcept {
    if (!std::isfinite(move.position) || !std::isfinite(move.velocity)) {
        return Reason::NOT_A_NUMBER;
    }
    Jog &jog = jogs.at(target);
    trajectory::AxisMotion &p = jog.planner;
    // From outside the limits a move may go back in, but not further out.
    const double low = std::min(s.range.low, p.position);
    const double high = std::max(s.range.high, p.position);
    if (move.position < low - RANGE_ROUNDING || move.position > high + RANGE_ROUNDING) {
        return Reason::BEYOND_SOFT_LIMIT;
    }
    p.target = std::clamp(move.position, low, high);
    jog.wanted = {std::min(std::abs(move.velocity), s.most.velocity), s.most.acceleration, s.most.jerk};
    if (!s.isShared) {
        p.max_velocity = jog.wanted.velocity;
        p.max_acceleration = jog.wanted.acceleration;
        p.max_jerk = jog.wanted.jerk;
    }
    jog.brake_acceleration = jog.wanted.acceleration;
    jog.most_velocity = UNBOUNDED;
    jog.source = move.source;
    jogs.leased &= ~bit_of(target);
    jogs.isTeleopStopped = jogs.isTeleopStopped && target.isJoint;
    jogs.isOverrideInJog = jogs.isOverrideInJog || jogs.areLimitsOverridden;
    return Reason::NONE;
}

/// Jogs to the end of the range.
Reason start_continuous(Jogs &jogs, const JogTarget &target, double velocity,
                        const JogSituation &s) noexcept {
    const double end = velocity > 0 ? s.range.high : s.range.low;
    return start(jogs, target, {end, velocity, JogSource::KEYBOARD}, s);
}

void begin_lease(Jogs &jogs, const JogContinuous &command, std::int64_t time_ns) noexcept {
    JogLease &lease = jogs.at(command.target).lease;
    lease.length_ns = to_ns(command.lease_s);
    lease.end_ns = time_ns + lease.length_ns;
    lease.isForward = command.velocity > 0;
    jogs.leased |= bit_of(command.target);
}

bool isRenewable(const Jogs &jogs, const JogContinuous &command) noexcept {
    const bool isLive = command.lease_s > 0 && (jogs.leased & bit_of(command.target)) != 0;
    return isLive && jogs.at(command.target).lease.isForward == (command.velocity > 0);
}

/// The jog keeps its target, so a jog that is stopped at a limit stays there.
void renew(Jogs &jogs, const JogContinuous &command, const JogSituation &s) noexcept {
    Jog &jog = jogs.at(command.target);
    trajectory::AxisMotion &p = jog.planner;
    jog.wanted.velocity = std::min(std::abs(command.velocity), s.most.velocity);
    p.target = std::clamp(p.target, std::min(s.range.low, p.position), std::max(s.range.high, p.position));
    begin_lease(jogs, command, s.time_ns);
}

Reason check_lease(const JogContinuous &command) noexcept {
    const bool isNone = command.lease_s == 0.0 && !command.isRenewal;
    const bool isInRange = command.lease_s >= SHORTEST_JOG_LEASE_S && command.lease_s <= LONGEST_JOG_LEASE_S;
    return isNone || isInRange ? Reason::NONE : Reason::OUT_OF_RANGE;
}

Reason start_leased(Jogs &jogs, const JogContinuous &command, const JogSituation &s) noexcept {
    const double here = jogs.at(command.target).planner.position;
    const bool isAtEnd = command.velocity > 0 ? here >= s.range.high : here <= s.range.low;
    if (isAtEnd) {
        return Reason::BEYOND_SOFT_LIMIT;
    }
    const Reason reason = start_continuous(jogs, command.target, command.velocity, s);
    if (reason == Reason::NONE && command.lease_s > 0) {
        begin_lease(jogs, command, s.time_ns);
    }
    return reason;
}

CommandResult start_to(Jogs &jogs, const JogTarget &target, double position, double velocity,
                       const JogSituation &s) noexcept {
    return result_of(target, velocity > 0 ? start(jogs, target, {position, velocity, JogSource::KEYBOARD}, s)
                                          : Reason::OUT_OF_RANGE);
}

}  // namespace

bool hasTarget(const Jogs &jogs, const JogTarget &target) noexcept {
    return target.index >= 0 && target.index < (target.isJoint ? jogs.num_joints : MAX_AXES);
}

Reason check(const Jogs &jogs, const JogTarget &target, double direction, const JogSituation &s) noexcept {
    if (!hasTarget(jogs, target)) {
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

CommandResult take(Jogs &jogs, const JogContinuous &command, const JogSituation &situation) noexcept {
    Reason reason = check(jogs, command.target, command.velocity, situation);
    if (reason == Reason::NONE) {
        reason = !std::isfinite(command.velocity) ? Reason::NOT_A_NUMBER
                 : command.velocity == 0.0        ? Reason::OUT_OF_RANGE
                                                  : check_lease(command);
    }
    if (reason != Reason::NONE) {
        return result_of(command.target, reason);
    }
    if (isRenewable(jogs, command)) {
        renew(jogs, command, situation);
        return result_of(command.target, Reason::NONE);
    }
    return result_of(command.target,
                     command.isRenewal ? Reason::NO_JOG_TO_RENEW : start_leased(jogs, command, situation));
}

CommandResult take(Jogs &jogs, const JogIncremental &command, const JogSituation &situation) noexcept {
    const Reason reason = check(jogs, command.target, command.distance, situation);
    if (reason != Reason::NONE) {
        return result_of(command.target, reason);
    }
    const double position = jogs.at(command.target).planner.target + command.distance;
    return start_to(jogs, command.target, position, command.velocity, situation);
}

CommandResult take(Jogs &jogs, const JogAbsolute &command, const JogSituation &situation) noexcept {
    const bool isKnown = hasTarget(jogs, command.target);
    const double way = isKnown ? command.position - jogs.at(command.target).planner.position : 0.0;
    const Reason reason = check(jogs, command.target, way, situation);
    return reason != Reason::NONE
               ? result_of(command.target, reason)
               : start_to(jogs, command.target, command.position, command.velocity, situation);
}

CommandResult take(Jogs &jogs, const JogStop &command) noexcept {
    if (!hasTarget(jogs, command.target)) {
        return result_of(command.target,
                         command.target.isJoint ? Reason::NO_SUCH_JOINT : Reason::NO_SUCH_AXIS);
    }
    Jog &jog = jogs.at(command.target);
    jogs.leased &= ~bit_of(command.target);
    if (jog.source != JogSource::NONE) {
        brake(jog);
    }
    return result_of(command.target, Reason::NONE);
}

CommandResult take(Jogs &jogs, const OverrideLimits &command) noexcept {
    jogs.areLimitsOverridden = command.isOn;
    jogs.isOverrideInJog = false;
    return {};
}

Reason check_axis_jog(const Jogs &jogs, int axis, double velocity, const JogSituation &situation) noexcept {
    const Reason reason = velocity == 0.0 ? Reason::NONE : check(jogs, {false, axis}, velocity, situation);
    return reason == Reason::NONE && !std::isfinite(velocity) ? Reason::NOT_A_NUMBER : reason;
}

void jog_axis(Jogs &jogs, int axis, double velocity, const JogSituation &situation) noexcept {
    const JogTarget target{false, axis};
    if (velocity == 0.0) {
        take(jogs, JogStop{target});
    } else {
        start_continuous(jogs, target, velocity, situation);
    }
}

CommandResult take(Jogs &jogs, const SetTeleopVector &command, const JogSituation *situations) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        const Reason reason = check_axis_jog(jogs, i, command.velocity[i], situations[i]);
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
        jog_axis(jogs, i, command.velocity[i], situations[i]);
    }
    return {};
}

JogTarget end_lease(Jogs &jogs, std::int64_t time_ns) noexcept {
    for (std::uint32_t left = jogs.leased; left != 0; left &= left - 1) [[unlikely]] {
        const JogTarget target = target_of_bit(std::countr_zero(left));
        Jog &jog = jogs.at(target);
        if (time_ns < jog.lease.end_ns) {
            continue;
        }
        jogs.leased &= ~bit_of(target);
        if (!jog.planner.isAtRest()) {
            brake(jog);
            return target;
        }
    }
    return {true, -1};
}

void keep_within(Jog &jog, const JogRange &range) noexcept {
    trajectory::AxisMotion &p = jog.planner;
    if (p.isAtRest()) {
        return;
    }
    const bool isLeaving = (p.position > range.high && p.target > p.position) ||
                           (p.position < range.low && p.target < p.position);
    if (isLeaving) {
        brake(jog);
    } else {
        p.target = std::clamp(p.target, std::min(range.low, p.position), std::max(range.high, p.position));
    }
}

void stop(Jogs &jogs) noexcept {
    jogs.leased = 0;
    for (int j = 0; j < jogs.num_joints; ++j) {
        brake(jogs.joint[at(j)]);
    }
    for (Jog &jog : jogs.axis) {
        brake(jog);
    }
}

void stop_at_once(Jogs &jogs) noexcept {
    jogs.leased = 0;
    for (int j = 0; j < jogs.num_joints; ++j) {
        trajectory::AxisMotion &p = jogs.joint[at(j)].planner;
        p.reset(p.position);
    }
    for (Jog &jog : jogs.axis) {
        jog.planner.reset(jog.planner.position);
    }
}

void forget_sources(Jogs &jogs) noexcept {
    jogs.leased = 0;
    for (int j = 0; j < jogs.num_joints; ++j) {
        jogs.joint[at(j)].source = JogSource::NONE;
    }
    for (Jog &jog : jogs.axis) {
        jog.source = JogSource::NONE;
    }
}

void reset_axes(Jogs &jogs, const geometry::Pose &pose) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        jogs.axis[at(i)].planner.reset(pose[i]);
    }
}

void rest_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose) noexcept {
    for (int j = 0; j < jogs.num_joints; ++j) {
        jogs.joint[at(j)].planner.reset(joint_positions[j]);
    }
    reset_axes(jogs, pose);
    forget_sources(jogs);
}

void start_at(Jogs &jogs, const double *joint_positions, const geometry::Pose &pose,
              const Inputs &in) noexcept {
    rest_at(jogs, joint_positions, pose);
    for (int j = 0; j < jogs.num_joints; ++j) {
        jogs.joint[at(j)].wheel_counts = in.joint[at(j)].wheel.counts;
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        jogs.axis[at(i)].wheel_counts = in.axis_wheel[at(i)].counts;
    }
}

bool areJointsAtRest(const Jogs &jogs) noexcept {
    for (int j = 0; j < jogs.num_joints; ++j) {
        if (!jogs.joint[at(j)].planner.isAtRest()) {
            return false;
        }
    }
    return true;
}

bool areAxesAtRest(const Jogs &jogs) noexcept {
    for (const Jog &jog : jogs.axis) {
        if (!jog.planner.isAtRest()) {
            return false;
        }
    }
    return true;
}

double turned(Jog &jog, const WheelInput &wheel) noexcept {
    // Unsigned difference: counters overflow.
    const auto delta = static_cast<std::int32_t>(static_cast<std::uint32_t>(wheel.counts) -
                                                 static_cast<std::uint32_t>(jog.wheel_counts));
    const double distance = delta * wheel.scale;
    const bool isStill = !wheel.isEnabled || distance == 0.0;
    if (isStill) {
        const bool isVelocityWheel = jog.source == JogSource::WHEEL && wheel.isVelocityMode;
        if (isVelocityWheel) {
            jog.planner.stop();
        }
        return 0;
    }
    const bool isOther = jog.source == JogSource::KEYBOARD && !jog.planner.isAtRest();
    return isOther ? 0.0 : distance;
}

void jog_by_wheel(Jogs &jogs, const JogTarget &target, double distance, const WheelInput &wheel,
                  const JogSituation &situation) noexcept {
    if (check(jogs, target, distance, situation) != Reason::NONE) {
        return;
    }
    Jog &jog = jogs.at(target);
    trajectory::AxisMotion &p = jog.planner;
    const double position = std::clamp(p.target + distance, std::min(situation.range.low, p.position),
                                       std::max(situation.range.high, p.position));
    const JogMove move{position, situation.most.velocity, JogSource::WHEEL};
    if (start(jogs, target, move, situation) == Reason::NONE) {
        const bool isFraction = wheel.accel_fraction > 0 && wheel.accel_fraction <= 1;
        jog.wanted.acceleration *= isFraction ? wheel.accel_fraction : 1.0;
        if (situation.isShared) {
            // A stop keeps the limits that the joints leave to it.
            jog.brake_acceleration = jog.wanted.acceleration;
        } else {
            p.max_acceleration = jog.wanted.acceleration;
        }
    }
}

void settle(Jogs &jogs, const Inputs &in) noexcept {
    bool isAnyJog = false;
    for (int j = 0; j < jogs.num_joints; ++j) {
        Jog &jog = jogs.joint[at(j)];
        jog.wheel_counts = in.joint[at(j)].wheel.counts;
        isAnyJog = isJogged(jog) || isAnyJog;
    }
    for (std::uint32_t left = jogs.axes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        Jog &jog = jogs.axis[at(i)];
        jog.wheel_counts = in.axis_wheel[at(i)].counts;
        isAnyJog = isJogged(jog) || isAnyJog;
    }
    jogs.isAnyJogged = isAnyJog;
    if (jogs.isOverrideInJog && !isAnyJog) [[unlikely]] {
        jogs.isOverrideInJog = false;
        jogs.areLimitsOverridden = false;
    }
}

void renumber(Jog &jog, double position, double shift) noexcept {
    jog.planner.renumber(position, shift);
}

void home_joint(Jog &jog, const homing::JointCommand &command, const JogLimits &most) noexcept {
    if (command.move == homing::Move::NONE) {
        return;
    }
    trajectory::AxisMotion &p = jog.planner;
    const auto of = [](double wanted, double highest) {
        return wanted > 0 ? std::min(wanted, highest) : highest;
    };
    p.max_acceleration = of(command.acceleration, most.acceleration);
    // A stop at a switch uses the full deceleration of the joint.
    p.max_jerk = command.isSmooth && most.jerk > 0 ? of(command.jerk, most.jerk) : 0.0;
    if (command.move == homing::Move::STOP) {
        p.stop();
        return;
    }
    jog.wanted.velocity = of(command.velocity, most.velocity);
    jog.most_velocity = of(command.most_velocity, most.velocity);
    p.target = command.move == homing::Move::TO ? command.value : p.position + command.value;
}

void limit_axis(Jog &jog, double max_velocity, double scale) noexcept {
    if (!jog.planner.isAtRest()) {
        jog.planner.max_velocity = std::min(jog.wanted.velocity * scale, max_velocity);
    }
}

void step_joint(Jog &jog, double max_velocity, double scale, double period_s) noexcept {
    jog.planner.max_velocity = std::min({jog.wanted.velocity * scale, max_velocity, jog.most_velocity});
    jog.planner.step(period_s);
}

}  // namespace mw::motion
