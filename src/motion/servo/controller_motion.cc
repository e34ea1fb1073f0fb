// SPDX-License-Identifier: GPL-2.0-or-later
// The motion of a cycle: single joints (free), axes (teleop) or the path (coord) through the kinematics.
#include <bit>

#include "motion/servo/controller.hh"
#include "motion/servo/jogs/teleop.hh"

namespace mw::motion {
namespace {

/// Records the path for reverse run.
void record_way(Retracing &retracing, const geometry::Pose &pose, const Joints &joints,
                const RetraceLimits &limits) noexcept {
    const double t = limits.period_s;
    for (int j = 0; j < limits.joints; ++j) {
        record_joint(retracing, j, joints[j].vel_cmd * t, joints[j].acc_cmd * t * t);
    }
    record(retracing, pose, limits);
}

/// Follows the joints during reverse run.
void follow_way(Retracing &retracing, const Joints &joints, const RetraceLimits &limits) noexcept {
    const double t = limits.period_s;
    for (int j = 0; j < limits.joints && retracing.retrace.isMoving(); ++j) {
        follow_joint(retracing, j, joints[j].vel_cmd * t, joints[j].acc_cmd * t * t);
    }
}

RetraceLimits way_limits(const FoldedLimits &limits, const AxisMap &map,
                         const ControllerConfig &config) noexcept {
    return {limits, map.areJointsAxes() ? 0 : config.num_led_joints(), config.period_s};
}

/// Bit per axis that one of the closed locks holds.
std::uint32_t axes_held(const FoldedLimits &limits, std::uint32_t locked) noexcept {
    std::uint32_t axes = 0;
    for (int i = 0; i < MAX_AXES && locked != 0; ++i) {
        axes |= (limits.axis_locks[static_cast<std::size_t>(i)] & locked) != 0 ? 1U << i : 0U;
    }
    return axes;
}

}  // namespace

TravelRange programmed_range(const Jogs &jogs, const PathLink &link, Mode mode, const geometry::Pose &pose,
                             const SharedJoints &shared) noexcept {
    constexpr int TRIES = 1000;
    TravelRange out{{pose, pose}, shared.at(pose)};
    PathExtent path;
    if (mode == Mode::COORD && link.extent.read(path, TRIES) && !path.isEmpty) {
        out.include(path.range);
    }
    if (mode == Mode::TELEOP) {
        PoseRange stops{pose, pose};
        for (int i = 0; i < MAX_AXES; ++i) {
            jogs.at({false, i}).planner.add_reach(out.axes.low[i], out.axes.high[i]);
            // A jog may have to stop on a longer way when it gets less of the joints.
            constexpr double MARGIN = 1.2;
            stops.low[i] += MARGIN * (out.axes.low[i] - pose[i]);
            stops.high[i] += MARGIN * (out.axes.high[i] - pose[i]);
        }
        out.joints.include(shared.within(stops));
    }
    return out;
}

/// Free mode: every joint follows its own planner.
void Controller::move_joints(const Inputs &in) noexcept {
    check_probe(in);
    executor_.step(cycle_);
    const std::uint32_t locked = held(indexers_);
    for (int j = 0; j < config_.num_joints; ++j) {
        Jog &jog = jogs_.at({true, j});
        if (extra_.joint[static_cast<std::size_t>(j)].state != Following::NONE) {
            continue;
        }
        if ((locked & 1U << j) == 0) {
            step_joint(jog, limits_.joints.velocity[static_cast<std::size_t>(j)], holds_.jog_scale(),
                       config_.period_s);
        }
        follow(joints_[j], jog.planner.position, config_.period_s);
    }
    motion::step(offsets_, {in.axis_offset, limits_, {}, false, config_.period_s});
    const bool isKnown = kinematics_.kind() == kinematics::Kind::BOTH && isAllHomed(homing_);
    follow_joints(place_, kinematics_, commanded(joints_).data(), isKnown);
}

/// Teleop and coord: every joint follows the pose.
void Controller::move_axes(const Inputs &in) noexcept {
    if (alignment_.isMisaligned()) [[unlikely]] {
        check_probe(in);
        executor_.step(cycle_);
        const bool isWanted = link_->queue_depth.load(std::memory_order_relaxed) != 0 ||
                              !areAxesAtRest(jogs_) || areAsked(offsets_, in.axis_offset);
        if (motion::step(alignment_, joints_, isWanted, config_.period_s) == AlignmentStep::STOPPED) {
            power_.mode = Mode::FREE;  // each joint moves by itself
            rest_at(jogs_, commanded(joints_).data(), without(offsets_, place_.cmd));
        }
        return;
    }
    const geometry::Pose pose = power_.mode == Mode::TELEOP ? teleop_pose() : path_pose();
    geometry::Pose target = pose;
    if (offsets_.axes != 0) [[unlikely]] {
        if (retracing_.retrace.isEmpty()) {
            offsets_.travelled = {{pose, pose}, offsets_.shared.at(pose)};
        }
        offsets_.travelled.include({{pose, pose}, offsets_.shared.at(pose)});
        OffsetInputs offsets{in.axis_offset, limits_,
                             programmed_range(jogs_, *link_, power_.mode, pose, offsets_.shared)};
        offsets.programmed.include(offsets_.travelled);
        offsets.isHonoured = power_.isReady() && limits_.homed.areAll;
        offsets.period_s = config_.period_s;
        motion::step(offsets_, offsets);
        target = pose + offsets_.pose;
    }
    check_probe(in);
    move_to(target);
    if (power_.mode == Mode::COORD) [[likely]] {
        if (!map_.areJointsAxes() && hasDropped(standing_, executor_.snapshot())) [[unlikely]] {
            publish_joint_start();
        }
        // The planner cannot call this kinematics module, so joint limits are checked here and a violation
        // stops the machine.
        const bool isPlanned = map_.kind != AxisMap::Kind::UNKNOWN;
        const Overrun overrun = isPlanned || !power_.isReady() ? Overrun{} : find_overrun(joints_, limits_);
        if (overrun.joint >= 0) [[unlikely]] {
            stop_category_1(overrun.isOutside ? FaultKind::JOINT_LEFT_RANGE : FaultKind::JOINT_TOO_FAST,
                            overrun.joint, overrun.use);
        }
        if (!retracing_.retrace.isAway()) {
            // Reverse run does not pass a tapped hole or a thread without the spindle in step, nor a lock.
            const bool isOneWay = executor_.output().tap.spindle >= 0 || executor_.locked_spindle() >= 0 ||
                                  busy(indexers_) != 0;
            // External offsets are not part of the recorded path, so it is recorded only where it is needed.
            const bool isWanted = holds_.isAdaptiveFeedEnabled || offsets_.axes == 0;
            if (isWanted && !isOneWay) {
                record_way(retracing_, pose, joints_, way_limits(limits_, map_, config_));
            } else {
                retracing_.retrace.clear();
            }
        }
    }
    constexpr int MAX_EVENTS_PER_CYCLE = 64;
    for (int n = 0; n < MAX_EVENTS_PER_CYCLE; ++n) {
        const trajectory::PathEvent *event = executor_.due_event();
        if (event == nullptr) [[likely]] {
            return;
        }
        fire(outputs_, *event, executor_.snapshot().isDropping);
        executor_.drop_event();
    }
}

/// In every mode: homed extra joints follow their pins.
void Controller::move_extra_joints(const Inputs &in) noexcept {
    const ExtraJointEvents events =
        motion::step(extra_, extra_inputs(in, joints_, limits_, config_.period_s));
    for (int j = extra_.first; j < config_.num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const ExtraJoint &extra = extra_.joint[n];
        if (extra.state != Following::NONE) {
            follow(joints_[j], extra.planner.position(), config_.period_s);
            jogs_.joint[n].planner.reset(extra.planner.position());
        }
    }
    for (std::uint32_t beyond = events.beyond; beyond != 0; beyond &= beyond - 1) {
        const int j = std::countr_zero(beyond);
        raise(FaultKind::EXTRA_JOINT_LIMIT, j, in.joint[static_cast<std::size_t>(j)].posthome_cmd);
    }
    if (events.lost != 0) {
        stop_category_1(FaultKind::EXTRA_JOINT_LOST, std::countr_zero(events.lost));
    }
}

geometry::Pose Controller::teleop_pose() noexcept {
    executor_.step(cycle_);
    const std::uint32_t locked = axes_held(limits_, held(indexers_));
    if (!map_.areJointsAxes()) {
        PerJoint places = commanded(joints_);
        trajectory::JointLimits left = limits_.path_joints;
        take_off(offsets_, places, left);
        const TeleopMachine machine{kinematics_,
                                    limits_,
                                    left,
                                    places,
                                    config_.num_led_joints(),
                                    holds_.jog_scale(),
                                    config_.period_s,
                                    kinematics_.side(place_.cmd),
                                    locked};
        const TeleopStop stopped = step_teleop(jogs_, machine);
        if (stopped.isNew && stopped.joint >= 0) {
            raise(FaultKind::JOG_JOINT_LIMIT, stopped.joint);
        } else if (stopped.isNew) {
            raise(FaultKind::JOG_UNREACHABLE, config_.num_led_joints());
        }
    }
    geometry::Pose pose;
    for (int i = 0; i < MAX_AXES; ++i) {
        Jog &jog = jogs_.at({false, i});
        if (map_.areJointsAxes()) {
            limit_axis(jog, limits_.jog({false, i}).velocity, holds_.jog_scale());
            if ((locked & 1U << i) == 0) {
                jog.planner.step(config_.period_s);
            }
        }
        pose[i] = jog.planner.position;
    }
    return pose;
}

/// The pose of the path, or behind it in reverse run.
geometry::Pose Controller::path_pose() noexcept {
    const trajectory::ExecutorOutput &path = executor_.step(cycle_);
    geometry::Pose pose = path.position;
    if (path.tap.isLost) [[unlikely]] {
        stop_category_1(FaultKind::TAP_LOST, path.tap.spindle);
    }
    // A path that has ended keeps its position: a program that waits relies on it.
    const bool isPathHeld = executor_.isAtRest() && !executor_.isEmpty();
    const RetraceInputs in{executor_.snapshot().drops,
                           holds_.isReverseWanted,
                           holds_.isStandingWanted,
                           power_.isStopping,
                           isPathHeld,
                           holds_.reverse_rate};
    const RetraceLimits limits = way_limits(limits_, map_, config_);
    follow_way(retracing_, joints_, limits);
    if (motion::step(retracing_, pose, in, limits)) [[unlikely]] {
        executor_.set_position(pose);
    }
    return pose;
}

void Controller::move_to(const geometry::Pose &pose) noexcept {
    const PerJoint here = commanded(joints_);
    PerJoint positions = here;
    if (!isAnswered(kinematics_.inverse(pose, positions.data()))) [[unlikely]] {
        // The planner avoids such poses; if one comes, no valid command is possible.
        stop_category_0(FaultKind::KINEMATICS_FAILED, -1);
        return;
    }
    const bool isPlanned = map_.kind == AxisMap::Kind::PLANNED;
    const int jump = isPlanned ? joint_that_jumps(positions, here, stride_of(limits_, config_)) : -1;
    if (jump >= 0) [[unlikely]] {
        const auto n = static_cast<std::size_t>(jump);
        stop_category_0(FaultKind::KINEMATICS_JUMP, jump, positions[n] - joints_[jump].pos_cmd);
        return;
    }
    follow_pose(place_, pose, config_.period_s);
    for (int j = 0; j < config_.num_led_joints(); ++j) {
        const auto n = static_cast<std::size_t>(j);
        follow(joints_[j], positions[n], config_.period_s);
        jogs_.joint[n].planner.reset(positions[n]);
    }
}

/// Activates the type of the pin once nothing moves and no path waits.
void Controller::step_kinematics(const Inputs &in) noexcept {
    kinematics::TypeSwitch *types = kinematics_.type_switch();
    if (types == nullptr) [[likely]] {
        return;
    }
    TypeInputs now;
    now.pin = in.kinematics_type;
    now.isMoving = isAnythingMoving() || homing_.isUnderWay();
    now.isOnPath = power_.mode == Mode::COORD &&
                   (now.isMoving || link_->queue_depth.load(std::memory_order_relaxed) != 0);
    now.seen = link_->type_asks_seen.load(std::memory_order_acquire);
    switch (motion::step(types_, now)) {
    case TypeStep::NONE:
    case TypeStep::WAIT: return;
    case TypeStep::NO_SUCH_TYPE: raise(FaultKind::NO_KINEMATICS_TYPE, -1, in.kinematics_type); return;
    case TypeStep::ON_PATH:
        raise(FaultKind::KINEMATICS_SWITCHED_ON_PATH, -1, in.kinematics_type);
        executor_.drop();
        isCoordError_ = true;
        return;
    case TypeStep::SWITCH: switch_kinematics(*types); return;
    }
}

/// The joints are stopped and get the pose of the new type. If the type has no pose for them, the old one
/// stays.
void Controller::switch_kinematics(kinematics::TypeSwitch &types) noexcept {
    geometry::Pose pose = place_.cmd;
    bool isSwitched = types.switch_to(types_.wanted);
    if (!isSwitched) {
        raise(FaultKind::NO_KINEMATICS_TYPE, -1, types_.wanted);
    } else if (isAllHomed(homing_)) {
        const PerJoint joints = commanded(joints_);
        const bool isKnown = isAnswered(kinematics_.forward(joints.data(), pose)) &&
                             isWithinOneStep(kinematics_, pose, joints, stride_of(limits_, config_));
        if (!isKnown) {
            raise(FaultKind::KINEMATICS_TYPE_WITHOUT_POSE, -1, types_.wanted);
            types.switch_to(types_.type);
            isSwitched = false;
        }
    }
    settle(types_, isSwitched);
    if (!isSwitched) {
        return;
    }
    place_.cmd = pose;
    executor_.drop();
    executor_.set_position(pose);
    retracing_.retrace.clear();
    rest_at(jogs_, commanded(joints_).data(), pose);
    publish_joint_start();
}

/// A probing move ends where the probe trips; in any other move a trip is a fault.
void Controller::check_probe(const Inputs &in) noexcept {
    const trajectory::ExecutorOutput &path = executor_.output();
    const bool isProbing = power_.mode == Mode::COORD && path.isOnProbe && path.isMoving;
    ProbeInputs probe;
    probe.isClosed = in.isProbeClosed;
    if (isProbing) [[unlikely]] {
        probe.probing_move = path.move;
        probe.isAway = link_->store.move(path.move).isProbeAway;
    } else if (in.isProbeClosed && !probe_.wasClosed) [[unlikely]] {
        const bool isHoming = homing_.isActive();
        const Parameter ignored =
            isHoming ? Parameter::TRAJ_NO_PROBE_HOME_ERROR : Parameter::TRAJ_NO_PROBE_JOG_ERROR;
        const bool isIgnored = power_.mode != Mode::COORD && settings_.isSet(ignored);
        probe.isMoving = !isIgnored && !power_.isStopping && isAnythingMoving();
        probe.isDropping = executor_.snapshot().isDropping;
    }
    switch (motion::step(probe_, probe, without(offsets_, place_.fb))) {
    case ProbeEvent::NONE: break;
    case ProbeEvent::FOUND: executor_.drop(); break;
    case ProbeEvent::TOUCHED:
        raise(FaultKind::PROBE_TRIPPED_IN_MOVE, -1, 0, power_.mode != Mode::COORD ? 1 : 0);
        abort(homing_, homing::event::ABORT);
        executor_.drop();
        stop(jogs_);
        isCoordError_ = true;
        break;
    }
}

}  // namespace mw::motion
