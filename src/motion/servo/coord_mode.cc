// SPDX-License-Identifier: GPL-2.0-or-later
// Coord mode: the pose follows the path, and the joints follow the pose.
#include "motion/servo/cartesian_drive.hh"
#include "motion/servo/motion_mode.hh"
#include "motion/servo/probe_stage.hh"

namespace mw::motion {
namespace {

/// Records the path for reverse run.
void record_path(ControllerParts &parts, const geometry::Pose &pose) noexcept {
    const RetraceLimits limits = parts.model.retrace_limits();
    const double t = limits.period_s;
    for (int j = 0; j < limits.joints; ++j) {
        const Joint &joint = parts.joints[j];
        parts.retracing.record_joint(j, joint.vel_cmd * t, joint.acc_cmd * t * t);
    }
    parts.retracing.record(pose, limits);
}

/// The pose of the path, or behind it in reverse run.
geometry::Pose path_pose(ControllerParts &parts) noexcept {
    trajectory::Executor &executor = parts.executor;
    const Holds &holds = parts.holds;
    const trajectory::ExecutorOutput &path = executor.step(parts.cycle);
    geometry::Pose pose = path.position;
    if (path.tap.isLost) [[unlikely]] {
        parts.stop_category_1(FaultKind::TAP_LOST, path.tap.spindle);
    }
    // A path that has ended keeps its position. Programs that wait rely on it.
    const bool isPathHeld = executor.isAtRest() && !executor.isEmpty();
    const RetraceInputs in{executor.snapshot().drops,
                           holds.isReverseWanted(),
                           holds.isHoldWanted(),
                           parts.power.isStopping(),
                           isPathHeld,
                           holds.reverse_rate()};
    const RetraceLimits limits = parts.model.retrace_limits();
    const double t = limits.period_s;
    for (int j = 0; j < limits.joints && parts.retracing.isMoving(); ++j) {
        parts.retracing.follow_joint(j, parts.joints[j].vel_cmd * t, parts.joints[j].acc_cmd * t * t);
    }
    if (parts.retracing.step(pose, in, limits)) [[unlikely]] {
        executor.set_position(pose);
    }
    return pose;
}

/// Range that the path may reach without external offsets.
TravelRange path_range(const PathLink &link, const geometry::Pose &pose,
                       const SharedJoints &shared) noexcept {
    constexpr int TRIES = 1000;
    TravelRange out{{pose, pose}, shared.at(pose)};
    PathExtent path;
    if (link.extent.read(path, TRIES) && !path.isEmpty) {
        out.include(path.range);
    }
    return out;
}

/// If the planner cannot call this kinematics module, joint limits are checked here, and a violation stops
/// the machine.
void check_joint_limits(ControllerParts &parts) noexcept {
    const bool isPlanned = parts.model.map().kind != AxisMap::Kind::UNKNOWN;
    const Overrun overrun =
        isPlanned || !parts.power.isReady() ? Overrun{} : parts.joints.find_overrun(parts.model.limits());
    if (overrun.joint >= 0) [[unlikely]] {
        parts.stop_category_1(overrun.isOutside ? FaultKind::JOINT_LEFT_RANGE : FaultKind::JOINT_TOO_FAST,
                              overrun.joint, overrun.use);
    }
}

/// Keeps the recorded path as far back as reverse run may go.
void update_recorded_path(ControllerParts &parts, const geometry::Pose &pose) noexcept {
    if (parts.retracing.isAway()) {
        return;
    }
    // Reverse run does not pass a tapped hole or a thread without synchronization, nor a lock.
    const bool isOneWay = parts.executor.output().tap.spindle >= 0 || parts.executor.locked_spindle() >= 0 ||
                          parts.indexers.busy() != 0;
    // External offsets are not part of the recorded path, so it is recorded only if needed.
    const bool isWanted = parts.holds.isAdaptiveFeedEnabled() || parts.offsets.isEmpty();
    if (isWanted && !isOneWay) {
        record_path(parts, pose);
    } else {
        parts.retracing.clear();
    }
}

}  // namespace

CommandResult CoordMode::enter(ControllerParts &parts) const noexcept {
    return parts.align_joints();
}

void CoordMode::step(ControllerParts &parts, const Inputs &in) const noexcept {
    if (parts.alignment.isMisaligned()) [[unlikely]] {
        step_alignment(parts, in);
        return;
    }
    const geometry::Pose pose = path_pose(parts);
    geometry::Pose target = pose;
    if (!parts.offsets.isEmpty()) [[unlikely]] {
        target = add_offsets(parts, in, pose, path_range(*parts.link, pose, parts.offsets.shared()));
    }
    check_probe(parts, in);
    command_pose(parts, target);
    if (parts.power.mode() == Mode::COORD) [[likely]] {  // a stop may have changed the mode
        const bool areJointsAxes = parts.model.map().areJointsAxes();
        if (!areJointsAxes && parts.joint_start.hasDropped(parts.executor.snapshot())) [[unlikely]] {
            parts.publish_joint_start();
        }
        check_joint_limits(parts);
        update_recorded_path(parts, pose);
    }
    fire_outputs(parts);
}

bool CoordMode::isJogging(const ControllerParts &) const noexcept {
    return false;
}

JogGroup CoordMode::jog_group(const ControllerParts &) const noexcept {
    return {};
}

/// Requests of the planner for a dropped path are ignored.
std::uint32_t CoordMode::locks_wanted(const ControllerParts &parts) const noexcept {
    const std::uint64_t request = parts.link->indexers_wanted.load(std::memory_order_acquire);
    const bool isOfPath = static_cast<std::uint32_t>(request >> 32) ==
                          static_cast<std::uint32_t>(parts.executor.snapshot().drops);
    return parts.power.isReady() && isOfPath ? static_cast<std::uint32_t>(request) : 0U;
}

}  // namespace mw::motion
