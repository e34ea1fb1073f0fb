// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/planner.hh"

#include <algorithm>

namespace mw::trajectory {

Planner::Planner(PathStore &store, const PlannerSettings &settings) noexcept
    : settings_(settings), conditions_(settings.period_s), path_(store),
      curve_(store, path_, settings.period_s, settings.is_estimate) {
    conditions_.chooser = settings.chooser;
}

void Planner::set_joints(const JointMap *map, const JointLimits &limits,
                         const LinearJoints &linear) noexcept {
    conditions_.workspace.linear = linear;
    conditions_.workspace.map = map;
    conditions_.workspace.joints = limits;
}

void Planner::set_room(const Pose &low, const Pose &high, const JointRoom &joints) noexcept {
    conditions_.workspace.low = low;
    conditions_.workspace.high = high;
    conditions_.workspace.joint_room = joints;
}

void Planner::begin(const Pose &start, const Snapshot &now) noexcept {
    path_.begin();
    curve_.begin(start, now, conditions_);
    drops_ = now.drops;
    isOverreachTold_ = false;
}

Sequence Planner::add(const Primitive &primitive, const MoveRequest &request) noexcept {
    return curve_.add(conditions_, primitive, request);
}

void Planner::release_end() noexcept {
    curve_.release_end(conditions_);
}

bool Planner::add_event(PathEvent event) noexcept {
    event.after_move = path_.end_move();
    event.drops = drops_;
    return path_.store().events.push(event);
}

void Planner::set_scales(const Scales &scales) noexcept {
    conditions_.scales = scales;
    curve_.set_scales(conditions_);
}

void Planner::open_gate(Sequence move, double delay_s) noexcept {
    curve_.delay_start(delay_s);
    path_.move(move).request.isGated = false;
    curve_.renew();
}

void Planner::set_step(bool isStepping, std::uint32_t block) noexcept {
    SingleBlocks &blocks = conditions_.blocks;
    if (isStepping != blocks.isOn || block != blocks.block) {
        blocks = {isStepping, block};
        curve_.renew();
    }
}

Sequence Planner::waiting_gate(const Snapshot &now) const noexcept {
    const Sequence move = curve_.standing_before(now);
    return move != 0 && path_.move(move).request.isGated ? move : 0;
}

bool Planner::isAtStepStop(const Snapshot &now) const noexcept {
    const Sequence move = conditions_.blocks.isOn ? curve_.standing_before(now) : 0;
    return move != 0 && conditions_.blocks.isStopBefore(path_.move(move).request.tag);
}

bool Planner::hasNext(const Snapshot &now) const noexcept {
    return now.motion != Motion::REST || curve_.move_of(now) <= path_.last_move();
}

std::uint32_t Planner::next_block(const Snapshot &now) const noexcept {
    return path_.store().move(std::min(curve_.move_of(now), path_.last_move())).block;
}

std::uint32_t Planner::moves_left(const Snapshot &now) const noexcept {
    const Sequence done = std::max(now.done_move, path_.first_move() - 1);
    return path_.last_move() > done ? static_cast<std::uint32_t>(path_.last_move() - done) : 0;
}

void Planner::update(const Snapshot &now) noexcept {
    curve_.update(now, conditions_);
}

Trouble Planner::take_trouble() noexcept {
    // Planner periods without a plan at standstill before a fault is reported (1 s).
    constexpr int MOST_FAILURES = 200;
    Trouble trouble;
    const bool is_stuck = curve_.failures() >= MOST_FAILURES;
    trouble.isStuck = is_stuck && !is_stuck_told_;
    is_stuck_told_ = is_stuck;
    if (!isOverreachTold_) {
        trouble.overreach = curve_.path().move_feeds().overreach();
        isOverreachTold_ = trouble.overreach.kind != Overreach::Kind::NONE;
    }
    return trouble;
}

}  // namespace mw::trajectory
