// SPDX-License-Identifier: GPL-2.0-or-later
// Teleop and coordinated motion: from path or axis planners to a pose; holds, probing, and what the path
// planner sees.
#include <algorithm>
#include <cmath>

#include "motion/core/controller.hh"

namespace mw::motion {

void Controller::step_coord(const Inputs &in) noexcept {
    geom::Pose pose;
    if (mode_ == Mode::TELEOP) {
        executor_.step(cycle_);
        executor_.set_position(carte_pos_cmd_);
        limit_teleop();
        for (int i = 0; i < MAX_AXES; ++i) {
            traj::JogPlanner &p = axes_[at(i)].teleop;
            if (isIdentity() && !p.isAtRest()) {
                p.max_velocity =
                    std::min(axes_[at(i)].wanted_velocity * jog_scale(), limits_.axis_jog[at(i)].velocity);
            }
            p.step(config_.period_s);
            pose[i] = p.position;
        }
    } else {
        pose = step_retrace(executor_.step(cycle_).position);
    }
    check_probe(in);
    move_by_pose(pose);
    check_joint_steps();
    if (mode_ == Mode::COORD && !link_.retrace.isAway()) {
        isAdaptiveFeedEnabled_ ? link_.retrace.record(pose, use_of(pose)) : link_.retrace.clear();
    }
    fire_events();
}

/// From the pose of the path to the one that is commanded: behind it while the path is gone back.
geom::Pose Controller::step_retrace(const geom::Pose &pose) noexcept {
    follow_dropped_path();
    traj::Retrace &retrace = link_.retrace;
    const bool isFirst = !retrace.isAway() && isReverseWanted_ && !isStandingWanted_ && stop_ == Stop::NONE;
    if (!retrace.isAway() && !(isFirst && executor_.isAtRest() && retrace.isReady())) {
        return pose;
    }
    const bool isStill = isStandingWanted_ || isPathLeft_ || stop_ != Stop::NONE;
    const geom::Pose out = retrace.step(config_.period_s,
                                        isStill            ? 0
                                        : isReverseWanted_ ? -1
                                                           : 1,
                                        reverse_rate_);
    if (isPathLeft_ && !retrace.isMoving()) {
        isPathLeft_ = false;
        executor_.set_position(out);
        retrace.clear();
    }
    return out;
}

/// A path that is dropped while it is gone back ends where that comes to a stand.
void Controller::follow_dropped_path() noexcept {
    const std::uint64_t drops = executor_.snapshot().drops;
    if (drops == drops_seen_) {
        return;
    }
    drops_seen_ = drops;
    if (link_.retrace.isAway()) {
        isPathLeft_ = true;
    } else {
        link_.retrace.clear();
    }
}

/// How much of the limits the step to `pose` uses.
traj::Retrace::Use Controller::use_of(const geom::Pose &pose) noexcept {
    traj::Retrace::Use use;
    if (link_.retrace.isEmpty()) {
        last_pose_ = pose;
        last_step_ = {};
        return use;
    }
    const double per_s = 1.0 / config_.period_s;
    const geom::Pose step = pose - last_pose_;
    const geom::Pose bend = step - last_step_;
    last_pose_ = pose;
    last_step_ = step;
    const auto add = [&](double v, double a, double most_a, double most_j) {
        use.v_over_a = std::max(use.v_over_a, std::abs(v) * per_s / most_a);
        if (limits_.path.isJerkLimited) {
            use.v_over_j = std::max(use.v_over_j, std::abs(v) * per_s / most_j);
            use.a_over_j = std::max(use.a_over_j, std::abs(a) * per_s * per_s / most_j);
        }
    };
    const traj::Limits &limits = limits_.path;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        add(step[i], bend[i], limits.acceleration[at(i)], limits.jerk[at(i)]);
    }
    add(geom::norm_xyz(step), geom::norm_xyz(bend), limits.acceleration[traj::XYZ_NORM],
        limits.jerk[traj::XYZ_NORM]);
    for (int j = 0; j < config_.num_joints && !isIdentity(); ++j) {
        const JointState &s = joint(j);
        add(s.vel_cmd * config_.period_s, s.acc_cmd * config_.period_s * config_.period_s,
            limits_.joints.acceleration[at(j)], limits_.joints.jerk[at(j)]);
    }
    return use;
}

