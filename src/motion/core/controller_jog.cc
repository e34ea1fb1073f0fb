// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of joints (free mode) and axes (teleop mode), by command and by hand wheel; homing's start.
#include <algorithm>
#include <cmath>

#include "motion/core/controller.hh"

namespace mw::motion {

traj::JogPlanner &Controller::planner_of(const JogTarget &target) noexcept {
    return target.isJoint ? joint(target.index).free : axes_[at(target.index)].teleop;
}

Controller::JogSource &Controller::source_of(const JogTarget &target) noexcept {
    return target.isJoint ? joint(target.index).jog : axes_[at(target.index)].jog;
}

JogRange Controller::range_of(const JogTarget &target) const noexcept {
    std::array<double, MAX_JOINTS> positions{};
    for (int j = 0; j < config_.num_joints; ++j) {
        positions[at(j)] = joint(j).pos_cmd;
    }
    return jog_range(limits_, map_, target, positions.data());
}

/// Whether a jog may start at all; `direction` > 0, < 0, or 0 when not yet known.
Reason Controller::check_jog(const Inputs &in, const JogTarget &target, double direction) const noexcept {
    const int count = target.isJoint ? config_.num_joints : MAX_AXES;
    if (target.index < 0 || target.index >= count) {
        return target.isJoint ? Reason::NO_SUCH_JOINT : Reason::NO_SUCH_AXIS;
    }
    if (!isEnabled_ || stop_ != Stop::NONE) {
        return Reason::NOT_ENABLED;
    }
    if (mode_ != (target.isJoint ? Mode::FREE : Mode::TELEOP)) {
        return Reason::WRONG_MODE;
    }
    if (isHomingUnderWay()) {
        return Reason::HOMING;
    }
    if (in.isJogInhibited || in.isJogStopped || in.isJogStoppedNow) {
        return Reason::JOG_INHIBITED;
    }
    if (!target.isJoint) {
        return map_.hasAxis(target.index) ? Reason::NONE : Reason::NO_SUCH_AXIS;
    }
    const JointState &s = joint(target.index);
    if (!s.isActive) {
        return Reason::JOINT_INACTIVE;
    }
    const double sequence = get(Parameter::JOINT_HOME_SEQUENCE, target.index);
    if (sequence < 0 && sequence > -100) {
        return Reason::SYNCHRONISED_JOINT;
    }
    const bool isIntoLimit = (direction > 0 && s.isOnPosHardLimit) || (direction < 0 && s.isOnNegHardLimit);
    return isIntoLimit ? Reason::ON_HARD_LIMIT : Reason::NONE;
}

/// Sets the planner of a jog that has been checked.
Reason Controller::jog_to(const JogTarget &target, double position, double velocity,
                          JogSource source) noexcept {
    if (!std::isfinite(position) || !std::isfinite(velocity)) {
        return Reason::NOT_A_NUMBER;
    }
    const JogRange range = range_of(target);
    const JogLimits &most = limits_.jog(target);
    traj::JogPlanner &p = planner_of(target);
    // From outside the limits every move back in is welcome, none further out.
    const double low = std::min(range.low, p.position);
    const double high = std::max(range.high, p.position);
    if (position < low - 1e-9 || position > high + 1e-9) {
        return Reason::BEYOND_SOFT_LIMIT;
    }
    p.target = std::clamp(position, low, high);
    p.max_velocity = std::min(std::abs(velocity), most.velocity);
    p.max_acceleration = most.acceleration;
    p.max_jerk = most.jerk;
    if (target.isJoint) {
        joint(target.index).wanted_velocity = p.max_velocity;
    } else {
        axes_[at(target.index)].wanted_velocity = p.max_velocity;
        axes_[at(target.index)].wanted_acceleration = p.max_acceleration;
        isTeleopStopped_ = false;
    }
    source_of(target) = source;
    isOverrideInJog_ = isOverrideInJog_ || isOverridingLimits_;
    return Reason::NONE;
}

Reason Controller::handle_jog(const Inputs &in, const CommandBody &body, std::int16_t &index,
                              bool &isTaken) noexcept {
    if (const auto *c = std::get_if<JogContinuous>(&body)) {
        index = static_cast<std::int16_t>(c->target.index);
        const Reason reason = check_jog(in, c->target, c->velocity);
        if (reason != Reason::NONE) {
            return reason;
        }
        if (!std::isfinite(c->velocity)) {
            return Reason::NOT_A_NUMBER;
        }
        const JogRange range = range_of(c->target);
        const double end = c->velocity > 0 ? range.high : range.low;
        const double here = planner_of(c->target).position;
        const bool isAtEnd = c->velocity > 0 ? here >= end : here <= end;
        return isAtEnd ? Reason::BEYOND_SOFT_LIMIT : jog_to(c->target, end, c->velocity, JogSource::KEYBOARD);
    }
    if (const auto *c = std::get_if<JogIncremental>(&body)) {
        index = static_cast<std::int16_t>(c->target.index);
        const Reason reason = check_jog(in, c->target, c->distance);
        if (reason != Reason::NONE) {
            return reason;
        }
        const double target = planner_of(c->target).target + c->distance;
        return c->velocity > 0 ? jog_to(c->target, target, c->velocity, JogSource::KEYBOARD)
                               : Reason::OUT_OF_RANGE;
    }
    if (const auto *c = std::get_if<JogAbsolute>(&body)) {
        index = static_cast<std::int16_t>(c->target.index);
        Reason reason = check_jog(in, c->target, 0);
        if (reason == Reason::NONE) {
            reason = check_jog(in, c->target, c->position - planner_of(c->target).position);
        }
        if (reason != Reason::NONE) {
            return reason;
        }
        return c->velocity > 0 ? jog_to(c->target, c->position, c->velocity, JogSource::KEYBOARD)
                               : Reason::OUT_OF_RANGE;
    }
    if (const auto *c = std::get_if<JogStop>(&body)) {
        index = static_cast<std::int16_t>(c->target.index);
        const int count = c->target.isJoint ? config_.num_joints : MAX_AXES;
        if (c->target.index < 0 || c->target.index >= count) {
            return c->target.isJoint ? Reason::NO_SUCH_JOINT : Reason::NO_SUCH_AXIS;
        }
        if (source_of(c->target) != JogSource::NONE) {
            planner_of(c->target).stop();
        }
        return Reason::NONE;
    }
    isTaken = false;
    return Reason::NONE;
}

Reason Controller::handle_homing(const Inputs &in, const CommandBody &body, std::int16_t &index,
                                 bool &isTaken) noexcept {
    if (const auto *c = std::get_if<Home>(&body)) {
        index = static_cast<std::int16_t>(c->joint);
        return home(in, c->joint);
    }
    if (const auto *c = std::get_if<Unhome>(&body)) {
        index = static_cast<std::int16_t>(c->joint);
        return unhome(c->joint);
    }
    if (const auto *c = std::get_if<SetTeleopVector>(&body)) {
        return jog_vector(in, c->velocity, index);
    }
    isTaken = false;
    return Reason::NONE;
}

/// Every axis at its own speed, those at 0 stop.
Reason Controller::jog_vector(const Inputs &in, const geom::Pose &velocity, std::int16_t &index) noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        const JogTarget target{false, i};
        const double v = velocity[i];
        const bool isUsed = v != 0.0;
        const Reason reason = isUsed ? check_jog(in, target, v) : Reason::NONE;
        const JogRange range = range_of(target);
        const Reason moved = isUsed && reason == Reason::NONE
                                 ? jog_to(target, v > 0 ? range.high : range.low, v, JogSource::KEYBOARD)
                                 : reason;
        if (moved != Reason::NONE) {
            index = static_cast<std::int16_t>(i);
            return moved;
        }
        if (!isUsed && source_of(target) != JogSource::NONE) {
            planner_of(target).stop();
        }
    }
    return Reason::NONE;
}

