// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/kinematics_switch.hh"

#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

/// The joints are stopped. They get the pose of the new type. If the type has no pose for them, the old type
/// stays.
[[gnu::cold]] void switch_type(ControllerParts &parts, kinematics::TypeSwitch &types) noexcept {
    const kinematics::Kinematics &kinematics = parts.model.kinematics();
    geometry::Pose pose = parts.position.cmd();
    bool isSwitched = types.switch_to(parts.types.wanted());
    if (!isSwitched) {
        parts.raise(FaultKind::NO_KINEMATICS_TYPE, -1, parts.types.wanted());
    } else if (parts.homing.isAllHomed()) {
        const PerJoint joints = parts.joints.commanded();
        const bool isKnown = isAnswered(kinematics.forward(joints.data(), pose)) &&
                             isWithinOneStep(kinematics, pose, joints, parts.model.joint_step_limit());
        if (!isKnown) {
            parts.raise(FaultKind::KINEMATICS_TYPE_WITHOUT_POSE, -1, parts.types.wanted());
            types.switch_to(parts.types.active());
            isSwitched = false;
        }
    }
    parts.types.settle(isSwitched);
    if (!isSwitched) {
        return;
    }
    parts.position.set_cmd(pose);
    parts.restart_path(pose);
    parts.jogs.rest_at(parts.joints.commanded().data(), pose);
    parts.publish_joint_start();
}

}  // namespace

void step_kinematics_type(ControllerParts &parts, const Inputs &in) noexcept {
    kinematics::TypeSwitch *types = parts.model.kinematics().type_switch();
    if (types == nullptr) [[likely]] {
        return;
    }
    TypeInputs now;
    now.pin = in.kinematics_type;
    now.isMoving = isAnythingMoving(parts) || parts.homing.isUnderWay();
    now.isOnPath = parts.power.mode() == Mode::COORD &&
                   (now.isMoving || parts.link->queue_depth.load(std::memory_order_relaxed) != 0);
    now.seen = parts.link->type_asks_seen.load(std::memory_order_acquire);
    switch (parts.types.step(now)) {
    case TypeStep::NONE:
    case TypeStep::WAIT: return;
    case TypeStep::NO_SUCH_TYPE: parts.raise(FaultKind::NO_KINEMATICS_TYPE, -1, in.kinematics_type); return;
    case TypeStep::ON_PATH:
        parts.raise(FaultKind::KINEMATICS_SWITCHED_ON_PATH, -1, in.kinematics_type);
        parts.executor.drop();
        parts.coord_error = true;
        return;
    case TypeStep::SWITCH: switch_type(parts, *types); return;
    }
}

}  // namespace mw::motion
