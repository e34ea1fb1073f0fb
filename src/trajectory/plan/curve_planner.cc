// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/curve_planner.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/plan/tap_plan.hh"

namespace mw::trajectory::plan {

namespace {

/// After this number of cycles, a plan that begins at standstill is either accepted or ignored for good.
constexpr std::uint64_t TAKEN_CYCLES = 20;
/// Maximum number of cells of a plan with its stops. It is half of the ring, because the previous plan
/// remains until this one is accepted.
constexpr std::size_t MOST_CELLS = CELL_CAPACITY / 2;
/// Maximum numbers of cells of the motion, of its last stop and of all direct stops.
constexpr std::size_t MOST_MOTION_CELLS = MOST_CELLS / 4, MOST_LAST_CELLS = MOST_CELLS / 4;
constexpr std::size_t DIRECT_CELLS = profile::DirectStop::PHASES * CurvePlan::MOST_STOPS;
static_assert(MOST_MOTION_CELLS + MOST_LAST_CELLS + DIRECT_CELLS < MOST_CELLS);

}  // namespace

CurvePlanner::CurvePlanner(PathStore &store, PlannedPath &moves, double period_s, bool is_estimate)
    : store_(store), moves_(moves), period_s_(period_s), is_estimate_(is_estimate), path_(store, moves),
      third_order_({.window_s = WINDOW_S, .period_s = period_s}), second_order_(COMMITTED_S, period_s),
      timing_(&third_order_) {}

void CurvePlanner::begin(const Pose &start, const Snapshot &now, const Conditions &conditions) {
    path_.begin(start, conditions);
    scales_ = conditions.scales;
    numbers_.clear();
    plan_ = std::max(plan_, now.plan);
    first_plan_ = plan_ + 1;
    drops_ = now.drops;
    is_running_ = is_abandoned_ = is_changed_ = is_lower_ = is_window_full_ = false;
    delay_s_ = 0;
    start_cycle_ = tried_cycle_ = 0;
    failures_ = 0;
}

Sequence CurvePlanner::add(const Conditions &conditions, const Primitive &primitive,
                           const MoveRequest &request) {
    if (path_.isEmpty()) {
        timing_ = conditions.limits.wanted().isJerkLimited ? static_cast<profile::PathTiming *>(&third_order_)
                                                           : &second_order_;
        path_.begin(path_.end(), conditions);
    }
    return path_.add(conditions, primitive, request);
}

void CurvePlanner::release_end(const Conditions &conditions) {
    is_changed_ = is_changed_ || path_.hasOpenEnd();
    path_.release_end(conditions);
}

void CurvePlanner::set_scales(const Conditions &conditions) {
    const Scales &now = conditions.scales;
    const bool is_same = now.feed == scales_.feed && now.rapid == scales_.rapid &&
                         now.max_velocity == scales_.max_velocity &&
                         (now.spindle_rps == scales_.spindle_rps || !path_.move_feeds().isSynched());
    if (is_same) {
        return;
    }
    scales_ = now;
    const MoveFeeds::Change change = path_.move_feeds().update(conditions);
    is_lower_ = is_lower_ || change.is_lower;
    is_changed_ = is_changed_ || change.is_any;
}

double CurvePlanner::place_of(const Snapshot &now) const noexcept {
    return now.isOnPath && now.plan >= first_plan_ ? now.x : 0.0;
}

Sequence CurvePlanner::standing_before(const Snapshot &now) const noexcept {
    const Sequence move = move_of(now);
    const bool is_there = now.motion == Motion::REST && move <= moves_.last_move() &&
                          std::abs(place_of(now) - moves_.move(move).start_s) <= SAME_PLACE;
    return is_there ? move : 0;
}

/// True if the move has a speed. After the end of the path the last move is evaluated.
bool CurvePlanner::hasSpeed(Sequence move) const noexcept {
    const auto index = static_cast<std::size_t>(std::min(move, moves_.last_move()) - path_.first_move());
    const profile::FeedLimit &feed = path_.feeds()[index];
    return feed.velocity > 0 && feed.limit_share > 0;
}

/// The run that can be executed from `s` on. A move without speed stops the motion, but not before
/// `least_end`. A single block that ends before `least_end` does not stop it.
profile::Run CurvePlanner::run_from(double s, double least_end, const Conditions &conditions) const {
    double stop = path_.stop_behind(s);
    if (!path_.hasOpenEnd()) {
        stop = std::min(stop, path_.programmed_s());
    }
    const double known = path_.known_s();
    for (Sequence n = path_.move_at(s) + 1; n <= moves_.last_move(); ++n) {
        const PlannedMove &m = moves_.move(n);
        if (m.start_s >= std::min(stop, known)) {
            break;
        }
        if (!hasSpeed(n)) {
            stop = std::min(stop, std::max(m.start_s, least_end));
        } else if (conditions.blocks.isStopBefore(m.request.tag) && m.start_s >= least_end) {
            stop = m.start_s;
        }
    }
    profile::Run run;
    run.spans = &path_.spans();
    run.feeds = &path_.feeds();
    run.caps = &path_.caps();
    run.limits = path_.limits();
    run.map = path_.joint_map();
    run.joints = path_.joint_limits();
    run.has_stop = stop <= known + SAME_PLACE;
    run.end_s = path_.on_span_end(std::min(stop, known));
    return run;
}

/// Updates whether the executor is stopped, in a cell of the motion, or in a stop.
void CurvePlanner::follow(const Snapshot &now) {
    if (now.motion != Motion::CURVE) {
        const bool is_taken = now.plan == plan_ || now.cycle > planned_cycle_ + TAKEN_CYCLES;
        is_running_ = is_running_ && !(now.motion == Motion::REST && is_taken);
        is_abandoned_ = is_abandoned_ && is_running_;
        return;
    }
    const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), now.cell);
    if (at == numbers_.end() || *at != now.cell) {
        is_abandoned_ = true;
    } else if (!path_.hasRoom()) {
        drop_driven(now);
    }
}

