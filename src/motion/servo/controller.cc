// SPDX-License-Identifier: GPL-2.0-or-later
// A servo cycle from feedback to motor commands; faults and stops. [[likely]] and [[unlikely]] here and in
// the parts mark the path of an idle cycle: between two cycles the processor loses its branch predictions,
// and each branch that is taken costs as much as a dozen instructions (docs/developer/performance.md).
// Functions of that path are hot, those of events cold. The linker groups each type, so that a cycle touches
// fewer pages and cache lines of the module.
#include "motion/servo/controller.hh"

#include <algorithm>
#include <bit>
#include <memory>

namespace mw::motion {

namespace {

homing::JointInput homing_input(const JointInputs &pins, const Joint &joint, const Jog &jog,
                                const JogLimits &most) noexcept {
    homing::JointInput out;
    out.isSwitchClosed = pins.isHomeSwitchClosed;
    out.isIndexEnabled = pins.isIndexEnabled;
    out.isUnlocked = pins.isUnlocked;
    out.isAtRest = jog.planner.isAtRest();
    out.pos_cmd = joint.pos_cmd;
    out.pos_fb = joint.pos_fb;
    out.vel_cmd = joint.vel_cmd;
    out.motor_pos_fb = joint.motor_pos_fb;
    out.motor_offset = joint.motor_offset;
    out.max_velocity = most.velocity;
    out.max_acceleration = most.acceleration;
    out.max_jerk = most.jerk;
    out.isOnPosLimit = joint.isOnPosHardLimit;
    out.isOnNegLimit = joint.isOnNegHardLimit;
    return out;
}

/// [TRAJ]HOME
geometry::Pose first_place(const Settings &settings) noexcept {
    geometry::Pose pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = settings.get(Parameter::AXIS_FIRST_PLACE, axis);
    }
    return pose;
}

}  // namespace

Controller::Controller(const ControllerConfig &config, const kinematics::Kinematics &kinematics,
                       Channels &channels, PathLink &link) noexcept
    : config_(config), kinematics_(kinematics), channels_(&channels), link_(&link),
      executor_(link.store, config.period_s) {
    joints_.loaded = config.num_joints;
    spindles_.count = config.num_spindles;
    outputs_.num_digital = config.num_dio;
    outputs_.num_analog = config.num_aio;
    homing_.own.set_period(config.period_s);
    homing_.foreign = config.homing;
    use_joints(config.num_joints);
    jogs_.axes = limits_.axes;  // there are never more joints than now
    const kinematics::IdentityMap *identity = kinematics.identity();
    const int led = config.num_led_joints();
    for (int j = identity != nullptr ? identity->num_joints : led; j < led; ++j) {
        joints_[j].isActive = false;  // drives nothing until it is activated
    }
}

/// Passes the number of joints to the parts that depend on it.
void Controller::use_joints(int count) noexcept {
    const kinematics::IdentityMap *identity = kinematics_.identity();
    config_.num_joints = count;
    joints_.count = count;
    jogs_.num_joints = count;
    homing_.num_joints = count;
    extra_.count = config_.num_extra_joints;
    extra_.first = count - extra_.count;
    homing_.num_to_home =
        identity != nullptr && extra_.count == 0 ? std::min(identity->num_joints, count) : count;
    homing_.module().set_num_joints(homing_.num_to_home);
    map_ = axis_map(kinematics_, count, extra_.count);
    for (int j = 0; j < count; ++j) {
        set_axis(homing_, j, map_.areJointsAxes() ? map_.axis_of_joint[static_cast<std::size_t>(j)] : -1);
    }
    publish_limits();
}

Controller::Controller(const Controller &other, Channels &channels, PathLink &link) noexcept
    : Controller(other) {
    channels_ = &channels;
    link_ = &link;
    std::construct_at(&executor_, other.executor_, link.store);
}

bool Controller::isAnythingMoving() const noexcept {
    const bool isOnPath = !executor_.isAtRest() || retracing_.retrace.isMoving() || alignment_.areUnderWay();
    switch (power_.mode) {
    case Mode::FREE: return isOnPath || !areJointsAtRest(jogs_);
    case Mode::TELEOP: return isOnPath || !areAxesAtRest(jogs_);
    case Mode::COORD: break;
    }
    return isOnPath;
}

