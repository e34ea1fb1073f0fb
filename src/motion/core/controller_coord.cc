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
        for (int i = 0; i < MAX_AXES; ++i) {
            traj::JogPlanner &p = axes_[at(i)].teleop;
            p.step(config_.period_s);
            pose[i] = p.position;
        }
    } else {
        pose = executor_.step(cycle_).position;
    }
    check_probe(in);
    move_by_pose(pose);
    fire_events();
}

/// What keeps the path from moving on for now.
void Controller::step_holds(const Inputs &in) noexcept {
    const double adaptive = isAdaptiveFeedEnabled_ ? std::clamp(in.adaptive_feed, 0.0, 1.0) : 1.0;
    net_feed_scale_ = (isFeedOverrideEnabled_ ? feed_scale_ : 1.0) * adaptive;
    const bool isFeedHeld = (isFeedHoldEnabled_ && in.isFeedHeld) || in.isFeedInhibited;
    executor_.hold(isPaused_ || isFeedHeld);
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
    v.isStopping = stop_ != Stop::NONE;
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