Reason Controller::home(const Inputs &in, int j) noexcept {
    if (j < -1 || j >= config_.num_joints) {
        return Reason::NO_SUCH_JOINT;
    }
    if (!isEnabled_ || stop_ != Stop::NONE) {
        return Reason::NOT_ENABLED;
    }
    if (mode_ != Mode::FREE) {
        return Reason::WRONG_MODE;
    }
    if (isHomingUnderWay()) {
        return Reason::HOMING;
    }
    if (in.isHomingInhibited) {
        return Reason::HOMING_INHIBITED;
    }
    // Whatever is jogged comes to rest first.
    stop_jogs(false);
    isHomeDue_ = true;
    home_due_ = j;
    return Reason::NONE;
}

Reason Controller::unhome(int j) noexcept {
    if (j < -2 || j >= config_.num_joints) {
        return Reason::NO_SUCH_JOINT;
    }
    if (isHomingUnderWay()) {
        return Reason::HOMING;
    }
    if (isAnythingMoving()) {
        return Reason::MOVING;
    }
    for (int k = 0; k < config_.num_joints; ++k) {
        const bool isVolatile = j == -2 && settings_.isSet(Parameter::JOINT_VOLATILE_HOME, k);
        if (j == -1 || j == k || isVolatile) {
            homing_.unhome(k);
        }
    }
    publish_limits();
    return Reason::NONE;
}

