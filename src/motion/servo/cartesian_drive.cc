// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/cartesian_drive.hh"

#include "motion/servo/probe_stage.hh"

namespace mw::motion {

void step_alignment(ControllerParts &parts, const Inputs &in) noexcept {
    check_probe(parts, in);
    parts.executor.step(parts.cycle);
    const bool isWanted = parts.link->queue_depth.load(std::memory_order_relaxed) != 0 ||
                          !parts.jogs.areAxesAtRest() || parts.offsets.isMotionRequested(in.axis_offset);
    const AlignmentStep result = parts.alignment.step(parts.joints, isWanted, parts.model.period_s());
    if (result == AlignmentStep::STOPPED) {
        parts.power.set_mode(Mode::FREE);  // each joint moves by itself
        parts.jogs.rest_at(parts.joints.commanded().data(), parts.programmed_pose());
    }
}

geometry::Pose add_offsets(ControllerParts &parts, const Inputs &in, const geometry::Pose &pose,
                           const TravelRange &programmed) noexcept {
    ExternalOffsets &offsets = parts.offsets;
    OffsetInputs inputs{in.axis_offset, parts.model.limits(), programmed};
    inputs.programmed.include(offsets.extend_travelled(pose, parts.retracing.isEmpty()));
    inputs.isHonoured = parts.power.isReady() && parts.model.limits().homed.areAll;
    inputs.period_s = parts.model.period_s();
    offsets.step(inputs);
    return pose + offsets.pose();
}

void command_pose(ControllerParts &parts, const geometry::Pose &pose) noexcept {
    const MachineModel &model = parts.model;
    const PerJoint here = parts.joints.commanded();
    PerJoint positions = here;
    if (!isAnswered(model.kinematics().inverse(pose, positions.data()))) [[unlikely]] {
        // The planner avoids such poses. If one occurs, no valid command is possible.
        parts.stop_category_0(FaultKind::KINEMATICS_FAILED, -1);
        return;
    }
    const bool isPlanned = model.map().kind == AxisMap::Kind::PLANNED;
    const int jump = isPlanned ? joint_that_jumps(positions, here, model.joint_step_limit()) : -1;
    if (jump >= 0) [[unlikely]] {
        const double distance = positions[static_cast<std::size_t>(jump)] - parts.joints[jump].pos_cmd;
        parts.stop_category_0(FaultKind::KINEMATICS_JUMP, jump, distance);
        return;
    }
    parts.position.follow_pose(pose, model.period_s());
    for (int j = 0; j < model.num_pose_joints(); ++j) {
        const auto n = static_cast<std::size_t>(j);
        parts.joints.follow(j, positions[n], model.period_s());
        parts.jogs.at({true, j}).reset(positions[n]);
    }
}

void fire_outputs(ControllerParts &parts) noexcept {
    constexpr int MAX_EVENTS_PER_CYCLE = 64;
    trajectory::Executor &executor = parts.executor;
    for (int n = 0; n < MAX_EVENTS_PER_CYCLE; ++n) {
        const trajectory::PathEvent *event = executor.due_event();
        if (event == nullptr) [[likely]] {
            return;
        }
        parts.outputs.fire(*event, executor.snapshot().isDropping);
        executor.drop_event();
    }
}

}  // namespace mw::motion
