// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/status_writer.hh"

#include <algorithm>
#include <atomic>

#include "motion/servo/motion_mode.hh"

namespace mw::motion {
namespace {

/// Parts that may differ from the last cycle. Values that seldom change are compared only if they may have
/// been changed.
PartMask new_parts(const PublishedStatus &published, Outputs &out) noexcept {
    const Status &s = out.status;
    PartMask seldom = 0;
    if (out.touched != 0) [[unlikely]] {
        seldom = published.changed(s, out.touched);
        out.touched = 0;
    }
    return part_range(status_part::WHOLE_MACHINE, 1) | part_range(status_part::JOINTS, s.num_joints) |
           part_range(status_part::SPINDLES, s.num_spindles) | seldom;
}

/// A loaded joint that is not in use: its drive gets no command.
void fill_unused(const JointInputs &in, int j, Outputs &out) noexcept {
    const auto n = static_cast<std::size_t>(j);
    out.status.joint[n] = {};
    out.settings_version = 0;  // its limits are published again when it is in use
    out.status.joint[n].motor_pos_fb = in.motor_pos_fb;
    out.joint[n] = {};
    out.joint[n].motor_pos_cmd = in.motor_pos_fb;
}

/// `sample` gets the values that are not in the status.
void trace(Channels &channels, const Status &s, const Joints &joints, TraceSample &sample) noexcept {
    sample.cycle = s.cycle;
    sample.path_id = s.active_path_id;
    sample.line = s.source.line;
    sample.epoch = s.epoch;
    sample.carte_pos_cmd = s.carte_pos_cmd;
    sample.joint_pos_cmd = joints.commanded();
    bool isAllOn = s.isEnabled;
    for (int j = 0; j < s.num_joints; ++j) {
        isAllOn = isAllOn && (joints[j].isAmpWanted || !joints[j].isActive);
    }
    sample.isEnabled = isAllOn ? 1 : 0;
    if (!channels.trace.push(sample)) {
        channels.trace_lost.fetch_add(1, std::memory_order_relaxed);
    }
}

/// Values of the settings.
void fill_settings(const Settings &settings, Outputs &out) noexcept {
    Status &s = out.status;
    for (int j = 0; j < s.num_joints; ++j) {
        JointStatus &joint = s.joint[static_cast<std::size_t>(j)];
        joint.min_limit = settings.get(Parameter::JOINT_MIN_LIMIT, j);
        joint.max_limit = settings.get(Parameter::JOINT_MAX_LIMIT, j);
        joint.max_velocity = settings.get(Parameter::JOINT_MAX_VELOCITY, j);
        joint.max_acceleration = settings.get(Parameter::JOINT_MAX_ACCELERATION, j);
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        AxisStatus &axis = s.axis[static_cast<std::size_t>(i)];
        axis.min_limit = settings.get(Parameter::AXIS_MIN_LIMIT, i);
        axis.max_limit = settings.get(Parameter::AXIS_MAX_LIMIT, i);
    }
    out.touched |= part_range(status_part::AXES, 1);
    out.mm_per_unit = settings.get(Parameter::TRAJ_MM_PER_UNIT);
    out.settings_version = settings.version();
}

/// Without motion, directions keep their values.
void fill_heading(const trajectory::PathStore &store, std::uint64_t move, const geometry::Pose &place,
                  Outputs &out) noexcept {
    const Status &s = out.status;
    Heading &heading = out.heading;
    const HeadingOrigin origin{s.active_path_id, s.active_path_id != 0 ? move : 0, s.motion_type,
                               s.isReverse};
    if (origin == heading.origin && (!heading.isArc || origin.path_id == 0)) [[likely]] {
        return;
    }
    if (origin.path_id != 0) {
        heading = heading_of(store.primitive(move), s.motion_type, place, s.isReverse, heading);
    } else {
        heading = {{}, 0, heading.direction_deg, heading.to_centre_deg, false, 0, {}};
    }
    heading.origin = origin;
}

/// Writes the executed move and the rest of the path. `programmed`: the position without external offsets.
[[gnu::hot]] void fill_path(const ControllerParts &parts, const geometry::Pose &programmed,
                            Status &s) noexcept {
    s.queue_depth = parts.link->queue_depth.load(std::memory_order_relaxed);
    s.isQueueFull = parts.link->isQueueFull.load(std::memory_order_relaxed) != 0;
    s.last_path_id = parts.link->last_done_id.load(std::memory_order_acquire);
    s.isInPosition = !isAnythingMoving(parts) && parts.indexers.busy() == 0 &&
                     (parts.power.mode() != Mode::COORD || s.queue_depth == 0) && !parts.types.isPending();
    s.current_velocity = parts.position.velocity();
    const trajectory::MoveTag *tag = parts.active_move();
    if (tag == nullptr) {
        s.active_path_id = 0;
        s.source = {};
        s.motion_type = MotionType::NONE;
        s.requested_velocity = 0;
        s.distance_to_go = 0;
        s.dtg = {};
        s.isProbing = false;
        return;
    }
    const trajectory::ExecutorOutput &e = parts.executor.output();
    s.active_path_id = tag->id;
    s.source = {tag->line, tag->file_index, tag->block};
    s.motion_type = static_cast<MotionType>(tag->type);
    s.current_velocity = e.velocity / tag->feed_ratio;
    s.requested_velocity = tag->requested_velocity;
    s.distance_to_go = e.distance_to_go / tag->feed_ratio;
    s.dtg = tag->end - programmed;
    s.isProbing = e.isOnProbe;
}

/// Writes the state of the controller for the path planner.
[[gnu::hot]] void write_view(const ControllerParts &parts, const StatusInputs &now,
                             const geometry::Pose &programmed) noexcept {
    PathView &v = parts.link->newest;
    v.executor = parts.executor.snapshot();
    v.epoch = now.epoch;
    v.mode = parts.power.mode();
    v.isEnabled = parts.power.isEnabled();
    v.isStopping = parts.power.isStopping() || parts.retracing.isPathLeft();
    v.enables = parts.power.enables();
    v.limits_version = parts.model.limits_version();
    v.position = programmed;
    v.feed_scale = parts.holds.net_feed_scale();
    v.rapid_scale = parts.holds.rapid_scale();
    v.max_velocity = parts.holds.max_velocity();
    v.spindles_reversible = 0;
    v.spindles_ready = 0;
    for (int n = 0; n < parts.model.num_spindles(); ++n) {
        const auto i = static_cast<std::size_t>(n);
        v.spindle_rps[i] = parts.spindles[n].speed_rps;
        v.spindle_revs[i] = parts.spindles[n].turns;
        v.spindle_brakings[i] = parts.spindles.brakings(n, parts.model.settings());
        v.encoder_steps[i] = parts.executor.spindle(n).track.step();
        v.spindles_reversible |= isReversible(parts.model.settings(), n) ? 1U << n : 0U;
        v.spindles_ready |= isReady(parts.spindles[n], now.in.spindle[i]) ? 1U << n : 0U;
    }
    v.isProbeClosed = now.in.isProbeClosed;
    v.probe_trips = parts.probe.trips();
    v.steps = parts.holds.steps();
    v.isStepping = parts.holds.isStepping();
    v.indexers_unlocked = parts.indexers.in_state(LockState::UNLOCKED);
    v.indexers_busy = parts.indexers.busy();
    v.indexers_stuck = parts.indexers.in_state(LockState::STUCK);
    v.type_asks = parts.types.requests();
    v.isTypePending = parts.types.isPending();
    parts.link->view.write(v);
    if (!parts.offsets.isEmpty()) [[unlikely]] {
        parts.link->offsets.write(parts.offsets.range());
        std::atomic_thread_fence(std::memory_order_seq_cst);  // before the extent of the path is read again
    }
}

}  // namespace

void write_status(const ControllerParts &parts, const StatusInputs &now, Outputs &out) noexcept {
    const Inputs &in = now.in;
    Status &s = out.status;
    s.cycle = parts.cycle;
    s.time_ns = in.time_ns;
    s.epoch = now.epoch;
    s.last_immediate_id = now.last_immediate_id;
    s.mode = parts.power.mode();
    s.isEnabled = parts.power.isEnabled();
    s.isAllHomed = parts.model.limits().homed.areAll;
    s.isTaskLost = now.isTaskLost;
    s.num_joints = parts.model.num_joints();
    s.num_spindles = parts.model.num_spindles();
    if (out.settings_version != parts.model.settings().version()) [[unlikely]] {
        fill_settings(parts.model.settings(), out);
    }
    parts.position.fill(s);
    parts.probe.fill(in.isProbeClosed, s);
    parts.holds.fill(s);
    parts.outputs.fill(in, out);
    const geometry::Pose programmed = parts.programmed_pose();
    fill_path(parts, programmed, s);
    fill_heading(parts.link->store, parts.executor.output().move, programmed, out);
    parts.joints.fill(
        {parts.power.isEnabled(), parts.jogs.areLimitsOverridden(), parts.model.limits().homed.joints}, out);
    parts.jogs.fill(parts.power.mode(), programmed, out);
    if (!parts.offsets.isEmpty() || !out.areOffsetsQuiet) [[unlikely]] {
        parts.offsets.fill(out);
    }
    parts.extra.fill(parts.model.limits().homed.joints, out);
    out.isHomingQuiet = out.isHomingQuiet && parts.indexers.isEmpty();  // indexers add to the homing outputs
    parts.homing.fill(out);
    parts.indexers.fill(out);
    parts.spindles.fill(in, parts.power.isEnabled(), out);
    for (int j = parts.model.num_joints(); j < parts.joints.loaded(); ++j) {
        fill_unused(in.joint[static_cast<std::size_t>(j)], j, out);
    }
    out.isCoordError = parts.coord_error;
    write_view(parts, now, programmed);
    parts.channels->status.write(s, new_parts(parts.channels->status, out));
    if (parts.channels->isTracing.load(std::memory_order_relaxed) != 0) [[unlikely]] {
        TraceSample sample;
        sample.time_ns = in.time_ns;
        sample.isInMotion = isAnythingMoving(parts) ? 1 : 0;
        sample.pose_kind = parts.types.switches();
        sample.isRetracing = parts.retracing.isAway() ? 1 : 0;
        sample.programmed_pos_cmd = programmed;
        trace(*parts.channels, s, parts.joints, sample);
    }
}

}  // namespace mw::motion
