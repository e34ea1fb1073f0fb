// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/controller.hh"

#include <algorithm>

namespace mw::motion {

Controller::Controller(const ControllerConfig &config, const kins::Kinematics &kinematics, Channels &channels,
                       PathLink &link) noexcept
    : config_(config), kinematics_(kinematics), channels_(channels), link_(link),
      executor_(link.store, config.period_s), map_(axis_map(kinematics, config.num_joints)) {
    const kins::IdentityMap *map = kinematics.identity();
    const int used = map != nullptr ? std::min(map->num_joints, config.num_joints) : config.num_joints;
    homing_.set_num_joints(used);
    for (int j = used; j < config.num_joints; ++j) {
        joint(j).isActive = false;  // drives nothing until somebody activates it
    }
    publish_limits();
}

bool Controller::isAnythingMoving() const noexcept {
    if (!executor_.isAtRest() || link_.retrace.isMoving()) {
        return true;
    }
    for (int j = 0; j < config_.num_joints; ++j) {
        if (mode_ == Mode::FREE && !joint(j).free.isAtRest()) {
            return true;
        }
    }
    for (const AxisState &axis : axes_) {
        if (mode_ == Mode::TELEOP && !axis.teleop.isAtRest()) {
            return true;
        }
    }
    return false;
}

void Controller::step(const Inputs &in, Outputs &out) noexcept {
    ++cycle_;
    const bool isStopOver = stop_ == Stop::CATEGORY_1 && !isAnythingMoving();
    if (isStopOver) {
        disable();
    }
    read_feedback(in);
    check_watchdog();
    check_faults(in);
    step_holds(in);
    for (int n = 0; n < config_.num_spindles; ++n) {
        executor_.set_spindle(n, in.spindle[at(n)].revs, in.spindle[at(n)].speed_in_rps);
    }
    if (isEnabled_) {
        step_homing(in);
        step_wheels(in);
        if (mode_ == Mode::FREE) {
            check_probe(in);
            move_joints();
        } else {
            step_coord(in);
        }
    } else {
        executor_.step(cycle_);
    }
    output_joints();
    step_spindles(in);
    fill(in, out);
    publish_view(in);
    channels_.status.write(out.status);
    trace(in, out.status);
    wasProbeClosed_ = in.isProbeClosed;
}

const traj::MoveTag *Controller::active_tag() const noexcept {
    const traj::Sequence move = executor_.output().move;
    return mode_ == Mode::COORD && move != 0 ? &link_.store.move(move) : nullptr;
}

void Controller::raise(FaultKind kind, int index, double value, std::uint16_t detail) noexcept {
    Fault fault;
    fault.kind = kind;
    fault.index = static_cast<std::int16_t>(index);
    fault.value = value;
    fault.detail = detail;
    if (const MoveTag *tag = active_tag()) {
        fault.source = {tag->line, tag->file_index, tag->block};
    }
    channels_.servo_faults.push(fault);  // a full ring: the first faults are the ones that matter
}

/// Amplifiers off in this cycle.
void Controller::stop_category_0(FaultKind kind, int index, double value) noexcept {
    if (isEnabled_) {
        raise(kind, index, value);
    }
    disable();
}

/// Everything brakes within its limits; amplifiers off in the cycle after it stands.
void Controller::stop_category_1(FaultKind kind, int index, double value) noexcept {
    if (!isEnabled_ || stop_ == Stop::CATEGORY_1) {
        return;
    }
    raise(kind, index, value);
    stop_ = Stop::CATEGORY_1;
    homing_.abort(homing::Failure::ABORTED);
    isHomeDue_ = false;
    executor_.drop();
    stop_jogs(false);
}

void Controller::disable() noexcept {
    homing_.abort(homing::Failure::ABORTED);
    isHomeDue_ = false;
    executor_.stop_now();
    isEnabled_ = false;
    stop_ = Stop::NONE;
    isPaused_ = false;
    isStepping_ = false;
    for (int j = 0; j < config_.num_joints; ++j) {
        joint(j).isAmpWanted = false;
        joint(j).jog = JogSource::NONE;
        if (settings_.isSet(Parameter::JOINT_VOLATILE_HOME, j)) {
            homing_.unhome(j);
        }
    }
    for (AxisState &axis : axes_) {
        axis.jog = JogSource::NONE;
    }
    for (SpindleState &spindle : spindles_) {
        spindle.isOn = false;
        spindle.speed_rpm = 0;
        spindle.isOrienting = false;
    }
    publish_limits();
}

void Controller::abort_all() noexcept {
    homing_.abort(homing::Failure::ABORTED);
    isHomeDue_ = false;
    executor_.drop();
    stop_jogs(false);
    isPaused_ = false;
    isStepping_ = false;
    isCoordError_ = false;
}

void Controller::answer(CommandId id, AnswerKind kind, Reason reason, std::int16_t index) noexcept {
    Answer a;
    a.id = id;
    a.kind = kind;
    a.reason = reason;
    a.index = index;
    channels_.servo_answers.push(
        a);  // handle_commands takes a command only when there is room for its answer
    last_id_ = id;
}

/// Limits of axes and joints folded together, for jogs and the path planner.
void Controller::publish_limits() noexcept {
    limits_ = fold_limits(settings_, map_, {homed_mask(), homing_.isAllHomed()});
    PathLimits out;
    out.limits = limits_.path;
    out.low = limits_.low;
    out.high = limits_.high;
    out.axes = limits_.axes;
    out.joints = limits_.joints;
    out.corner_scale = get(Parameter::TRAJ_CORNER_SCALE);
    out.areTolerancesAdded = settings_.isSet(Parameter::TRAJ_ADDED_TOLERANCES);
    link_.limits.write(out);
    ++limits_version_;
}

}  // namespace mw::motion
