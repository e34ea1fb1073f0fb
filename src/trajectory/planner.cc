// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/planner.hh"

#include <algorithm>
#include <array>
#include <utility>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

constexpr std::size_t HARDER_COUNT = TimingTuning::HARDER_SHARES.size() * TimingTuning::FIRST_SHARES.size();
constexpr std::size_t STOP_COUNT = 2 + TimingTuning::STOP_SHARES.size() * TimingTuning::FIRST_SHARES.size();

/// What stops are tried as before what is eased is the path; behind STOP_COUNT those for exact arcs alone.
constexpr std::array<StopShape, STOP_COUNT + HARDER_COUNT> stop_shapes() noexcept {
    std::array<StopShape, STOP_COUNT + HARDER_COUNT> shapes{StopShape{}, StopShape{.isHard = true}};
    std::size_t n = 2;
    const auto add = [&](double share) {
        for (const double first : TimingTuning::FIRST_SHARES) {
            shapes[n++] = {.isHard = true, .isAtOnce = true, .first_share = share * first, .share = share};
        }
    };
    for (const double share : TimingTuning::STOP_SHARES) {
        add(share);
    }
    for (const double share : TimingTuning::HARDER_SHARES) {
        add(share);
    }
    return shapes;
}
constexpr std::array STOPS = stop_shapes();

/// What a stop is made with, and from where.
struct StopSearch {
    TimingPlan &timing;
    Trial &trial;
    PathStore &store;
    const PathView &view;
    const Snapshot &now;
    LeaderState from;

    /// Drafts the soonest stop of those that pass the trial; false where all are rejected.
    bool draft_soonest() noexcept;

  private:
    bool draft(Sequence begin, std::size_t shape) noexcept {
        return timing.draft(view, store, begin, from, Ending::STOP, STOPS[shape]);
    }
};

bool StopSearch::draft_soonest() noexcept {
    const Sequence begin = timing.phases_end();
    std::array<std::pair<double, std::size_t>, STOPS.size()> stops;
    std::size_t count = 0;
    const std::size_t shapes = view.path.piece(from.piece).isAlong ? STOPS.size() : STOP_COUNT;
    for (std::size_t n = 0; n < shapes; ++n) {
        if (draft(begin, n)) {
            stops[count++] = {timing.stop_seconds(), n};
        }
    }
    std::sort(stops.begin(), stops.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t n = 0; n < count; ++n) {
        const bool isSame = n > 0 && stops[n].first == stops[n - 1].first;
        if (!isSame && draft(begin, stops[n].second) &&
            trial.check(view, now, {from, begin, timing.phases_end(), timing.outlook(now)}).isSound) {
            return true;
        }
    }
    timing.discard(begin);
    return false;
}

}  // namespace

Planner::Planner(PathStore &store, const PlannerSettings &settings) noexcept
    : settings_(settings), conditions_(settings.period_s), path_(store), timing_(settings),
      curve_(store, path_, settings.period_s, settings.third_order) {
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
    conditions_.limits.begin(demand);
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
    path_.store().updates.fetch_add(1, std::memory_order_relaxed);
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
    case Demand::Kind::STOP:  // the executor stops by itself
    case Demand::Kind::NOTHING: break;
    }
}

void Planner::plan_tried(const Snapshot &now) noexcept {
    const bool isGone = now.drops != drops_ || (now.isDropping && now.motion == Motion::REST);
    if (isGone || now.motion == Motion::BRAKE) {
        return;
    }
    path_.drive_to(now.piece);
    timing_.look(view(), now);
    const Demand demand = timing_.tried_demand(view(), now);
    switch (demand.kind) {
    case Demand::Kind::PLAN: {
        const bool isRefused = !find_plan(now, demand.from, Ending::ONWARD);
        if (now.motion == Motion::REST) {
            refusals_ = isRefused && now.isSettled ? refusals_ + 1 : 0;
        }
        break;
    }
    case Demand::Kind::STOP: find_plan(now, demand.from, Ending::STOP); break;
    case Demand::Kind::EXTEND:  // every plan goes to its end
    case Demand::Kind::NOTHING: break;
    }
}

/// Makes plans until one passes the trial; a stop as it is before what is eased is the path. False when the
/// trial has refused them all; the plan before then stays in force, with its stop.
bool Planner::find_plan(const Snapshot &now, LeaderState from, Ending ending) noexcept {
    const Sequence begin = timing_.phases_end();
    const double standing =
        TimingTuning::STANDING * path_.piece(from.piece).acceleration.at(0) * settings_.period_s;
    from.v = from.v < standing ? 0.0 : from.v;
    const PathView on = view();
    if (ending == Ending::STOP && StopSearch{timing_, trial_, path_.store(), on, now, from}.draft_soonest()) {
        if (!timing_.commit(on, path_.store(), now, begin, ending)) {
            timing_.discard(begin);
        }
        return true;
    }
    easing_.begin();
    bool isRefused = false;
    Cause cause;
    const int attempts = refusals_ > 0 ? TimingTuning::ATTEMPTS_AT_REST : TimingTuning::ATTEMPTS;
    for (int n = 0; n < attempts; ++n) {
        const bool isDrafted = timing_.draft(view(), path_.store(), begin, from, ending);
        const TrialPlan plan{from, begin, timing_.phases_end(), timing_.outlook(now)};
        const Verdict verdict = isDrafted ? trial_.check(view(), now, plan) : Verdict{};
        if (isDrafted && verdict.isSound) {
            if (!timing_.commit(view(), path_.store(), now, begin, ending)) {
                break;
            }
            return true;
        }
        if (!isDrafted) {
            break;
        }
        isRefused = true;
        cause = trial_.cause_of(verdict, conditions_.limits, from.v > 0 ? from.piece + 1 : from.piece);
        if (!ease(from, verdict, cause)) {
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
bool Planner::ease(const LeaderState &from, const Verdict &verdict, const Cause &cause) noexcept {
    if (cause.low == 0) {
        return false;
    }
    const Means means = easing_.means_against(view(), cause);
    if (easing_.lengthen_stands(path_, conditions_.limits, cause, means, verdict.excess)) {
        return true;
    }
    const Sequence taken_back = easing_.take_back_gentleness(path_, verdict);
    if (taken_back != 0) {
        timing_.renew_up_to(view(), taken_back);
    }
    easing_.slow_down(path_, conditions_.workspace, cause, means, verdict);
    timing_.renew_span(view(), cause.low, cause.high);
    if (from.v > 0 && !timing_.isKept(view(), from)) {
        easing_.undo(path_, conditions_.workspace);
        timing_.renew_span(view(), cause.low, cause.high);
        return false;
    }
    return true;
}

Trouble Planner::take_trouble() noexcept {
    Trouble trouble;
    refusals_ = curve_.isActive() ? std::min(refusals_, curve_.failures()) : refusals_;
    trouble.isStuck = refusals_ == TimingTuning::MOST_REFUSALS;
    refusals_ += trouble.isStuck ? 1 : 0;
    if (!isOverreachTold_) {
        trouble.overreach = curve_.isActive() ? curve_.path().move_feeds().overreach() : timing_.overreach();
        isOverreachTold_ = trouble.overreach.kind != Overreach::Kind::NONE;
    }
    return trouble;
}

}  // namespace mw::trajectory
