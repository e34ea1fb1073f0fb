// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/controller.hh"

#include <algorithm>

namespace mw::motion {

namespace {

/// A jerk from here on means none; a linear jerk below the least turns the jerk-limited planner off.
constexpr double LEAST_JERK = 1;
/// Part of the joints' limits that axes get where the kinematics cannot be asked.
constexpr double UNKNOWN_SHARE = 0.4;

}  // namespace

Controller::Controller(const ControllerConfig &config, const kins::Kinematics &kinematics, Channels &channels,
                       PathLink &link) noexcept
    : config_(config), kinematics_(kinematics), channels_(channels), link_(link),
      executor_(link.store, config.period_s) {
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

bool Controller::isJerkLimited() const noexcept {
    return settings_.isSet(Parameter::TRAJ_PLANNER_TYPE) && get(Parameter::TRAJ_MAX_JERK) >= LEAST_JERK;
}

/// Limits of axes and joints folded together, for the path planner.
void Controller::publish_limits() noexcept {
    PathLimits out;
    const kins::IdentityMap *map = kinematics_.identity();
    const bool isAllHomed = homing_.isAllHomed();
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        double v = std::min(get(Parameter::AXIS_MAX_VELOCITY, i), traj::UNLIMITED);
        double a = std::min(get(Parameter::AXIS_MAX_ACCELERATION, i), traj::UNLIMITED);
        double jerk = get(Parameter::AXIS_MAX_JERK, i);
        out.low[i] = isAllHomed ? get(Parameter::AXIS_MIN_LIMIT, i) : -UNBOUNDED;
        out.high[i] = isAllHomed ? get(Parameter::AXIS_MAX_LIMIT, i) : UNBOUNDED;
        bool isDriven = map == nullptr;
        for (int j = 0; map != nullptr && j < map->num_joints && j < config_.num_joints; ++j) {
            if (map->axis_of_joint[at(j)] != i) {
                continue;
            }
            isDriven = true;
            v = std::min(v, get(Parameter::JOINT_MAX_VELOCITY, j));
            a = std::min(a, get(Parameter::JOINT_MAX_ACCELERATION, j));
            jerk = std::min(jerk, get(Parameter::JOINT_MAX_JERK, j));
            if (homing_.isHomed(j)) {
                out.low[i] = std::max(out.low[i], get(Parameter::JOINT_MIN_LIMIT, j));
                out.high[i] = std::min(out.high[i], get(Parameter::JOINT_MAX_LIMIT, j));
            }
        }
        for (int j = 0; map == nullptr && !kinematics_.isShareable() && j < config_.num_joints; ++j) {
            // Nothing is known of how joints follow axes: kept well below what those of the same kind can do.
            if (settings_.isSet(Parameter::JOINT_IS_ANGULAR, j) == geom::isAngular(i)) {
                v = std::min(v, UNKNOWN_SHARE * get(Parameter::JOINT_MAX_VELOCITY, j));
                a = std::min(a, UNKNOWN_SHARE * get(Parameter::JOINT_MAX_ACCELERATION, j));
                jerk = std::min(jerk, UNKNOWN_SHARE * get(Parameter::JOINT_MAX_JERK, j));
            }
        }
        out.axes |= isDriven ? 1U << i : 0U;
        out.limits.velocity[at(i)] = v;
        out.limits.acceleration[at(i)] = a;
        out.limits.jerk[at(i)] = jerk < JERK_OFF ? jerk : traj::UNLIMITED;
    }
    const double jerk = get(Parameter::TRAJ_MAX_JERK);
    out.limits.jerk[traj::XYZ_NORM] = jerk < JERK_OFF ? jerk : traj::UNLIMITED;
    out.limits.isJerkLimited = isJerkLimited();
    out.corner_scale = get(Parameter::TRAJ_CORNER_SCALE);
    out.areTolerancesAdded = settings_.isSet(Parameter::TRAJ_ADDED_TOLERANCES);
    out.limits.velocity[traj::XYZ_NORM] = std::min(get(Parameter::TRAJ_MAX_VELOCITY), traj::UNLIMITED);
    out.limits.acceleration[traj::XYZ_NORM] =
        std::min(get(Parameter::TRAJ_MAX_ACCELERATION), traj::UNLIMITED);
    for (int j = 0; j < config_.num_joints; ++j) {
        const double own = get(Parameter::JOINT_MAX_JERK, j);
        out.joints.velocity[at(j)] = get(Parameter::JOINT_MAX_VELOCITY, j);
        out.joints.acceleration[at(j)] = get(Parameter::JOINT_MAX_ACCELERATION, j);
        out.joints.jerk[at(j)] = own < JERK_OFF ? own : traj::UNLIMITED;
        out.joints.low[at(j)] = homing_.isHomed(j) ? get(Parameter::JOINT_MIN_LIMIT, j) : -UNBOUNDED;
        out.joints.high[at(j)] = homing_.isHomed(j) ? get(Parameter::JOINT_MAX_LIMIT, j) : UNBOUNDED;
    }
    out.joints.count = config_.num_joints;
    path_limits_ = out;
    link_.limits.write(out);
    ++limits_version_;
}

}  // namespace mw::motion
