// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/homing_stage.hh"

#include <bit>

#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

homing::JointInput homing_input(const JointInputs &pins, const Joint &joint, const Jog &jog,
                                const MotionLimits &limits) noexcept {
    homing::JointInput out;
    out.isSwitchClosed = pins.isHomeSwitchClosed;
    out.isIndexEnabled = pins.isIndexEnabled;
    out.isUnlocked = pins.isUnlocked;
    out.isAtRest = jog.isAtRest();
    out.pos_cmd = joint.pos_cmd;
    out.pos_fb = joint.pos_fb;
    out.vel_cmd = joint.vel_cmd;
    out.motor_pos_fb = joint.motor_pos_fb;
    out.motor_offset = joint.motor_offset;
    out.max_velocity = limits.velocity;
    out.max_acceleration = limits.acceleration;
    out.max_jerk = limits.jerk;
    out.isOnPosLimit = joint.isOnPosHardLimit;
    out.isOnNegLimit = joint.isOnNegHardLimit;
    return out;
}

/// [TRAJ]HOME
geometry::Pose home_pose(const Settings &settings) noexcept {
    geometry::Pose pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = settings.get(Parameter::AXIS_FIRST_PLACE, axis);
    }
    return pose;
}

[[gnu::cold]] void start_homing(ControllerParts &parts, const Inputs &in) noexcept {
    parts.extra.hold();
    const bool isMoving = isAnythingMoving(parts) || !parts.extra.areAtRest() || parts.indexers.busy() != 0;
    const HomeConditions conditions{true, parts.power.mode(), in.isHomingInhibited, isMoving,
                                    parts.joints.inactive()};
    const homing::Failure why = parts.homing.begin_due(conditions);
    if (why != homing::Failure::NONE) {
        parts.raise(FaultKind::HOMING_FAILED, parts.homing.due_joint(), 0, static_cast<std::uint16_t>(why));
    }
}

/// One cycle of the joints that are being homed.
[[gnu::cold]] void command_homing(ControllerParts &parts, const Inputs &in) noexcept {
    const FoldedLimits &limits = parts.model.limits();
    const int num_joints = parts.model.num_joints();
    homing::JointInput inputs[MAX_JOINTS];
    homing::JointCommand commands[MAX_JOINTS];
    for (int j = 0; j < num_joints; ++j) {
        const auto n = static_cast<std::size_t>(j);
        inputs[j] = homing_input(in.joint[n], parts.joints[j], parts.jogs.at({true, j}), limits.joint_jog[n]);
    }
    if (!parts.homing.step(inputs, commands)) {
        parts.jogs.stop();
        parts.raise(FaultKind::HOMING_FAILED, -1, 0,
                    static_cast<std::uint16_t>(homing::Failure::MODULE_NONSENSE));
        return;
    }
    for (int j = 0; j < num_joints; ++j) {
        const homing::JointCommand &c = commands[j];
        const Joint &joint = parts.joints[j];
        Jog &jog = parts.jogs.at({true, j});
        if (c.isShifting) {
            parts.joints.shift(j, c.shift);
            jog.renumber(joint.pos_cmd, c.shift);
        } else if (c.isSettingZero) {
            parts.joints.set_zero(j, c.zero);
            jog.renumber(joint.pos_cmd, joint.pos_cmd - jog.motion().position);
        }
        jog.home(c, limits.joint_jog[static_cast<std::size_t>(j)]);
    }
}

}  // namespace

void step_homing(ControllerParts &parts, const Inputs &in) noexcept {
    HomingDrive &homing = parts.homing;
    if (homing.isDue()) [[unlikely]] {
        start_homing(parts, in);
    }
    if (homing.hasWork()) [[unlikely]] {
        command_homing(parts, in);
    }
    const HomingFailure failure = homing.take_failure();
    if (failure.why != homing::Failure::NONE) [[unlikely]] {
        parts.raise(FaultKind::HOMING_FAILED, failure.joint, 0, static_cast<std::uint16_t>(failure.why));
    }
    for (std::uint32_t clamped = homing.take_clamped(); clamped != 0; clamped &= clamped - 1) {
        parts.raise(FaultKind::HOMING_CLAMPED, std::countr_zero(clamped));
    }
    const MachineModel &model = parts.model;
    const bool isOtherMap = parts.offsets.shared().joints != 0 && !model.map().isAsIn(model.kinematics());
    if (model.limits().homed.joints != homing.homed_joints() || isOtherMap) [[unlikely]] {
        if (parts.power.mode() == Mode::FREE && homing.isAllHomed()) {
            // In other modes the pose commands the joints.
            parts.position.find_again(model.kinematics(), parts.joints.commanded().data(),
                                      home_pose(model.settings()));
        }
        parts.publish_limits();
    }
}

}  // namespace mw::motion
