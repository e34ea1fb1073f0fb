// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/parts.hh"

#include <algorithm>
#include <memory>

namespace mw::motion {

ControllerParts::ControllerParts(const ControllerConfig &config, const kinematics::Kinematics &kinematics,
                                 Channels &channels_used, PathLink &link_used) noexcept
    : channels(&channels_used), link(&link_used), model(config, kinematics), joints(config.num_joints),
      homing(config.period_s, config.homing), spindles(config.num_spindles),
      outputs(config.num_dio, config.num_aio), executor(link_used.store, config.period_s) {
    use_joints(config.num_joints);
    jogs.set_axes(model.limits().axes);  // the number of joints never grows after this
    const kinematics::IdentityMap *identity = kinematics.identity();
    const int count = config.num_pose_joints();
    for (int j = identity != nullptr ? identity->num_joints : count; j < count; ++j) {
        joints.deactivate(j);
    }
}

ControllerParts::ControllerParts(const ControllerParts &other, Channels &channels_used,
                                 PathLink &link_used) noexcept
    : ControllerParts(other) {
    channels = &channels_used;
    link = &link_used;
    std::construct_at(&executor, other.executor, link_used.store);
}

void ControllerParts::use_joints(int count) noexcept {
    const kinematics::IdentityMap *identity = model.kinematics().identity();
    model.use_joints(count);
    joints.use_joints(count);
    jogs.use_joints(count);
    extra.use_joints(count - model.num_extra_joints(), model.num_extra_joints());
    const int num_to_home =
        identity != nullptr && extra.count() == 0 ? std::min(identity->num_joints, count) : count;
    homing.use_joints(count, num_to_home);
    const AxisMap &map = model.map();
    for (int j = 0; j < count; ++j) {
        homing.set_axis(j, map.areJointsAxes() ? map.axis_of_joint[static_cast<std::size_t>(j)] : -1);
    }
    publish_limits();
}

void ControllerParts::raise(FaultKind kind, int index, double value, std::uint16_t detail) noexcept {
    Fault fault;
    fault.kind = kind;
    fault.index = static_cast<std::int16_t>(index);
    fault.value = value;
    fault.detail = detail;
    if (const trajectory::MoveTag *tag = active_move()) {
        fault.source = {tag->line, tag->file_index, tag->block};
    }
    channels->servo_faults.push(
        fault);  // if the ring is full, the first faults are kept, which are the important ones
}

void ControllerParts::stop_category_0(FaultKind kind, int index, double value) noexcept {
    if (power.isEnabled()) {
        raise(kind, index, value);
    }
    switch_off();
}

void ControllerParts::stop_category_1(FaultKind kind, int index, double value) noexcept {
    if (power.begin_stop()) {
        raise(kind, index, value);
        brake();
        offsets.stop();
    }
}

void ControllerParts::brake() noexcept {
    homing.abort(homing::event::ABORT);
    executor.drop();
    jogs.stop();
    alignment.stop();
    extra.hold();
}

void ControllerParts::switch_off() noexcept {
    executor.stop_now();
    offsets.stop_at_once();
    alignment.cancel();
    power.switch_off();
    holds.release();
    joints.switch_off();
    indexers.switch_off();
    jogs.forget_sources();
    homing.switch_off(model.settings());
    spindles.switch_off();
    publish_limits();
    leave_unknown_pose();
}

void ControllerParts::leave_unknown_pose() noexcept {
    const bool isKnown = model.kinematics().kind() == kinematics::Kind::IDENTITY || homing.isAllHomed();
    if (!power.isEnabled() && !isKnown) {
        power.set_mode(Mode::FREE);
    }
}

const trajectory::MoveTag *ControllerParts::active_move() const noexcept {
    const trajectory::Sequence move = executor.output().move;
    return power.mode() == Mode::COORD && move != 0 ? &link->store.move(move) : nullptr;
}

CommandResult ControllerParts::align_joints() noexcept {
    const kinematics::Kinematics &kinematics = model.kinematics();
    const bool areJointsAxes = model.map().areJointsAxes();
    const kinematics::Kind kind = kinematics.kind();
    const bool isPoseKnown =
        areJointsAxes || kind != kinematics::Kind::BOTH ||
        isWithinOneStep(kinematics, position.cmd(), joints.commanded(), model.joint_step_limit());
    if (!isPoseKnown) {
        return {Reason::POSE_UNKNOWN};
    }
    PerJoint targets = joints.commanded();
    const bool hasInverse = kind == kinematics::Kind::IDENTITY || kind == kinematics::Kind::BOTH;
    if (!hasInverse || !isAnswered(kinematics.inverse(position.cmd(), targets.data()))) {
        return {};
    }
    const int misaligned = areJointsAxes ? find_misaligned_joint(joints, targets, model.settings()) : -1;
    if (misaligned >= 0) {
        return result_of(misaligned, Reason::SIDE_APART);
    }
    alignment.begin(joints, targets, model.limits());
    return {};
}

void ControllerParts::restart_path(const geometry::Pose &pose) noexcept {
    executor.drop();
    executor.set_position(pose);
    retracing.clear();
}

void ControllerParts::publish_joint_start() noexcept {
    if (model.map().areJointsAxes()) {
        return;
    }
    joint_start.set(joints.commanded());
    publish_limits();
}

void ControllerParts::publish_limits() noexcept {
    model.fold({homing.homed_joints(), homing.isAllHomed()});
    const FoldedLimits &limits = model.limits();
    offsets.configure(limits, model.map());
    indexers.set_joints(limits.locks);
    PathLimits out;
    out.offset_axes = offsets.axes();
    out.indexer = limits.indexer;
    out.limits = limits.path;
    out.low = limits.low;
    out.high = limits.high;
    out.axes = limits.axes;
    out.joints = limits.path_joints;
    out.shared = offsets.shared();
    out.start_joints = joint_start.joints();
    out.side = model.kinematics().side(position.cmd());
    out.position_changes = joint_start.changes();
    out.corner_scale = model.settings().get(Parameter::TRAJ_CORNER_SCALE);
    link->limits.write(out);
}

}  // namespace mw::motion
