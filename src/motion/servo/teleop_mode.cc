// SPDX-License-Identifier: GPL-2.0-or-later
// Teleop mode: each axis follows its jog, and the joints follow the pose.
#include <bit>

#include "motion/servo/cartesian_drive.hh"
#include "motion/servo/motion_mode.hh"
#include "motion/servo/probe_stage.hh"

namespace mw::motion {
namespace {

/// Bit per axis that a closed lock holds.
std::uint32_t locked_axes(const FoldedLimits &limits, std::uint32_t locked) noexcept {
    std::uint32_t axes = 0;
    for (int i = 0; i < MAX_AXES && locked != 0; ++i) {
        axes |= (limits.axis_locks[static_cast<std::size_t>(i)] & locked) != 0 ? 1U << i : 0U;
    }
    return axes;
}

/// If joints are not axes, the joints limit the combined motion of the axes.
void step_axes_together(ControllerParts &parts, std::uint32_t locked) noexcept {
    const MachineModel &model = parts.model;
    PerJoint joint_positions = parts.joints.commanded();
    trajectory::JointLimits joint_limits = model.limits().path_joints;
    parts.offsets.remove_from(joint_positions, joint_limits);
    const TeleopMachine machine{model.kinematics(),
                                model.limits(),
                                joint_limits,
                                joint_positions,
                                model.num_pose_joints(),
                                parts.holds.jog_scale(),
                                model.period_s(),
                                model.kinematics().side(parts.position.cmd()),
                                locked};
    const TeleopStop stopped = parts.jogs.step_teleop(machine);
    if (stopped.isNew && stopped.joint >= 0) {
        parts.raise(FaultKind::JOG_JOINT_LIMIT, stopped.joint);
    } else if (stopped.isNew) {
        parts.raise(FaultKind::JOG_UNREACHABLE, model.num_pose_joints());
    }
}

/// Moves the axes for one cycle and returns their pose.
geometry::Pose jogged_pose(ControllerParts &parts) noexcept {
    const FoldedLimits &limits = parts.model.limits();
    const bool areJointsAxes = parts.model.map().areJointsAxes();
    const std::uint32_t locked = locked_axes(limits, parts.indexers.held());
    if (!areJointsAxes) {
        step_axes_together(parts, locked);
    }
    geometry::Pose pose;
    for (int i = 0; i < MAX_AXES; ++i) {
        Jog &jog = parts.jogs.at({false, i});
        if (areJointsAxes) {
            jog.limit(limits.jog({false, i}).velocity, parts.holds.jog_scale());
            if ((locked & 1U << i) == 0) {
                jog.step(parts.model.period_s());
            }
        }
        pose[i] = jog.motion().position;
    }
    return pose;
}

/// Range that the jogs may reach without external offsets.
TravelRange jogged_range(const Jogs &jogs, const geometry::Pose &pose, const SharedJoints &shared) noexcept {
    TravelRange out{{pose, pose}, shared.at(pose)};
    PoseRange stops{pose, pose};
    for (int i = 0; i < MAX_AXES; ++i) {
        jogs.at({false, i}).motion().add_reach(out.axes.low[i], out.axes.high[i]);
        // A jog may need a longer stopping distance if the joints permit less.
        constexpr double MARGIN = 1.2;
        stops.low[i] += MARGIN * (out.axes.low[i] - pose[i]);
        stops.high[i] += MARGIN * (out.axes.high[i] - pose[i]);
    }
    out.joints.include(shared.within(stops));
    return out;
}

}  // namespace

CommandResult TeleopMode::enter(ControllerParts &parts) const noexcept {
    return parts.align_joints();
}

void TeleopMode::step(ControllerParts &parts, const Inputs &in) const noexcept {
    if (parts.alignment.isMisaligned()) [[unlikely]] {
        step_alignment(parts, in);
        return;
    }
    parts.executor.step(parts.cycle);
    geometry::Pose pose = jogged_pose(parts);
    if (!parts.offsets.isEmpty()) [[unlikely]] {
        pose = add_offsets(parts, in, pose, jogged_range(parts.jogs, pose, parts.offsets.shared()));
    }
    check_probe(parts, in);
    command_pose(parts, pose);
    fire_outputs(parts);
}

bool TeleopMode::isJogging(const ControllerParts &parts) const noexcept {
    return !parts.jogs.areAxesAtRest();
}

JogGroup TeleopMode::jog_group(const ControllerParts &) const noexcept {
    return {false, MAX_AXES};
}

std::uint32_t TeleopMode::locks_wanted(const ControllerParts &parts) const noexcept {
    std::uint32_t wanted = 0;
    for (std::uint32_t left = parts.jogs.axes(); left != 0; left &= left - 1) {
        const JogTarget axis{false, std::countr_zero(left)};
        wanted |= parts.jogs.at(axis).isAtRest() ? 0U : parts.model.limits().locks_of(axis);
    }
    return wanted;
}

}  // namespace mw::motion