/// Drops the cells that the executor has completed, and the path before them.
void CurvePlanner::drop_driven(const Snapshot &now) {
    if (now.motion != Motion::CURVE || is_abandoned_) {
        return;
    }
    const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), now.cell);
    timing_->drop(static_cast<std::size_t>(at - numbers_.begin()));
    numbers_.erase(numbers_.begin(), at);
    path_.drop_before(std::min(now.x, timing_->cell(0).c[0]));
}

void CurvePlanner::update(const Snapshot &now, const Conditions &conditions) {
    if (now.drops != drops_ || now.isDropping) {
        return;
    }
    if (is_running_) {
        follow(now);
    }
    if (!is_running_) {
        start(now, conditions);
    } else if (!is_abandoned_ && now.plan == plan_ && !now.isHeld && now.motion != Motion::LOCKED) {
        continue_plan(now, conditions);
    }
}

void CurvePlanner::start(const Snapshot &now, const Conditions &conditions) {
    if (now.motion != Motion::REST || now.isHeld) {
        return;
    }
    const double s = place_of(now);
    path_.drop_before(s);
    const Sequence move = path_.move_at(s);
    if (move > moves_.last_move() || !hasSpeed(move)) {
        return;
    }
    const MoveRequest &request = moves_.move(move).request;
    const bool is_before = standing_before(now) == move;
    if (is_before && (request.isGated || conditions.blocks.isStopBefore(request.tag))) {
        return;
    }
    if (delay_s_ > 0) {
        start_cycle_ = now.cycle + static_cast<std::uint64_t>(delay_s_ / period_s_);
        delay_s_ = 0;
    }
    if (now.cycle < start_cycle_) {
        return;
    }
    path_.extend(conditions);
    if (conditions.isLocked(request)) {
        start_pass(now, s, move, conditions);
        return;
    }
    run_ = run_from(s, s, conditions);
    if (path_.spans().empty() || !(run_.end_s > s)) {
        return;
    }
    timing_->begin(path_.on_span_end(s));
    numbers_.clear();
    is_changed_ = is_lower_ = false;
    const bool is_made = timing_->plan(run_, 0) && timing_->cells() > 0 && commit(now, 0);
    failures_ = is_made ? 0 : failures_ + 1;
    is_running_ = is_made;
}