void Controller::step(const Inputs &in, Outputs &out) noexcept {
    ++cycle_;
    if (power_.isStopping && !isAnythingMoving() && areAtRest(offsets_) && areAtRest(extra_)) [[unlikely]] {
        disable();
    }
    if (homing_.foreign != nullptr) [[unlikely]] {
        homing_.foreign->read_pins();
    }
    const PerJoint measured = read_feedback(joints_, in);
    read_feedback(place_, kinematics_, measured.data(), limits_.homed.areAll);
    // The feedback is not that of the machine any more: braking to a place would be wrong, too.
    if (note_lost_positions(homing_, in.lost_positions)) [[unlikely]] {
        if (power_.isEnabled || homed_mask(homing_) != 0) {
            raise(FaultKind::POSITIONS_LOST, -1);
        }
        disable();
    }
    const TaskSigns signs{channels_->task_loops.load(std::memory_order_relaxed),
                          channels_->host_looks.load(std::memory_order_relaxed),
                          channels_->isTaskDead.load(std::memory_order_acquire) != 0};
    if (motion::step(watchdog_, signs, config_.period_s)) [[unlikely]] {
        stop_category_1(FaultKind::TASK_LOST, signs.isDead ? 1 : 0,
                        watchdog_.standing_s + watchdog_.starved_s);
    }
    // Drives and step generators have kept their last command: continuing from there would be a jump.
    if (const double missed_s = gap_s(watchdog_, in.time_ns); missed_s > 0 && power_.isEnabled) [[unlikely]] {
        isAnythingMoving() ? stop_category_0(FaultKind::MOTION_STOOD, 1, missed_s)
                           : raise(FaultKind::MOTION_STOOD, 0, missed_s);
    }
    check_faults(in, measure(spindles_, in));
    motion::step(holds_, {in.adaptive_feed, in.isFeedHeld, in.isFeedInhibited,
                          link_->steps_done.load(std::memory_order_acquire)});
    const bool isReversing = holds_.isReverseWanted || retracing_.retrace.isAway();
    executor_.hold(holds_.isStandingWanted || alignment_.isMisaligned() ||
                   (power_.mode == Mode::COORD && isReversing));
    step_kinematics(in);
    for (int n = 0; n < config_.num_spindles; ++n) {
        executor_.set_spindle(n, spindles_[n].turns);
        executor_.set_brakings(n, brakings_of(spindles_, n, settings_));
    }
    if (!power_.isEnabled) [[unlikely]] {
        executor_.step(cycle_);
    } else {
        step_homing(in);
        step_jogs(in);
        if (indexers_.mask != 0) [[unlikely]] {
            step_indexers(in);
        }
        if (power_.mode == Mode::FREE) [[unlikely]] {
            move_joints(in);
        } else {
            move_axes(in);
        }
        if (extra_.count > 0) [[unlikely]] {
            move_extra_joints(in);
        }
    }
    output_joints();
    const trajectory::TapDemand &tap = executor_.output().tap;
    SpindleCycle cycle{place_.cmd[geometry::AXIS_X], {tap.spindle, tap.factor}, config_.period_s};
    for (int n = 0; n < config_.num_spindles; ++n) {
        const trajectory::SpindleTrack &track = executor_.spindle(n).track;
        cycle.counted[static_cast<std::size_t>(n)] = {track.turns_per_s(), track.step()};
    }
    for (std::uint32_t failed = motion::step(spindles_, in, settings_, cycle); failed != 0;
         failed &= failed - 1) {
        const int n = std::countr_zero(failed);
        raise(FaultKind::SPINDLE_FAULT, n, spindles_[n].orient_fault);
    }
    if (homing_.foreign != nullptr) [[unlikely]] {
        homing_.foreign->write_pins();
    }
    publish(in, out);
    probe_.wasClosed = in.isProbeClosed;
}

void Controller::raise(FaultKind kind, int index, double value, std::uint16_t detail) noexcept {
    Fault fault;
    fault.kind = kind;
    fault.index = static_cast<std::int16_t>(index);
    fault.value = value;
    fault.detail = detail;
    if (const trajectory::MoveTag *tag = active_move(executor_, link_->store, power_.mode)) {
        fault.source = {tag->line, tag->file_index, tag->block};
    }
    channels_->servo_faults.push(fault);  // a full ring: the first faults are the important ones
}

/// Switches the amplifiers off in this cycle.
void Controller::stop_category_0(FaultKind kind, int index, double value) noexcept {
    if (power_.isEnabled) {
        raise(kind, index, value);
    }
    disable();
}

/// Brakes everything within its limits; the amplifiers go off in the cycle after standstill.
void Controller::stop_category_1(FaultKind kind, int index, double value) noexcept {
    if (!begin_stop(power_)) {
        return;
    }
    raise(kind, index, value);
    abort(homing_, homing::event::ABORT);
    executor_.drop();
    stop(jogs_);
    stop(alignment_);
    stop(offsets_);
    hold(extra_);
}