/// What keeps the path from moving on for now.
void Controller::step_holds(const Inputs &in) noexcept {
    // What is not a number stands for no feed: a broken sensor must not let the machine run.
    const double wanted = std::isfinite(in.adaptive_feed) ? std::clamp(in.adaptive_feed, -1.0, 1.0) : 0.0;
    const double adaptive = isAdaptiveFeedEnabled_ ? wanted : 1.0;
    isReverseWanted_ = (adaptive < 0) != isReverse_;
    reverse_rate_ = traj::Retrace::HIGHEST_RATE * std::abs(adaptive);
    // What waits for its turn while going back keeps its speed.
    net_feed_scale_ = (isFeedOverrideEnabled_ ? feed_scale_ : 1.0) * std::abs(adaptive);
    const bool isFeedHeld = (isFeedHoldEnabled_ && in.isFeedHeld) || in.isFeedInhibited;
    isStandingWanted_ = isPaused_ || isFeedHeld;
    executor_.hold(isStandingWanted_ || (mode_ == Mode::COORD && isReversing()));
    const bool isStepOver = isStepping_ && link_.steps_done.load(std::memory_order_acquire) == steps_;
    if (isStepOver) {
        isStepping_ = false;
        isPaused_ = true;
    }
}

/// A probing move ends where the probe trips; in any other move a trip is a fault.
void Controller::check_probe(const Inputs &in) noexcept {
    const traj::ExecutorOutput &out = executor_.output();
    if (mode_ == Mode::COORD && out.isOnProbe && out.isMoving) {
        const MoveTag &tag = link_.store.move(out.move);
        if (probe_move_ != out.move) {
            probe_move_ = out.move;
            isProbeTripped_ = false;
        }
        const bool isTripped = in.isProbeClosed != tag.isProbeAway;
        if (isTripped && !isProbeTripped_) {
            isProbeTripped_ = true;
            probed_pos_ = carte_pos_fb_;
            ++probe_trips_;
            executor_.drop();
        }
        return;
    }
    const bool isTouched = in.isProbeClosed && !wasProbeClosed_ && isAnythingMoving() && stop_ == Stop::NONE;
    const bool isRetracting = executor_.snapshot().isDropping && isProbeTripped_;
    if (isTouched && !isRetracting) {
        raise(FaultKind::PROBE_TRIPPED_IN_MOVE, -1, 0);
        homing_.abort(homing::Failure::ABORTED);
        executor_.drop();
        stop_jogs(false);
        isCoordError_ = true;
    }
}

bool Controller::isSpindleReady(const Inputs &in, int n) const noexcept {
    return !spindles_[at(n)].isOn || in.spindle[at(n)].isAtSpeed;
}

void Controller::publish_view(const Inputs &in) noexcept {
    PathView v;
    v.executor = executor_.snapshot();
    v.epoch = epoch_;
    v.mode = mode_;
    v.isEnabled = isEnabled_;
    v.isStopping = stop_ != Stop::NONE || isPathLeft_;
    v.enables = enables_;
    v.limits_version = limits_version_;
    v.position = carte_pos_cmd_;
    v.feed_scale = net_feed_scale_;
    v.rapid_scale = rapid_scale_;
    v.max_feed_scale = std::max(1.0, get(Parameter::MAX_FEED_SCALE));
    v.max_velocity = max_velocity_;
    for (int n = 0; n < config_.num_spindles; ++n) {
        v.spindle_rps[at(n)] = in.spindle[at(n)].speed_in_rps;
        v.spindle_revs[at(n)] = in.spindle[at(n)].revs;
        v.spindles_ready |= isSpindleReady(in, n) ? 1U << n : 0U;
    }
    v.isProbeClosed = in.isProbeClosed;
    v.probe_trips = probe_trips_;
    v.steps = steps_;
    v.isStepping = isStepping_;
    link_.view.write(v);
}

}  // namespace mw::motion