/// Starts a pass. The executor controls its motion.
void CurvePlanner::start_pass(const Snapshot &now, double s, Sequence move, const Conditions &conditions) {
    if (!isPassKnown(now)) {
        return;
    }
    path_.release_end(conditions);
    const MoveRequest &request = moves_.move(move).request;
    CurvePlan plan;
    Pass &pass = plan.pass;
    pass.start_s = s;
    pass.spindle = request.spindle;
    pass.direction =
        conditions.scales.spindle_rps[static_cast<std::size_t>(request.spindle)] < 0 ? -1.0 : 1.0;
    if (request.isTap) {
        pass.is_tap = true;
        pass.tap = tap_terms({moves_.primitive(move), request, conditions});
        pass.end_s = moves_.move(move + 1).request.tag.end_s;
    } else {
        const CurvePath::KnownPass known = path_.pass_at(s);
        if (known.legs.empty()) {
            ++failures_;
            return;
        }
        pass.first = next_leg_;
        for (const PassLeg &leg : known.legs) {
            store_.leg(next_leg_++) = leg;
        }
        pass.last = next_leg_ - 1;
        pass.end_s = known.end_s;
        pass.acceleration = known.limits.acceleration;
        pass.jerk = known.limits.jerk;
    }
    plan.plan = plan_ + 1;
    plan.brakes = now.brakes;
    plan.after = now.plan;
    plan.span = path_.span_at(s);
    plan.move = move;
    plan.last_span = path_.last_span();
    plan.last_move = moves_.last_move();
    is_running_ = store_.curve_plans.push(plan);
    failures_ = is_running_ ? 0 : failures_ + 1;
    plan_ += is_running_ ? 1 : 0;
    planned_cycle_ = now.cycle;
    numbers_.clear();
}

/// Index of the first cell that a new plan may change.
std::size_t CurvePlanner::first_free_cell(const Snapshot &now) const noexcept {
    double left = -now.time_in_cell;
    std::size_t k = 0;
    while (k < numbers_.size() && left < PLANNING_S) {
        left += timing_->cell(k++).duration;
    }
    return k;
}

void CurvePlanner::continue_plan(const Snapshot &now, const Conditions &conditions) {
    const double since = static_cast<double>(now.cycle - planned_cycle_) * period_s_;
    const bool is_due = committed_s_ - since < RESERVE_S || is_changed_;
    if (!is_due || static_cast<double>(now.cycle - tried_cycle_) * period_s_ < PLANNING_S) {
        return;
    }
    tried_cycle_ = now.cycle;
    drop_driven(now);
    const std::size_t fixed = first_free_cell(now);
    if (fixed >= numbers_.size()) {
        return;  // too late: the executor takes the last stop of the plan
    }
    path_.extend(conditions);
    const double from = timing_->cell(fixed).c[0];
    const double old_end = run_.end_s;
    const bool was_stop = run_.has_stop;
    if (!hasSpeed(path_.move_at(from))) {
        CurvePlan stop;
        stop.is_stop = true;
        is_abandoned_ = store_.curve_plans.push(stop);
        return;
    }
    profile::Run run = run_from(now.x, now.x, conditions);
    if (is_changed_ && run.end_s < old_end) {
        const double soonest = timing_->stop(run_, fixed, profile::StopEffort::QUICK).end_s;
        run = run_from(now.x, soonest, conditions);
    }
    const bool is_same = run.end_s == old_end && run.has_stop == was_stop;
    if (timing_->isComplete() && is_same && !is_changed_ && numbers_.size() == timing_->cells()) {
        planned_cycle_ = now.cycle;
        return;
    }
    const bool is_nearer = run.end_s < old_end - SAME_PLACE;
    const bool is_taken_away = timing_->isComplete() && was_stop && !is_same;
    const bool must_slow = is_lower_ || is_nearer || is_taken_away;
    if (!(must_slow ? timing_->replan(run, fixed) : timing_->plan(run, fixed))) {
        return;  // the previous plan remains active, with its stops
    }
    run_ = run;
    is_changed_ = is_lower_ = false;
    numbers_.resize(fixed);
    if (timing_->cells() <= fixed || !commit(now, fixed)) {
        is_abandoned_ = true;
    }
}

Sequence CurvePlanner::write(const profile::TimeCell &cell) noexcept {
    store_.cell(next_cell_) = cell;
    return next_cell_++;
}

