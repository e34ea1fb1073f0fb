// SPDX-License-Identifier: GPL-2.0-or-later
// Immediate commands: each is answered with done, or rejected with a reason.
#include <algorithm>
#include <cmath>

#include "base/overloaded.hh"
#include "motion/servo/controller.hh"

namespace mw::motion {
namespace {

bool isPlaceKnown(const kinematics::Kinematics &kinematics, const geometry::Pose &pose, const Joints &joints,
                  const JointStepLimit &stride) noexcept {
    return kinematics.kind() != kinematics::Kind::BOTH ||
           isWithinOneStep(kinematics, pose, commanded(joints), stride);
}

/// An indexer is jogged only while nothing else moves, and nothing else moves meanwhile.
bool isBesideIndexer(const Jogs &jogs, const FoldedLimits &limits, const Indexers &indexers,
                     const JogTarget &target) noexcept {
    const std::uint32_t own = limits.locks_of(target);
    bool is = (busy(indexers) & ~own) != 0;
    const int count = target.isJoint ? jogs.num_joints : MAX_AXES;
    for (int i = 0; i < count; ++i) {
        const JogTarget other{target.isJoint, i};
        const bool areOne = own != 0 && (limits.locks_of(other) & own) != 0;
        const bool isLone = own != 0 || limits.locks_of(other) != 0;
        is = is || (i != target.index && !areOne && isLone && !jogs.at(other).planner.isAtRest());
    }
    return is;
}

/// Range of a jog of `target`.
JogRange range_of(const FoldedLimits &limits, const AxisMap &map, const ExternalOffsets &offsets,
                  const Joints &joints, const JogTarget &target) noexcept {
    JogRange range = jog_range(limits, map, target, commanded(joints).data());
    if (!target.isJoint) {
        narrow(range, offsets, target.index);
    }
    return range;
}

/// Reverse run ends at a stop, and where the spindle changed its direction, stopped or got another tool.
void forget_way(Retracing &retracing, const CommandBody &body) noexcept {
    const bool isChange =
        std::holds_alternative<SpindleOn>(body) || std::holds_alternative<SpindleOff>(body) ||
        std::holds_alternative<SpindleOrient>(body) || std::holds_alternative<SpindleBrake>(body) ||
        std::holds_alternative<SetToolOffset>(body) || std::holds_alternative<Abort>(body);
    if (isChange && !retracing.retrace.isAway()) {
        retracing.retrace.clear();
    }
}

CommandResult check(const SetToolOffset &command) noexcept {
    const bool isFinite = std::ranges::all_of(command.offset.c, [](double x) { return std::isfinite(x); });
    return {isFinite ? Reason::NONE : Reason::NOT_A_NUMBER};
}

}  // namespace

void Controller::handle_commands(const Inputs &in) noexcept {
    auto &answers = channels_->servo_answers;
    for (int n = 0; n < MAX_COMMANDS_PER_CYCLE; ++n) {
        // A command is taken only when its answer fits into the queue.
        const bool isRoom = answers.size() < answers.capacity();
        const Command *c = isRoom ? channels_->immediate.front() : nullptr;
        if (c == nullptr) {
            return;
        }
        Answer answer;
        answer.id = c->id;
        // Epochs are compared across their overflow.
        const bool isStale = static_cast<std::int32_t>(c->epoch - received_.epoch) < 0;
        if (isStale && !std::holds_alternative<Abort>(c->body)) {
            answer.kind = AnswerKind::STALE;
        } else {
            forget_way(retracing_, c->body);
            const CommandResult verdict = take(in, c->body);
            answer.kind = verdict.reason == Reason::NONE ? AnswerKind::DONE : AnswerKind::REFUSED;
            answer.reason = verdict.reason;
            answer.index = verdict.index;
        }
        answers.push(answer);
        received_.last_id = answer.id;
        channels_->immediate.drop();
    }
}

/// Every command has a handler here; a missing one does not compile.
CommandResult Controller::take(const Inputs &in, const CommandBody &body) noexcept {
    const Overloaded handlers{
        [&](const Abort &c) { return abort_all(c); },
        [&](const Enable &) { return enable(in); },
        [&](const Disable &) {
            disable();
            return CommandResult{};
        },
        [&](const SetMode &c) { return set_mode(c.mode); },
        [&](const SetParameter &c) { return set_parameter(c); },
        [&](const SetNumJoints &c) { return set_num_joints(in, c.count); },
        [&](const OneOf<SetAmplifier, LoadCompensation> auto &c) {
            return motion::take(joints_, c, power_.isEnabled);
        },
        [&](const SetJointActive &c) {
            const bool areAlone = !power_.isEnabled || power_.mode == Mode::FREE;
            const CommandResult verdict =
                motion::take(joints_, c, {isAnythingMoving(), homing_.isUnderWay(), areAlone});
            if (areAlone) {  // the pose is that of all joints from here, also for the next command
                const bool isKnown = kinematics_.kind() == kinematics::Kind::BOTH && isAllHomed(homing_);
                follow_joints(place_, kinematics_, commanded(joints_).data(), isKnown);
            }
            return verdict;
        },
        [&](const OneOf<SetWatchdog, Heartbeat> auto &c) { return motion::take(watchdog_, c); },
        [&](const OneOf<Pause, Resume, StepOnce, SetMaxVelocity> auto &c) { return motion::take(holds_, c); },
        [&](const SetReverse &c) {
            return motion::take(holds_, c, power_.mode == Mode::COORD && retracing_.retrace.hasWay());
        },
        [&](const SetScale &c) {
            return c.what == Scale::SPINDLE
                       ? motion::take(spindles_, c)
                       : motion::take(holds_, c, settings_.get(Parameter::MAX_FEED_SCALE));
        },
        [&](const SetSwitch &c) {
            return c.what == Switch::SPINDLE_OVERRIDE ? motion::take(spindles_, c) : motion::take(holds_, c);
        },
        [&](const OneOf<JogContinuous, JogIncremental, JogAbsolute> auto &c) {
            return motion::take(jogs_, c, situation_of(in, c.target));
        },
        [&](const OneOf<JogStop, OverrideLimits> auto &c) { return motion::take(jogs_, c); },
        [&](const SetTeleopVector &c) {
            std::array<JogSituation, MAX_AXES> situations;
            for (int i = 0; i < MAX_AXES; ++i) {
                situations[static_cast<std::size_t>(i)] = situation_of(in, {false, i});
            }
            return motion::take(jogs_, c, situations.data());
        },
        [&](const Home &c) {
            const HomeConditions conditions{power_.isReady(), power_.mode, in.isHomingInhibited, false,
                                            inactive_joints(joints_)};
            const CommandResult verdict = motion::take(homing_, c, conditions);
            if (verdict.reason == Reason::NONE) {
                stop(jogs_);
            }
            return verdict;
        },
        [&](const Unhome &c) {
            const HomeConditions conditions{
                power_.isReady(),   power_.mode, false,
                isAnythingMoving(), 0,           power_.isEnabled ? extra_.mask() & limits_.homed.joints : 0};
            const CommandResult verdict = motion::take(homing_, c, conditions, settings_);
            if (verdict.reason == Reason::NONE) {
                publish_limits();
                leave_lost_mode();
            }
            return verdict;
        },
        [&](const OneOf<SpindleOn, SpindleOrient> auto &c) {
            return motion::take(spindles_, c, power_.isEnabled);
        },
        [&](const OneOf<SpindleOff, SpindleBrake> auto &c) { return motion::take(spindles_, c); },
        [&](const OneOf<SetDigitalOutput, SetAnalogOutput> auto &c) { return motion::take(outputs_, c); },
        [](const SetToolOffset &c) { return check(c); },  // forget_way() does its work
        [&](const ClearProbeFlag &c) { return motion::take(probe_, c); },
    };
    return std::visit(handlers, body);
}

CommandResult Controller::abort_all(const Abort &command) noexcept {
    if (static_cast<std::int32_t>(command.new_epoch - received_.epoch) > 0) {
        received_.epoch = command.new_epoch;
    }
    abort(homing_, homing::event::ABORT);
    executor_.drop();
    stop(jogs_);
    hold(extra_);
    stop(alignment_);
    release(holds_);
    isCoordError_ = false;
    return {};
}

CommandResult Controller::enable(const Inputs &in) noexcept {
    if (!in.isEnableOn) {
        return {Reason::EXTERNAL_ENABLE_OFF};
    }
    if (power_.isEnabled) {
        return {power_.isStopping ? Reason::MOVING : Reason::NONE};
    }
    const CommandResult verdict = check_start(joints_, in, jogs_.areLimitsOverridden);
    if (verdict.reason != Reason::NONE) {
        return verdict;
    }
    if (power_.mode != Mode::FREE) {
        const CommandResult led = lead_joints();
        if (led.reason != Reason::NONE) {
            const bool isSideApart = led.reason == Reason::SIDE_APART;
            raise(isSideApart ? FaultKind::SIDE_APART : FaultKind::POSE_UNKNOWN, led.index);
            power_.mode = Mode::FREE;  // each joint moves by itself
        }
    }
    switch_on(power_);
    switch_on(joints_);
    start_at_zero(offsets_, in);
    start_at(jogs_, commanded(joints_).data(), place_.cmd, in);
    switch_on(indexers_, {0, 0, unlocked_pins(in), 0, config_.period_s});
    switch_on(extra_, extra_inputs(in, joints_, limits_, config_.period_s));
    isCoordError_ = false;
    executor_.drop();
    executor_.set_position(place_.cmd);
    retracing_.retrace.clear();
    publish_joint_start();
    return {};
}

void Controller::disable() noexcept {
    executor_.stop_now();
    stop_at_once(offsets_);
    forget(alignment_);
    switch_off(power_);
    release(holds_);
    switch_off(joints_);
    switch_off(indexers_);
    forget_sources(jogs_);
    switch_off(homing_, settings_);
    switch_off(spindles_);
    publish_limits();
    leave_lost_mode();
}

/// While off, joints that the kinematics needs have lost their homes: the joint positions of a pose are
/// unknown.
void Controller::leave_lost_mode() noexcept {
    const bool isKnown = kinematics_.kind() == kinematics::Kind::IDENTITY || isAllHomed(homing_);
    if (!power_.isEnabled && !isKnown) {
        power_.mode = Mode::FREE;
    }
}

/// In Cartesian modes the pose commands the joints. They must be at its joint positions, except for a small
/// difference that the alignment removes.
CommandResult Controller::lead_joints() noexcept {
    const bool isPlaced =
        map_.areJointsAxes() || isPlaceKnown(kinematics_, place_.cmd, joints_, stride_of(limits_, config_));
    PerJoint led = commanded(joints_);
    const bool isModelled =
        kinematics_.kind() == kinematics::Kind::IDENTITY || kinematics_.kind() == kinematics::Kind::BOTH;
    if (!isPlaced) {
        return {Reason::POSE_UNKNOWN};
    }
    if (!isModelled || !isAnswered(kinematics_.inverse(place_.cmd, led.data()))) {
        return {};
    }
    const int apart = map_.areJointsAxes() ? find_misaligned_joint(joints_, led, settings_) : -1;
    if (apart >= 0) {
        return result_of(apart, Reason::SIDE_APART);
    }
    begin(alignment_, joints_, led, limits_);
    return {};
}

CommandResult Controller::set_mode(Mode mode) noexcept {
    const bool isOffsetMoving = mode == Mode::FREE && !areAtRest(offsets_);
    const ModeConditions conditions{homing_.isUnderWay(),
                                    isAnythingMoving() || isOffsetMoving || busy(indexers_) != 0,
                                    kinematics_.kind() != kinematics::Kind::IDENTITY, isAllHomed(homing_)};
    const Reason reason = check_mode(power_, mode, conditions);
    if (reason != Reason::NONE || mode == power_.mode) {
        return {reason};
    }
    if (mode == Mode::FREE) {
        forget(alignment_);
    } else if (const CommandResult led = lead_joints(); led.reason != Reason::NONE) {
        return led;
    }
    executor_.drop();
    executor_.hold(false);
    const geometry::Pose pose = without(offsets_, place_.cmd);
    executor_.set_position(pose);
    retracing_.retrace.clear();
    rest_at(jogs_, commanded(joints_).data(), pose);
    release(holds_);
    power_.mode = mode;
    publish_joint_start();
    return {};
}

/// A joint that is taken out of use is not homed when it is used again; its position is then that of its
/// motor.
CommandResult Controller::set_num_joints(const Inputs &in, int count) noexcept {
    const kinematics::IdentityMap *identity = kinematics_.identity();
    const int least = identity != nullptr ? std::min(identity->num_joints, joints_.loaded) : 1;
    const int needed = extra_.count > 0 ? joints_.loaded : least;  // extra joints are the last ones
    if (power_.isEnabled) {
        return {Reason::SWITCHED_ON};
    }
    if (count > joints_.loaded) {
        return result_of(count - 1, Reason::NO_SUCH_JOINT);
    }
    if (count < needed) {
        return result_of(needed, Reason::TOO_FEW_JOINTS);
    }
    for (int j = count; j < config_.num_joints; ++j) {
        homing_.module().unhome(j);
    }
    use_joints(count);
    read_feedback(joints_, in);
    leave_lost_mode();
    return {};
}

CommandResult Controller::set_parameter(const SetParameter &command) noexcept {
    if (homing_.isActive()) {
        return result_of(command.index, Reason::HOMING);
    }
    const Reason reason = settings_.set(command, config_.num_joints, config_.num_spindles);
    if (reason != Reason::NONE) {
        return result_of(command.index, reason);
    }
    if (PARAMETERS[command.parameter].scope == ParameterScope::JOINT) {
        configure(homing_, command.index, settings_);
    }
    const Parameter changed = PARAMETERS[command.parameter].parameter;
    if (changed == Parameter::MAX_FEED_SCALE || changed == Parameter::TRAJ_PLANNER_TYPE) {
        for (int j = 0; j < config_.num_joints; ++j) {
            note_play(homing_, j, settings_);
        }
    }
    const bool isPlace = changed == Parameter::AXIS_FIRST_PLACE;
    if (isPlace && !map_.areJointsAxes() && limits_.homed.joints == 0) {
        place_.cmd[command.index] = command.value;
        place_.fb[command.index] = command.value;
    }
    publish_limits();
    for (int n = 0; n < config_.num_joints + MAX_AXES; ++n) {
        const bool isJoint = n < config_.num_joints;
        const JogTarget target{isJoint, isJoint ? n : n - config_.num_joints};
        keep_within(jogs_.at(target), range_of(limits_, map_, offsets_, joints_, target));
    }
    return {};
}

/// Conditions for a jog of `target`; without such a target the other fields have no meaning.
JogSituation Controller::situation_of(const Inputs &in, const JogTarget &target) const noexcept {
    JogSituation s;
    if (!hasTarget(jogs_, target)) {
        return s;
    }
    s.time_ns = in.time_ns;
    s.isReady = power_.isReady();
    s.mode = power_.mode;
    s.isHoming = homing_.isUnderWay();
    s.isInhibited = in.isJogInhibited || in.isJogStopped || in.isJogStoppedNow;
    s.isDriven = target.isJoint && (extra_.mask() & limits_.homed.joints & 1U << target.index) != 0;
    s.isMovable = target.isJoint ? joints_[target.index].isActive : map_.hasAxis(target.index);
    if (target.isJoint) {
        const Joint &joint = joints_[target.index];
        const double sequence = settings_.get(Parameter::JOINT_HOME_SEQUENCE, target.index);
        s.isSynchronised = sequence < 0 && sequence > -100;
        s.isOnPosLimit = joint.isOnPosHardLimit;
        s.isOnNegLimit = joint.isOnNegHardLimit;
    }
    s.isLocked = limits_.locks_of(target) != 0;
    s.isShared = !target.isJoint && !map_.areJointsAxes();
    s.isBesideIndexer = indexers_.mask != 0 && isBesideIndexer(jogs_, limits_, indexers_, target);
    s.most = limits_.jog(target);
    s.range = range_of(limits_, map_, offsets_, joints_, target);
    return s;
}

/// The joint positions decide the side of elbows and wrists on which paths are driven.
void Controller::publish_joint_start() noexcept {
    if (map_.areJointsAxes()) {
        return;
    }
    standing_.joints = commanded(joints_);
    ++standing_.count;
    publish_limits();
}

/// Limits of axes and joints folded together, for jogs and the path planner.
void Controller::publish_limits() noexcept {
    map_.set_linear(map_.kind == AxisMap::Kind::PLANNED ? kinematics_.linear() : kinematics::LinearJoints{});
    limits_ = fold_limits(settings_, map_, {homed_mask(homing_), isAllHomed(homing_)});
    configure(offsets_, limits_, map_);
    indexers_.mask = limits_.locks;
    PathLimits out;
    out.offset_axes = offsets_.axes;
    out.indexer = limits_.indexer;
    out.limits = limits_.path;
    out.low = limits_.low;
    out.high = limits_.high;
    out.axes = limits_.axes;
    out.joints = limits_.path_joints;
    out.shared = offsets_.shared;
    out.standing = standing_.joints;
    out.side = kinematics_.side(place_.cmd);
    out.position_changes = standing_.count;
    out.corner_scale = settings_.get(Parameter::TRAJ_CORNER_SCALE);
    out.areTolerancesAdded = settings_.isSet(Parameter::TRAJ_ADDED_TOLERANCES);
    link_->limits.write(out);
    ++limits_version_;
}

}  // namespace mw::motion