void Controller::check_faults(const Inputs &in, std::uint32_t spindles_lost) noexcept {
    if (!power_.isEnabled) [[unlikely]] {
        return;
    }
    if (!in.isEnableOn) [[unlikely]] {
        stop_category_0(FaultKind::ENABLE_LOST, -1);
        return;
    }
    check_joints(in);
    const int in_step = executor_.locked_spindle();
    for (int n = 0; n < config_.num_spindles; ++n) {
        if (in.spindle[static_cast<std::size_t>(n)].isAmpFaulted) [[unlikely]] {
            stop_category_1(FaultKind::SPINDLE_FAULT, n);
        }
        if (n == in_step && (spindles_lost >> n & 1U) != 0) [[unlikely]] {
            stop_category_1(FaultKind::SPINDLE_LOST, n);
        }
    }
    if (in.misc_errors != 0) [[unlikely]] {
        stop_category_1(FaultKind::MISC_ERROR, -1, static_cast<double>(in.misc_errors));
    }
}

void Controller::check_joints(const Inputs &in) noexcept {
    const homing::Module &homing = homing_.module();
    JointCheck how;
    how.limits_ignored = jogs_.areLimitsOverridden ? ~0U : 0U;
    how.feedback_ignored = extra_.mask() & limits_.homed.joints;
    if (homing_.hasWork()) [[unlikely]] {
        for (int j = 0; j < config_.num_joints; ++j) {
            const bool isIndexFound = !in.joint[static_cast<std::size_t>(j)].isIndexEnabled;
            how.at_index |= homing.isAtIndex(j) && isIndexFound ? 1U << j : 0U;
            how.limits_ignored |= homing_.isIgnoringLimits(j) ? 1U << j : 0U;
        }
    }
    for (int j = 0; power_.isEnabled; ++j) {
        switch (find_fault(joints_, j, settings_, how)) {
        case JointFault::NONE: return;
        case JointFault::FEEDBACK_LOST: stop_category_0(FaultKind::FEEDBACK_LOST, j); break;
        case JointFault::AMP_FAULT: stop_category_0(FaultKind::AMP_FAULT, j); break;
        case JointFault::FOLLOWING_ERROR:
            stop_category_0(FaultKind::FOLLOWING_ERROR, j, joints_[j].ferror);
            break;
        case JointFault::HARD_LIMIT:
            if (homing.isHoming(j)) {
                abort(homing_, homing::event::LIMIT, j);
            }
            stop_category_1(FaultKind::HARD_LIMIT, j, joints_[j].isOnPosHardLimit ? 1.0 : -1.0);
            break;
        }
    }
}

void Controller::step_homing(const Inputs &in) noexcept {
    if (homing_.isDue) [[unlikely]] {
        hold(extra_);
        const HomeConditions conditions{true, power_.mode, in.isHomingInhibited,
                                        isAnythingMoving() || !areAtRest(extra_) || busy(indexers_) != 0,
                                        inactive_joints(joints_)};
        const homing::Failure why = begin_due(homing_, conditions);
        if (why != homing::Failure::NONE) {
            raise(FaultKind::HOMING_FAILED, homing_.due, 0, static_cast<std::uint16_t>(why));
        }
    }
    if (homing_.hasWork()) [[unlikely]] {
        drive_homing(in);
    }
    const HomingFailure failure = take_failure(homing_);
    if (failure.why != homing::Failure::NONE) [[unlikely]] {
        raise(FaultKind::HOMING_FAILED, failure.joint, 0, static_cast<std::uint16_t>(failure.why));
    }
    for (std::uint32_t clamped = homing_.take_clamped(); clamped != 0; clamped &= clamped - 1) {
        raise(FaultKind::HOMING_CLAMPED, std::countr_zero(clamped));
    }
    const bool isOtherMap = offsets_.shared.joints != 0 && !map_.isAsIn(kinematics_);
    if (limits_.homed.joints != homed_mask(homing_) || isOtherMap) [[unlikely]] {
        if (power_.mode == Mode::FREE &&
            isAllHomed(homing_)) {  // in other modes the pose commands the joints
            find_again(place_, kinematics_, commanded(joints_).data(), first_place(settings_));
        }
        publish_limits();
    }
}

/// One cycle of the joints that are being homed.
void Controller::drive_homing(const Inputs &in) noexcept {
    homing::JointInput inputs[MAX_JOINTS];
    homing::JointCommand commands[MAX_JOINTS];
    for (int j = 0; j < config_.num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        inputs[j] = homing_input(in.joint[n], joints_[j], jogs_.at({true, j}), limits_.joint_jog[n]);
    }
    homing_.module().step(inputs, commands);
    if (homing_.foreign != nullptr && !areFinite(homing_, commands)) {
        abort(homing_, homing::event::ABORT);
        stop(jogs_);
        raise(FaultKind::HOMING_FAILED, -1, 0, static_cast<std::uint16_t>(homing::Failure::MODULE_NONSENSE));
        return;
    }
    for (int j = 0; j < config_.num_joints; ++j) {
        const homing::JointCommand &c = commands[j];
        Jog &jog = jogs_.at({true, j});
        if (c.isShifting) {
            shift(joints_[j], c.shift);
            renumber(jog, joints_[j].pos_cmd, c.shift);
        } else if (c.isSettingZero) {
            set_zero(joints_[j], c.zero);
            renumber(jog, joints_[j].pos_cmd, joints_[j].pos_cmd - jog.planner.position);
        }
        home_joint(jog, c, limits_.joint_jog[static_cast<std::size_t>(j)]);
    }
}