/// Commits the profile after its first `fixed` cells. False if it has no stop, or more cells than the ring
/// has space for.
bool CurvePlanner::commit(const Snapshot &now, std::size_t fixed) {
    CurvePlan plan;
    const std::size_t cells = timing_->cells();
    double planned = 0;
    for (std::size_t k = fixed; k < cells; ++k) {
        planned += timing_->cell(k).duration;
    }
    is_window_full_ = timing_->isComplete() || planned > 0.5 * COMMITTED_S;
    const double committed =
        timing_->isComplete() ? COMMITTED_S : std::min(COMMITTED_S, timing_->committed_part() * planned);
    std::size_t last = fixed;
    double ahead = 0;
    while (last < cells && ahead < committed && last - fixed < MOST_MOTION_CELLS) {
        ahead += timing_->cell(last++).duration;
    }
    timing_->begin_stops(run_);
    profile::Stop end{cells, {}, 0};
    if (last < cells || !timing_->isComplete()) {
        end = stop_from(last, MOST_LAST_CELLS);
        if (end.cells.empty() && !timing_->isComplete()) {
            return false;
        }
    }
    last = end.kept;
    const std::size_t own_cells = last - fixed + end.cells.size() + DIRECT_CELLS;
    if (own_cells > MOST_CELLS) {
        return false;
    }
    plan.plan = plan_ + 1;
    plan.behind = fixed > 0 ? numbers_[fixed - 1] : 0;
    plan.begin = next_cell_;
    for (std::size_t k = fixed; k < last; ++k) {
        numbers_.push_back(write(timing_->cell(k)));
    }
    plan.end = next_cell_;
    plan.brakes = now.brakes;
    plan.after = now.plan;
    const double from = timing_->cell(fixed).c[0];
    plan.span = path_.span_at(from);
    plan.move = path_.move_at(from);
    plan.last_span = path_.last_span();
    plan.last_move = moves_.last_move();
    add_stops(plan, fixed, end, MOST_CELLS - own_cells);
    if (!store_.curve_plans.push(plan)) {
        return false;
    }
    committed_s_ = PLANNING_S + ahead;
    plan_ = plan.plan;
    planned_cycle_ = now.cycle;
    return true;
}

/// A stop from the start of cell `cell`, with at most `most_cells` cells, or else a direct stop.
profile::Stop CurvePlanner::stop_from(std::size_t cell, std::size_t most_cells) {
    using profile::StopEffort;
    profile::Stop stop =
        timing_->next_stop(run_, cell, most_cells > 0 ? StopEffort::PROMPT : StopEffort::QUICK);
    if (stop.cells.size() > std::max(most_cells, profile::DirectStop::PHASES)) {
        stop = timing_->next_stop(run_, cell, StopEffort::QUICK);
    }
    return stop;
}

void CurvePlanner::add_stop(CurvePlan &plan, const profile::Stop &stop) noexcept {
    const Sequence begin = next_cell_;
    for (const profile::TimeCell &cell : stop.cells) {
        write(cell);
    }
    plan.stops[plan.stop_count++] = {numbers_[stop.kept - 1], begin, next_cell_};
}

/// Adds stops at ends of cells before `end`, from the last one to the first. Their distance is a small part
/// of the time of a stop. `room`: number of cells for all of them, in addition to those of direct stops.
void CurvePlanner::add_stops(CurvePlan &plan, std::size_t fixed, const profile::Stop &end, std::size_t room) {
    stops_.assign(1, end);
    double ahead = 0;
    for (std::size_t k = fixed; k < end.kept; ++k) {
        ahead += timing_->cell(k).duration;
    }
    double since = 0, apart = apart_of(end);
    for (std::size_t k = end.kept;
         !is_estimate_ && k-- > fixed + 1 && stops_.size() < CurvePlan::MOST_STOPS;) {
        since += timing_->cell(k).duration;
        ahead -= timing_->cell(k).duration;
        if (since < apart && !(fixed == 0 && k == 1)) {
            continue;
        }
        since = 0;
        // After the first stop that follows the next planning time, stops are only for a late planner, so
        // direct stops suffice.
        const double late = ahead - (PLANNING_S + RENEWAL_S);
        profile::Stop stop = stop_from(k, late > apart ? 0 : room);
        if (late > apart && late < apart_of(stop)) {
            stop = stop_from(k, room);
        }
        if (stop.kept >= stops_.back().kept ||
            stop.cells.size() > std::max(room, profile::DirectStop::PHASES)) {
            continue;
        }
        apart = apart_of(stop);
        room -= std::min(room, stop.cells.size());
        stops_.push_back(stop);
    }
    while (!stops_.empty()) {
        add_stop(plan, stops_.back());
        stops_.pop_back();
    }
}

/// Time between the starts of the previous stop and of this one [s].
double CurvePlanner::apart_of(const profile::Stop &stop) const noexcept {
    double duration = 0;
    for (const profile::TimeCell &cell : stop.cells) {
        duration += cell.duration;
    }
    return timing_->stops_apart_s(duration);
}

}  // namespace mw::trajectory::plan
