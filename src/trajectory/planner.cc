// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/planner.hh"

#include <algorithm>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

Planner::Planner(PathStore &store, const PlannerSettings &settings) noexcept
    : settings_(settings), conditions_(settings.period_s), path_(store), timing_(settings),
      curve_(store, path_, settings.period_s) {
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

void Planner::begin(const Pose &start, const Snapshot &now, const PathDemand &demand) noexcept {
    path_.begin();
    curve_.begin(start, now, demand, conditions_);
    builder_.begin(start);
    timing_.begin(now);
    drops_ = now.drops;
    refusals_ = 0;
    isOverreachTold_ = false;
}

Sequence Planner::add(const Primitive &primitive, const MoveRequest &request) noexcept {
    if (curve_.isActive()) {
        return curve_.path().add(conditions_, primitive, request);
    }
    return builder_.add(path_, conditions_, primitive, request, settings_.isMerging);
}

void Planner::release_end() noexcept {
    if (curve_.isActive()) {
        curve_.release_end(conditions_);
    } else {
        builder_.release_end(path_, conditions_);
    }
}

bool Planner::add_event(PathEvent event) noexcept {
    builder_.keep_end();
    event.after_move = path_.end_move();
    event.drops = drops_;
    return path_.store().events.push(event);
}

void Planner::set_scales(const Scales &scales) noexcept {
    if (curve_.isActive()) {
        conditions_.scales = scales;
        curve_.set_scales(conditions_);
        return;
    }
    // Spindle speeds never stand still; they matter only where something follows them.
    const Sequence synched = builder_.last_synched();
    const bool isFollowed =
        synched != 0 && !path_.isAllDriven() && synched >= path_.piece(path_.oldest_piece()).move;
    Scales &present = conditions_.scales;
    if (timing_.isSteady(present, scales, isFollowed)) {
        present.max_feed = scales.max_feed;
        present.spindle_rps = isFollowed ? present.spindle_rps : scales.spindle_rps;
        return;
    }
    present = scales;
    timing_.rescale(view());
}

void Planner::open_gate(Sequence move, double delay_s) noexcept {
    if (curve_.isActive()) {
        curve_.delay_start(delay_s);
        path_.move(move).request.isGated = false;
        curve_.renew();
        return;
    }
    timing_.delay_start(delay_s);
    path_.move(move).request.isGated = false;
    timing_.renew_all(view());
}

void Planner::set_step(bool isStepping, std::uint32_t block) noexcept {
    SingleBlocks &blocks = conditions_.blocks;
    if (isStepping != blocks.isOn || block != blocks.block) {
        blocks = {isStepping, block};
        curve_.renew();
        timing_.renew_all(view());
    }
}

Sequence Planner::standing_before(const Snapshot &now) const noexcept {
    if (curve_.isActive()) {
        return curve_.standing_before(now);
    }
    if (now.motion != Motion::REST) {
        return 0;
    }
    const std::optional<LeaderState> state = start_state(path_, now);
    return state && state->x <= 0 ? path_.move_of(state->piece) : 0;
}

Sequence Planner::waiting_gate(const Snapshot &now) const noexcept {
    const Sequence move = standing_before(now);
    return move != 0 && path_.move(move).request.isGated ? move : 0;
}

bool Planner::isAtStepStop(const Snapshot &now) const noexcept {
    const Sequence move = conditions_.blocks.isOn ? standing_before(now) : 0;
    return move != 0 && conditions_.blocks.isStopBefore(path_.move(move).request.tag);
}

bool Planner::hasNext(const Snapshot &now) const noexcept {
    if (curve_.isActive()) {
        return now.motion != Motion::REST || curve_.move_of(now) <= path_.last_move();
    }
    return now.motion != Motion::REST || builder_.hasOpenEnd() || start_state(path_, now).has_value();
}

std::uint32_t Planner::next_block(const Snapshot &now) const noexcept {
    const PathStore &store = path_.store();
    if (curve_.isActive()) {
        return store.move(std::min(curve_.move_of(now), path_.last_move())).block;
    }
    if (now.motion != Motion::REST && now.piece >= path_.first_piece()) {
        const Piece &p = path_.piece(now.piece);
        const bool isSecond = p.blend_d > 0 && p.offset + now.x >= p.blend_d;
        return store.move(p.move + (isSecond ? 1 : 0)).block;
    }
    const std::optional<LeaderState> state = start_state(path_, now);
    if (!state) {
        return store.move(builder_.hasOpenEnd() ? builder_.first_open() : path_.last_move()).block;
    }
    return store.move(state->x > 0 ? path_.piece(state->piece).move : path_.move_of(state->piece)).block;
}

std::uint32_t Planner::moves_left(const Snapshot &now) const noexcept {
    const Sequence done = std::max(now.done_move, path_.first_move() - 1);
    return path_.last_move() > done ? static_cast<std::uint32_t>(path_.last_move() - done) : 0;
}

void Planner::update(const Snapshot &now) noexcept {
    if (curve_.isActive()) {
        curve_.update(now, conditions_);
        return;
    }
    if (conditions_.isTried()) {
        plan_tried(now);
        return;
    }
    if (now.drops != drops_ || now.isDropping) {
        return;
    }
    path_.drive_to(now.piece);
    timing_.look(view(), now);
    const Demand demand = timing_.demand(view(), now);
    switch (demand.kind) {
    case Demand::Kind::EXTEND: timing_.extend(view(), path_.store(), now); break;
    case Demand::Kind::PLAN: timing_.plan(view(), path_.store(), now, demand.from); break;
    case Demand::Kind::NOTHING: break;
    }
}

void Planner::plan_tried(const Snapshot &now) noexcept {
    if (now.drops != drops_ || now.isDropping || now.motion == Motion::BRAKE) {
        return;
    }
    path_.drive_to(now.piece);
    timing_.look(view(), now);
    const Demand demand = timing_.tried_demand(view(), now);
    switch (demand.kind) {
    case Demand::Kind::PLAN: {
        const bool isRefused = !find_plan(now, demand.from);
        if (now.motion == Motion::REST) {
            refusals_ = isRefused ? refusals_ + 1 : 0;
        }
        break;
    }
    case Demand::Kind::EXTEND:  // every plan goes to its end
    case Demand::Kind::NOTHING: break;
    }
}

/// Makes plans until one passes the trial. False when the trial has rejected them all; the plan before then
/// stays in force, with its stop.
bool Planner::find_plan(const Snapshot &now, LeaderState from) noexcept {
    const Sequence begin = timing_.phases_end();
    const double standing =
        TimingTuning::STANDING * path_.piece(from.piece).acceleration.at(0) * settings_.period_s;
    from.v = from.v < standing ? 0.0 : from.v;
    easing_.begin();
    bool isRefused = false;
    Cause cause;
    const int attempts = refusals_ > 0 ? TimingTuning::ATTEMPTS_AT_REST : TimingTuning::ATTEMPTS;
    for (int n = 0; n < attempts; ++n) {
        const bool isDrafted = timing_.draft(view(), path_.store(), begin, from);
        const TrialPlan plan{from, begin, timing_.phases_end(), timing_.outlook(now)};
        const Verdict verdict = isDrafted ? trial_.check(view(), now, plan) : Verdict{};
        if (isDrafted && verdict.isSound) {
            if (!timing_.commit(path_.store(), now, begin)) {
                break;
            }
            return true;
        }
        if (!isDrafted) {
            break;
        }
        isRefused = true;
        cause = trial_.cause_of(verdict, from.v > 0 ? from.piece + 1 : from.piece);
        if (!ease(from, cause)) {
            break;
        }
    }
    timing_.discard(begin);
    if (cause.isAfterDriven) {
        // It failed for what was driven before: being slower did not help.
        const Cause eased = easing_.take_back(path_);
        if (eased.low != 0) {
            timing_.renew_span(view(), eased.low, eased.high);
        }
        timing_.renew_all(view());
    }
    return !isRefused;
}

/// Makes what the failed sample depends on slower, as far as it is not driven yet. False when nothing can be
/// done from here.
bool Planner::ease(const LeaderState &from, const Cause &cause) noexcept {
    if (cause.low == 0) {
        return false;
    }
    easing_.slow_down(path_, cause);
    timing_.renew_span(view(), cause.low, cause.high);
    if (from.v > 0 && !timing_.isKept(view(), from)) {
        easing_.undo(path_);
        timing_.renew_span(view(), cause.low, cause.high);
        return false;
    }
    return true;
}

Trouble Planner::take_trouble() noexcept {
    Trouble trouble;
    const int failures = curve_.isActive() ? curve_.failures() : refusals_;
    const bool is_stuck = failures >= TimingTuning::MOST_REFUSALS;
    trouble.isStuck = is_stuck && !is_stuck_told_;
    is_stuck_told_ = is_stuck;
    if (!isOverreachTold_) {
        trouble.overreach = curve_.isActive() ? curve_.path().move_feeds().overreach() : timing_.overreach();
        isOverreachTold_ = trouble.overreach.kind != Overreach::Kind::NONE;
    }
    return trouble;
}

}  // namespace mw::trajectory
