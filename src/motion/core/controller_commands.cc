// SPDX-License-Identifier: GPL-2.0-or-later
// Immediate commands: each is answered, done or refused with a reason.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "motion/core/controller.hh"

namespace mw::motion {

void Controller::handle_commands(const Inputs &in) noexcept {
    for (int n = 0; n < MAX_COMMANDS_PER_CYCLE; ++n) {
        const bool isRoom = channels_.servo_answers.size() < channels_.servo_answers.capacity();
        const Command *c = isRoom ? channels_.immediate.front() : nullptr;
        if (c == nullptr) {
            return;
        }
        std::int16_t index = -1;
        // Epochs are compared across their wrap.
        const bool isStale = static_cast<std::int32_t>(c->epoch - epoch_) < 0;
        const bool isAbort = std::holds_alternative<Abort>(c->body);
        if (isStale && !isAbort) {
            answer(c->id, AnswerKind::STALE, Reason::NONE, -1);
        } else {
            const Reason reason = handle(in, *c, index);
            answer(c->id, reason == Reason::NONE ? AnswerKind::DONE : AnswerKind::REFUSED, reason, index);
        }
        channels_.immediate.drop();
    }
}

Reason Controller::handle(const Inputs &in, const Command &c, std::int16_t &index) noexcept {
    bool isTaken = true;
    Reason reason = handle_state(in, c.body, index, isTaken);
    if (!isTaken) {
        isTaken = true;
        reason = handle_flow(c.body, isTaken);
    }
    if (!isTaken) {
        isTaken = true;
        reason = handle_jog(in, c.body, index, isTaken);
    }
    if (!isTaken) {
        isTaken = true;
        reason = handle_homing(in, c.body, index, isTaken);
    }
    if (!isTaken) {
        isTaken = true;
        reason = handle_spindle(c.body, isTaken);
    }
    if (!isTaken) {
        isTaken = true;
        reason = handle_outputs(c.body, isTaken);
    }
    return isTaken ? reason : Reason::NOT_SUPPORTED;
}

Reason Controller::handle_state(const Inputs &in, const CommandBody &body, std::int16_t &index,
                                bool &isTaken) noexcept {
    if (const auto *c = std::get_if<Abort>(&body)) {
        if (static_cast<std::int32_t>(c->new_epoch - epoch_) > 0) {
            epoch_ = c->new_epoch;
        }
        abort_all();
        return Reason::NONE;
    }
    if (std::holds_alternative<Enable>(body)) {
        return enable(in, index);
    }
    if (std::holds_alternative<Disable>(body)) {
        disable();
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetMode>(&body)) {
        return set_mode(c->mode);
    }
    if (const auto *c = std::get_if<SetAmplifier>(&body)) {
        index = static_cast<std::int16_t>(c->joint);
        if (c->joint < 0 || c->joint >= config_.num_joints) {
            return Reason::NO_SUCH_JOINT;
        }
        if (c->isOn && !isEnabled_) {
            return Reason::NOT_ENABLED;
        }
        joint(c->joint).isAmpWanted = c->isOn;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetJointActive>(&body)) {
        index = static_cast<std::int16_t>(c->joint);
        if (c->joint < 0 || c->joint >= config_.num_joints) {
            return Reason::NO_SUCH_JOINT;
        }
        if (isAnythingMoving()) {
            return Reason::MOVING;
        }
        joint(c->joint).isActive = c->isActive;  // its amplifier stays as it is
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<OverrideLimits>(&body)) {
        isOverridingLimits_ = c->isOn;
        isOverrideInJog_ = false;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetWatchdog>(&body)) {
        if (!(c->timeout_s > 0)) {
            return Reason::OUT_OF_RANGE;
        }
        isWatchdogOn_ = c->isOn;
        watchdog_timeout_s_ = c->timeout_s;
        watchdog_s_ = 0;
        return Reason::NONE;
    }
    if (std::holds_alternative<Heartbeat>(body)) {
        watchdog_s_ = 0;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetParameter>(&body)) {
        return set_parameter(*c, index);
    }
    isTaken = false;
    return Reason::NONE;
}

Reason Controller::enable(const Inputs &in, std::int16_t &index) noexcept {
    if (!in.isEnableOn) {
        return Reason::EXTERNAL_ENABLE_OFF;
    }
    if (isEnabled_) {
        return stop_ == Stop::NONE ? Reason::NONE : Reason::MOVING;
    }
    for (int j = 0; j < config_.num_joints; ++j) {
        const JointInputs &pins = in.joint[at(j)];
        index = static_cast<std::int16_t>(j);
        if (joint(j).isActive && pins.isAmpFaulted) {
            return Reason::AMP_FAULT;
        }
        const bool isOnLimit = (pins.isPosLimitClosed || pins.isNegLimitClosed) && !isOverridingLimits_;
        if (joint(j).isActive && isOnLimit) {
            return Reason::ON_HARD_LIMIT;
        }
    }
    index = -1;
    isEnabled_ = true;
    isCoordError_ = false;
    ++enables_;
    for (int j = 0; j < config_.num_joints; ++j) {
        JointState &s = joint(j);
        s.isAmpWanted = s.isActive;
        s.isFaulted = false;
        s.isFerrorTripped = false;
        s.pos_cmd = s.pos_fb;
        s.free.reset(s.pos_fb);
        s.wheel_counts = in.joint[at(j)].wheel.counts;
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        axes_[at(i)].wheel_counts = in.axis_wheel[at(i)].counts;
        axes_[at(i)].teleop.reset(carte_pos_cmd_[i]);
    }
    executor_.drop();
    executor_.set_position(carte_pos_cmd_);
    link_.retrace.clear();
    return Reason::NONE;
}

/// Modes change only at rest; Cartesian ones need a known pose.
Reason Controller::set_mode(Mode mode) noexcept {
    if (mode == mode_) {
        return Reason::NONE;
    }
    if (isHomingUnderWay()) {
        return Reason::HOMING;
    }
    if (isAnythingMoving()) {
        return Reason::MOVING;
    }
    const bool needsHome = mode != Mode::FREE && kinematics_.kind() != kins::Kind::IDENTITY;
    if (needsHome && !homing_.isAllHomed()) {
        return Reason::NOT_HOMED;
    }
    executor_.drop();
    executor_.hold(false);
    executor_.set_position(carte_pos_cmd_);
    link_.retrace.clear();
    for (int j = 0; j < config_.num_joints; ++j) {
        joint(j).free.reset(joint(j).pos_cmd);
        joint(j).jog = JogSource::NONE;
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        axes_[at(i)].teleop.reset(carte_pos_cmd_[i]);
        axes_[at(i)].jog = JogSource::NONE;
    }
    isPaused_ = false;
    isStepping_ = false;
    isReverse_ = false;
    mode_ = mode;
    return Reason::NONE;
}

Reason Controller::set_parameter(const SetParameter &c, std::int16_t &index) noexcept {
    index = c.index;
    if (homing_.isActive()) {
        return Reason::HOMING;
    }
    const Reason reason = settings_.set(c, config_.num_joints, config_.num_spindles);
    if (reason != Reason::NONE) {
        return reason;
    }
    const ParameterScope scope = PARAMETERS[c.parameter].scope;
    if (scope == ParameterScope::JOINT) {
        const int j = c.index;
        homing::Parameters &p = homing_.parameters(j);
        p.search_vel = get(Parameter::JOINT_HOME_SEARCH_VEL, j);
        p.latch_vel = get(Parameter::JOINT_HOME_LATCH_VEL, j);
        p.final_vel = get(Parameter::JOINT_HOME_FINAL_VEL, j);
        p.home = get(Parameter::JOINT_HOME, j);
        p.offset = get(Parameter::JOINT_HOME_OFFSET, j);
        p.isUsingIndex = settings_.isSet(Parameter::JOINT_HOME_USE_INDEX, j);
        p.isIndexWithoutReset = settings_.isSet(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, j);
        p.isSharedSwitch = settings_.isSet(Parameter::JOINT_HOME_IS_SHARED, j);
        p.isIgnoringLimits = settings_.isSet(Parameter::JOINT_HOME_IGNORE_LIMITS, j);
        p.absolute_encoder = static_cast<int>(get(Parameter::JOINT_HOME_ABSOLUTE_ENCODER, j));
        p.sequence = static_cast<int>(get(Parameter::JOINT_HOME_SEQUENCE, j));
        const double range = get(Parameter::JOINT_MAX_LIMIT, j) - get(Parameter::JOINT_MIN_LIMIT, j);
        constexpr double LONGEST_SEARCH = 1e9;
        p.travel =
            std::isfinite(range) && range < LONGEST_SEARCH ? 2.0 * std::max(range, 0.0) : LONGEST_SEARCH;
    }
    publish_limits();
    index = -1;
    return Reason::NONE;
}

Reason Controller::handle_flow(const CommandBody &body, bool &isTaken) noexcept {
    if (std::holds_alternative<Pause>(body)) {
        isPaused_ = true;
        isStepping_ = false;
        return Reason::NONE;
    }
    if (std::holds_alternative<Resume>(body)) {
        isPaused_ = false;
        isStepping_ = false;
        return Reason::NONE;
    }
    if (std::holds_alternative<StepOnce>(body)) {
        isPaused_ = false;
        isStepping_ = true;
        ++steps_;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetReverse>(&body)) {
        // Nothing is recorded to go back along without adaptive feed.
        const bool isRefused = c->isReverse && !isAdaptiveFeedEnabled_;
        isReverse_ = c->isReverse && !isRefused;
        return isRefused ? Reason::NOT_SUPPORTED : Reason::NONE;
    }
    if (const auto *c = std::get_if<SetScale>(&body)) {
        return set_scale(*c);
    }
    if (const auto *c = std::get_if<SetSwitch>(&body)) {
        return set_switch(*c);
    }
    if (const auto *c = std::get_if<SetMaxVelocity>(&body)) {
        if (!(c->velocity >= 0)) {
            return Reason::OUT_OF_RANGE;
        }
        max_velocity_ = c->velocity;
        return Reason::NONE;
    }
    isTaken = false;
    return Reason::NONE;
}

Reason Controller::set_scale(const SetScale &c) noexcept {
    if (!(c.factor >= 0) || !std::isfinite(c.factor)) {
        return Reason::OUT_OF_RANGE;
    }
    switch (c.what) {
    case Scale::FEED:
        if (c.factor > get(Parameter::MAX_FEED_SCALE) * (1 + 1e-9)) {
            return Reason::OUT_OF_RANGE;
        }
        feed_scale_ = c.factor;
        return Reason::NONE;
    case Scale::RAPID:
        if (c.factor > 1.0 + 1e-9) {
            return Reason::OUT_OF_RANGE;
        }
        rapid_scale_ = c.factor;
        return Reason::NONE;
    case Scale::SPINDLE: break;
    }
    if (c.spindle < -1 || c.spindle >= config_.num_spindles) {
        return Reason::NO_SUCH_SPINDLE;
    }
    for (int i = 0; i < config_.num_spindles; ++i) {
        if (c.spindle < 0 || c.spindle == i) {
            spindles_[at(i)].scale = c.factor;
        }
    }
    return Reason::NONE;
}

Reason Controller::set_switch(const SetSwitch &c) noexcept {
    switch (c.what) {
    case Switch::FEED_OVERRIDE: isFeedOverrideEnabled_ = c.isEnabled; return Reason::NONE;
    case Switch::ADAPTIVE_FEED: isAdaptiveFeedEnabled_ = c.isEnabled; return Reason::NONE;
    case Switch::FEED_HOLD: isFeedHoldEnabled_ = c.isEnabled; return Reason::NONE;
    case Switch::SPINDLE_OVERRIDE: break;
    }
    if (c.spindle < -1 || c.spindle >= config_.num_spindles) {
        return Reason::NO_SUCH_SPINDLE;
    }
    for (int i = 0; i < config_.num_spindles; ++i) {
        if (c.spindle < 0 || c.spindle == i) {
            spindles_[at(i)].isOverrideEnabled = c.isEnabled;
        }
    }
    return Reason::NONE;
}

}  // namespace mw::motion