/// Every jog brakes; at once: stands in this cycle, whatever that asks of the drives.
void Controller::stop_jogs(bool isAtOnce) noexcept {
    for (int j = 0; j < config_.num_joints; ++j) {
        traj::JogPlanner &p = joint(j).free;
        if (isAtOnce) {
            p.reset(p.position);
        } else {
            p.stop();
        }
    }
    for (AxisState &axis : axes_) {
        if (isAtOnce) {
            axis.teleop.reset(axis.teleop.position);
        } else {
            axis.teleop.stop();
        }
    }
}

void Controller::step_wheel(const Inputs &in, const JogTarget &target, const WheelInput &wheel,
                            std::int32_t &counts) noexcept {
    // Unsigned difference: counters wrap.
    const auto delta = static_cast<std::int32_t>(static_cast<std::uint32_t>(wheel.counts) -
                                                 static_cast<std::uint32_t>(counts));
    counts = wheel.counts;
    const double distance = delta * wheel.scale;
    traj::JogPlanner &p = planner_of(target);
    const bool isStill = !wheel.isEnabled || distance == 0.0;
    if (isStill) {
        const bool isVelocityWheel = source_of(target) == JogSource::WHEEL && wheel.isVelocityMode;
        if (isVelocityWheel) {
            p.stop();
        }
        return;
    }
    const bool isOther = source_of(target) == JogSource::KEYBOARD && !p.isAtRest();
    if (isOther || check_jog(in, target, distance) != Reason::NONE) {
        return;  // a wheel asks for nothing: there is no command to refuse
    }
    const JogRange range = range_of(target);
    const double wanted =
        std::clamp(p.target + distance, std::min(range.low, p.position), std::max(range.high, p.position));
    if (jog_to(target, wanted, limits_.jog(target).velocity, JogSource::WHEEL) == Reason::NONE) {
        const bool isFraction = wheel.accel_fraction > 0 && wheel.accel_fraction <= 1;
        p.max_acceleration *= isFraction ? wheel.accel_fraction : 1.0;
        if (!target.isJoint) {
            axes_[at(target.index)].wanted_acceleration = p.max_acceleration;
        }
    }
}

void Controller::step_wheels(const Inputs &in) noexcept {
    if (in.isJogStoppedNow) {
        stop_jogs(true);
    } else if (in.isJogStopped && !homing_.isActive()) {
        stop_jogs(false);
    }
    bool isAnyJog = false;
    for (int j = 0; j < config_.num_joints; ++j) {
        const JogTarget target{true, j};
        const WheelInput &wheel = in.joint[at(j)].wheel;
        if (mode_ == Mode::FREE) {
            step_wheel(in, target, wheel, joint(j).wheel_counts);
        }
        joint(j).wheel_counts = wheel.counts;
        joint(j).jog = joint(j).free.isAtRest() ? JogSource::NONE : joint(j).jog;
        isAnyJog = isAnyJog || joint(j).jog != JogSource::NONE;
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        const JogTarget target{false, i};
        const WheelInput &wheel = in.axis_wheel[at(i)];
        AxisState &axis = axes_[at(i)];
        if (mode_ == Mode::TELEOP) {
            step_wheel(in, target, wheel, axis.wheel_counts);
        }
        axis.wheel_counts = wheel.counts;
        axis.jog = axis.teleop.isAtRest() ? JogSource::NONE : axis.jog;
        isAnyJog = isAnyJog || axis.jog != JogSource::NONE;
    }
    if (isOverrideInJog_ && !isAnyJog) {
        isOverrideInJog_ = false;
        isOverridingLimits_ = false;
    }
}

}  // namespace mw::motion