/// Jogs whose lease is not renewed stop here, also if task and client have ended; wheels move other jogs.
void Controller::step_jogs(const Inputs &in) noexcept {
    for (JogTarget over = end_lease(jogs_, in.time_ns); over.index >= 0;
         over = end_lease(jogs_, in.time_ns)) {
        const auto lease_ns = static_cast<double>(jogs_.at(over).lease.length_ns);
        raise(FaultKind::JOG_LEASE_ENDED, over.index, lease_ns * 1e-9, over.isJoint ? 1 : 0);
    }
    if (in.isJogStoppedNow) [[unlikely]] {
        stop_at_once(jogs_);
    } else if (in.isJogStopped && !homing_.isActive()) [[unlikely]] {
        stop(jogs_);
    }
    const bool areJoints = power_.mode == Mode::FREE;
    const int count = areJoints ? config_.num_joints : power_.mode == Mode::TELEOP ? MAX_AXES : 0;
    for (int i = 0; i < count; ++i) {
        const JogTarget target{areJoints, i};
        const auto n = static_cast<std::size_t>(i);
        const WheelInput &wheel = areJoints ? in.joint[n].wheel : in.axis_wheel[n];
        const double distance = turned(jogs_.at(target), wheel);
        if (distance != 0.0) [[unlikely]] {
            jog_by_wheel(jogs_, target, distance, wheel, situation_of(in, target));
        }
    }
    settle(jogs_, in);
}

/// A jog or move of an indexer waits here for its lock.
void Controller::step_indexers(const Inputs &in) noexcept {
    IndexerInputs now;
    now.period_s = config_.period_s;
    now.unlocked = unlocked_pins(in);
    for (int j = 0; j < config_.num_joints; ++j) {
        const std::uint32_t bit = 1U << j;
        const bool isHoming = homing_.module().isHoming(j) || homing_.module().isUnlockWanted(j);
        now.homing |= isHoming ? bit : 0U;
        now.moving |= joints_[j].vel_cmd != 0.0 ? bit : 0U;
        const bool isJogged = power_.mode == Mode::FREE && !jogs_.at({true, j}).planner.isAtRest();
        now.wanted |= isJogged ? bit : 0U;
    }
    for (std::uint32_t left = power_.mode == Mode::TELEOP ? jogs_.axes : 0U; left != 0; left &= left - 1) {
        const JogTarget axis{false, std::countr_zero(left)};
        now.wanted |= jogs_.at(axis).planner.isAtRest() ? 0U : limits_.locks_of(axis);
    }
    // Requests of the planner for a path that was dropped are ignored.
    const std::uint64_t wish = link_->indexers_wanted.load(std::memory_order_acquire);
    const bool isOfPath =
        static_cast<std::uint32_t>(wish >> 32) == static_cast<std::uint32_t>(executor_.snapshot().drops);
    if (power_.mode == Mode::COORD && power_.isReady() && isOfPath) {
        now.wanted |= static_cast<std::uint32_t>(wish);
    }
    const IndexerEvent event = motion::step(indexers_, now);
    if (event.fault == LockFault::LOCKED_IN_MOVE) {
        stop_category_0(FaultKind::INDEXER_LOCKED_IN_MOVE, event.joint);
    } else if (event.fault != LockFault::NONE) {
        raise(event.fault == LockFault::NOT_LOCKED ? FaultKind::INDEXER_NOT_LOCKED
                                                   : FaultKind::INDEXER_NOT_UNLOCKED,
              event.joint);
        executor_.drop();
        stop(jogs_);
        isCoordError_ = true;
    }
}

void Controller::output_joints() noexcept {
    for (std::uint32_t off = output(joints_, settings_, power_.isEnabled, config_.period_s); off != 0;
         off &= off - 1) {
        const int j = std::countr_zero(off);
        jogs_.at({true, j}).planner.reset(joints_[j].pos_fb);
    }
    if (power_.isEnabled) [[likely]] {
        return;
    }
    follow_joints(place_, kinematics_, commanded(joints_).data(), place_.isFbValid);
    const geometry::Pose pose = without(offsets_, place_.cmd);
    executor_.set_position(pose);
    reset_axes(jogs_, pose);
}

}  // namespace mw::motion
