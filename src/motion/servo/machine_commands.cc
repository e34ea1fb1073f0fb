// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/machine_commands.hh"

#include <algorithm>

#include "motion/servo/compensation.hh"
#include "motion/servo/jog_stage.hh"
#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

/// Passes the new value to the parts that depend on the setting.
void apply(ControllerParts &parts, const SetParameter &command) noexcept {
    const Settings &settings = parts.model.settings();
    if (PARAMETERS[command.parameter].scope == ParameterScope::JOINT) {
        parts.homing.configure(command.index, settings);
    }
    const Parameter changed = PARAMETERS[command.parameter].parameter;
    if (changed == Parameter::MAX_FEED_SCALE || changed == Parameter::TRAJ_PLANNER_TYPE) {
        for (int j = 0; j < parts.model.num_joints(); ++j) {
            parts.homing.set_clearance(j, settings);
        }
    }
    const bool isHomePose = changed == Parameter::AXIS_FIRST_PLACE;
    if (isHomePose && !parts.model.map().areJointsAxes() && parts.model.limits().homed.joints == 0) {
        parts.position.assume(command.index, command.value);
    }
}

}  // namespace

CommandResult take(ControllerParts &parts, const Enable &, const Inputs &in) noexcept {
    if (!in.isEnableOn) {
        return {Reason::EXTERNAL_ENABLE_OFF};
    }
    if (parts.power.isEnabled()) {
        return {parts.power.isStopping() ? Reason::MOVING : Reason::NONE};
    }
    const CommandResult start = parts.joints.check_start(in, parts.jogs.areLimitsOverridden());
    if (start.reason != Reason::NONE) {
        return start;
    }
    const CommandResult mode = motion_mode(parts.power.mode()).enter(parts);
    if (mode.reason != Reason::NONE) {
        const bool isMisaligned = mode.reason == Reason::SIDE_APART;
        parts.raise(isMisaligned ? FaultKind::SIDE_APART : FaultKind::POSE_UNKNOWN, mode.index);
        parts.power.set_mode(Mode::FREE);  // each joint moves by itself
    }
    parts.power.switch_on();
    parts.joints.switch_on();
    parts.offsets.start_at_zero(in);
    parts.jogs.start_at(parts.joints.commanded().data(), parts.position.cmd(), in);
    parts.indexers.switch_on(unlocked_pins(in));
    parts.extra.switch_on(extra_inputs(parts, in));
    parts.coord_error = false;
    parts.restart_path(parts.position.cmd());
    parts.publish_joint_start();
    return {};
}

CommandResult take(ControllerParts &parts, const SetMode &command) noexcept {
    const Mode mode = command.mode;
    const bool isOffsetMoving = mode == Mode::FREE && !parts.offsets.isAtRest();
    const ModeConditions conditions{
        parts.homing.isUnderWay(), isAnythingMoving(parts) || isOffsetMoving || parts.indexers.busy() != 0,
        parts.model.kinematics().kind() != kinematics::Kind::IDENTITY, parts.homing.isAllHomed()};
    const Reason reason = parts.power.check_mode(mode, conditions);
    if (reason != Reason::NONE || mode == parts.power.mode()) {
        return {reason};
    }
    const CommandResult result = motion_mode(mode).enter(parts);
    if (result.reason != Reason::NONE) {
        return result;
    }
    const geometry::Pose pose = parts.programmed_pose();
    parts.restart_path(pose);
    parts.executor.hold(false);
    parts.jogs.rest_at(parts.joints.commanded().data(), pose);
    parts.holds.release();
    parts.power.set_mode(mode);
    parts.publish_joint_start();
    return {};
}

CommandResult take(ControllerParts &parts, const SetParameter &command) noexcept {
    if (parts.homing.isActive()) {
        return result_of(command.index, Reason::HOMING);
    }
    const Reason reason = parts.model.set(command);
    if (reason != Reason::NONE) {
        return result_of(command.index, reason);
    }
    apply(parts, command);
    parts.publish_limits();
    keep_jogs_within_limits(parts);
    return {};
}

CommandResult take(ControllerParts &parts, const SetNumJoints &command, const Inputs &in) noexcept {
    const int count = command.count;
    const int loaded = parts.joints.loaded();
    const kinematics::IdentityMap *identity = parts.model.kinematics().identity();
    const int least = identity != nullptr ? std::min(identity->num_joints, loaded) : 1;
    const int needed = parts.extra.count() > 0 ? loaded : least;  // extra joints are the last joints
    if (parts.power.isEnabled()) {
        return {Reason::SWITCHED_ON};
    }
    if (count > loaded) {
        return result_of(count - 1, Reason::NO_SUCH_JOINT);
    }
    if (count < needed) {
        return result_of(needed, Reason::TOO_FEW_JOINTS);
    }
    for (int j = count; j < parts.model.num_joints(); ++j) {
        parts.homing.unhome(j);
    }
    parts.use_joints(count);
    parts.joints.read_feedback(in);
    parts.leave_unknown_pose();
    return {};
}

CommandResult take(ControllerParts &parts, const SetJointActive &command) noexcept {
    const bool areAlone = !parts.power.isEnabled() || parts.power.mode() == Mode::FREE;
    const CommandResult result =
        parts.joints.take(command, {isAnythingMoving(parts), parts.homing.isUnderWay(), areAlone});
    if (areAlone) {  // the pose is now that of all joints, also for the next command
        const kinematics::Kinematics &kinematics = parts.model.kinematics();
        const bool isKnown = kinematics.kind() == kinematics::Kind::BOTH && parts.homing.isAllHomed();
        parts.position.follow_joints(kinematics, parts.joints.commanded().data(), isKnown);
    }
    return result;
}

CommandResult take(ControllerParts &parts, const Home &command, const Inputs &in) noexcept {
    const HomeConditions conditions{parts.power.isReady(), parts.power.mode(), in.isHomingInhibited, false,
                                    parts.joints.inactive()};
    const CommandResult result = parts.homing.take(command, conditions);
    if (result.reason == Reason::NONE) {
        parts.jogs.stop();
    }
    return result;
}

CommandResult take(ControllerParts &parts, const Unhome &command) noexcept {
    HomeConditions conditions{parts.power.isReady(), parts.power.mode(), false, isAnythingMoving(parts)};
    conditions.kept_while_on =
        parts.power.isEnabled() ? parts.extra.mask() & parts.model.limits().homed.joints : 0;
    const CommandResult result = parts.homing.take(command, conditions, parts.model.settings());
    if (result.reason == Reason::NONE) {
        parts.publish_limits();
        parts.leave_unknown_pose();
    }
    return result;
}

CommandResult take(ControllerParts &parts, const Abort &) noexcept {
    parts.brake();
    parts.holds.release();
    parts.coord_error = false;
    return {};
}

}  // namespace mw::motion
