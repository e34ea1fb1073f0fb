// SPDX-License-Identifier: GPL-2.0-or-later
// The status snapshot for all clients: each part writes its own fields.
#include <algorithm>
#include <atomic>

#include "motion/servo/controller.hh"

namespace mw::motion {
namespace {

/// Parts that may differ from the last cycle. Values that seldom change are compared only where they may have
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

/// A joint that was loaded and is not in use: it commands nothing to its drive.
void fill_unused(const JointInputs &in, int j, Outputs &out) noexcept {
    const auto n = static_cast<std::size_t>(j);
    out.status.joint[n] = {};
    out.settings_version = 0;  // its limits are published again when it is used
    out.status.joint[n].motor_pos_fb = in.motor_pos_fb;
    out.joint[n] = {};
    out.joint[n].motor_pos_cmd = in.motor_pos_fb;
}

/// `sample` gets the values that the status does not contain.
void trace(Channels &channels, const Status &s, const Joints &joints, TraceSample &sample) noexcept {
    sample.cycle = s.cycle;
    sample.path_id = s.active_path_id;
    sample.line = s.source.line;
    sample.epoch = s.epoch;
    sample.carte_pos_cmd = s.carte_pos_cmd;
    sample.joint_pos_cmd = commanded(joints);
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

/// Directions keep their values without motion.
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

}  // namespace

void Controller::publish(const Inputs &in, Outputs &out) noexcept {
    Status &s = out.status;
    s.cycle = cycle_;
    s.time_ns = in.time_ns;
    s.epoch = received_.epoch;
    s.last_immediate_id = received_.last_id;
    s.mode = power_.mode;
    s.isEnabled = power_.isEnabled;
    s.isAllHomed = limits_.homed.areAll;
    s.isTaskLost = watchdog_.isLost;
    s.num_joints = config_.num_joints;
    s.num_spindles = config_.num_spindles;
    if (out.settings_version != settings_.version()) [[unlikely]] {
        fill_settings(settings_, out);
    }
    fill(place_, s);
    fill(probe_, in.isProbeClosed, s);
    fill(holds_, s);
    fill(outputs_, in, out);
    const geometry::Pose programmed = without(offsets_, place_.cmd);
    fill_path(s, programmed);
    fill_heading(link_->store, executor_.output().move, programmed, out);
    fill(joints_, {power_.isEnabled, jogs_.areLimitsOverridden, limits_.homed.joints}, out);
    fill(jogs_, power_.mode, programmed, out);
    if (offsets_.axes != 0 || !out.areOffsetsQuiet) [[unlikely]] {
        fill(offsets_, out);
    }
    fill(extra_, limits_.homed.joints, out);
    out.isHomingQuiet = out.isHomingQuiet && indexers_.mask == 0;  // they add to its outputs
    fill(homing_, out);
    fill(indexers_, out);
    fill(spindles_, in, power_.isEnabled, out);
    for (int j = config_.num_joints; j < joints_.loaded; ++j) {
        fill_unused(in.joint[static_cast<std::size_t>(j)], j, out);
    }
    out.isCoordError = isCoordError_;
    publish_view(in, programmed);
    channels_->status.write(s, new_parts(channels_->status, out));
    if (channels_->isTracing.load(std::memory_order_relaxed) != 0) [[unlikely]] {
        TraceSample sample;
        sample.time_ns = in.time_ns;
        sample.isInMotion = isAnythingMoving() ? 1 : 0;
        sample.pose_kind = types_.switches;
        sample.isRetracing = retracing_.retrace.isAway() ? 1 : 0;
        sample.programmed_pos_cmd = programmed;
        trace(*channels_, s, joints_, sample);
    }
}

/// The executed move and the rest of the path. `programmed`: the position without external offsets.
void Controller::fill_path(Status &s, const geometry::Pose &programmed) const noexcept {
    s.queue_depth = link_->queue_depth.load(std::memory_order_relaxed);
    s.isQueueFull = link_->isQueueFull.load(std::memory_order_relaxed) != 0;
    s.last_path_id = link_->last_done_id.load(std::memory_order_acquire);
    s.isInPosition = !isAnythingMoving() && busy(indexers_) == 0 &&
                     (power_.mode != Mode::COORD || s.queue_depth == 0) && !types_.isPending;
    s.current_velocity = place_.velocity;
    const trajectory::MoveTag *tag = active_move(executor_, link_->store, power_.mode);
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
    const trajectory::ExecutorOutput &e = executor_.output();
    s.active_path_id = tag->id;
    s.source = {tag->line, tag->file_index, tag->block};
    s.motion_type = static_cast<MotionType>(tag->type);
    s.current_velocity = e.velocity / tag->feed_ratio;
    s.requested_velocity = tag->requested_velocity;
    s.distance_to_go = e.distance_to_go / tag->feed_ratio;
    s.dtg = tag->end - programmed;
    s.isProbing = e.isOnProbe;
}

/// The controller's state for the path planner.
void Controller::publish_view(const Inputs &in, const geometry::Pose &programmed) noexcept {
    PathView &v = link_->newest;
    v.executor = executor_.snapshot();
    v.epoch = received_.epoch;
    v.mode = power_.mode;
    v.isEnabled = power_.isEnabled;
    v.isStopping = power_.isStopping || retracing_.isPathLeft;
    v.enables = power_.enables;
    v.limits_version = limits_version_;
    v.position = programmed;
    v.feed_scale = holds_.net_feed_scale;
    v.rapid_scale = holds_.rapid_scale;
    v.max_feed_scale = std::max(1.0, settings_.get(Parameter::MAX_FEED_SCALE));
    v.max_velocity = holds_.max_velocity;
    v.spindles_reversible = 0;
    v.spindles_ready = 0;
    for (int n = 0; n < config_.num_spindles; ++n) {
        const auto i = static_cast<std::size_t>(n);
        v.spindle_rps[i] = spindles_[n].speed_rps;
        v.spindle_revs[i] = spindles_[n].turns;
        v.spindle_brakings[i] = brakings_of(spindles_, n, settings_);
        v.encoder_steps[i] = executor_.spindle(n).track.step();
        v.spindles_reversible |= isReversible(settings_, n) ? 1U << n : 0U;
        v.spindles_ready |= isReady(spindles_[n], in.spindle[i]) ? 1U << n : 0U;
    }
    v.isProbeClosed = in.isProbeClosed;
    v.probe_trips = probe_.trips;
    v.steps = holds_.steps;
    v.isStepping = holds_.isStepping;
    v.indexers_unlocked = in_state(indexers_, LockState::UNLOCKED);
    v.indexers_busy = busy(indexers_);
    v.indexers_stuck = in_state(indexers_, LockState::STUCK);
    v.type_asks = types_.asks;
    v.isTypePending = types_.isPending;
    link_->view.write(v);
    if (offsets_.axes != 0) [[unlikely]] {
        link_->offsets.write(range(offsets_));
        std::atomic_thread_fence(std::memory_order_seq_cst);  // before the extent of the path is read again
    }
}

}  // namespace mw::motion
