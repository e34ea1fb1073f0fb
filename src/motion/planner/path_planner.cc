// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/planner/path_planner.hh"

#include <algorithm>
#include <cmath>

#include "base/overloaded.hh"

namespace mw::motion {

namespace {

/// After this many updates without a new command, the end of the last move is planned.
constexpr int STARVING_UPDATES = 3;

/// Rounding of a corner within the extent of its moves [machine units, degrees].
constexpr double CORNER_ROUNDING = 1e-6;
/// Time between making a plan and its start; if the planner takes longer, it makes the plan again.
constexpr double LATENCY_S = 3e-3;

std::uint64_t latency_cycles(double period_s) noexcept {
    return std::max<std::uint64_t>(2, static_cast<std::uint64_t>(std::ceil(LATENCY_S / period_s)));
}

}  // namespace

PathPlanner::PathPlanner(const PathPlannerConfig &config, const kinematics::Kinematics &kinematics,
                         Channels &channels, PathLink &link) noexcept
    : config_(config), kinematics_(kinematics), reach_(kinematics, config.num_joints), channels_(channels),
      link_(link),
      planner_(link.store, {config.servo_period_s, latency_cycles(config.servo_period_s), config.chooser}) {}

void PathPlanner::update() noexcept {
    if (!link_.view.read(view_, 1000)) {
        return;  // the servo thread is writing; retry in the next update
    }
    follow_controller();
    if (reach_.limits().offset_axes != 0) {
        isPathBegun_ && !isIdle() ? window_.follow(view_.executor.done_move) : window_.clear();
        publish_extent();
    }
    const bool isInput = take_commands();
    idle_updates_ = isInput ? 0 : std::min(idle_updates_ + 1, STARVING_UPDATES);
    if (idle_updates_ >= STARVING_UPDATES && planner_.isStarving()) {
        planner_.release_end();
    }
    follow_steps();
    open_gates();
    if (isPathBegun_) {
        planner_.update(view_.executor);
        const trajectory::Trouble trouble = planner_.take_trouble();
        tell_overreach(trouble.overreach);
        if (trouble.isStuck) {
            Fault fault;
            fault.kind = FaultKind::NO_WAY_ON;
            fault.source = !pending_.isEmpty() ? pending_.oldest().source : SourceTag{};
            channels_.planner_faults.push(fault);
        }
    }
    publish();
}

void PathPlanner::follow_controller() noexcept {
    if (view_.limits_version != limits_version_ && reach_.follow(link_.limits)) {
        limits_version_ = view_.limits_version;
        planner_.set_limits(reach_.limits().limits);
        planner_.set_room(reach_.limits().low, reach_.limits().high);
        const kinematics::LinearJoints linear = kinematics_.linear();
        planner_.set_joints(reach_.isMapped() ? &reach_.map() : nullptr, reach_.limits().joints,
                            {linear.joints, linear.slope});
    }
    follow_drops();
    if (view_.epoch != epoch_) {
        epoch_ = view_.epoch;
        isBroken_ = false;
    }
    if (view_.enables != enables_) {
        enables_ = view_.enables;
        isBroken_ = false;
    }
    complete_moves();
    trajectory::Scales scales;
    scales.feed = view_.feed_scale;
    scales.rapid = view_.rapid_scale;
    scales.max_velocity = view_.max_velocity;
    scales.spindle_rps = view_.spindle_rps;
    planner_.set_spindles(view_.spindle_brakings, view_.encoder_steps);
    planner_.set_scales(scales);
}

/// Handles a path that the executor has dropped after a probe trip or a stop.
void PathPlanner::follow_drops() noexcept {
    if (view_.executor.drops == drops_) {
        return;
    }
    const bool isTrip = view_.probe_trips != probe_trips_ && !pending_.isEmpty() && view_.epoch == epoch_;
    complete_moves();
    drops_ = view_.executor.drops;
    probe_trips_ = view_.probe_trips;
    if (isTrip && !pending_.isEmpty() && pending_.oldest().isProbe) {
        last_done_ = pending_.oldest().id;
        answer(last_done_, AnswerKind::DONE, Reason::NONE);
        pending_.drop();
    }
    // An abort has already started a new epoch; any other stop interrupts the path of the current one.
    isBroken_ = isBroken_ || (!pending_.isEmpty() && pending_.newest().epoch == view_.epoch);
    while (!pending_.isEmpty()) {
        answer(pending_.oldest().id, AnswerKind::STALE, Reason::NONE);
        pending_.drop();
    }
    isPathBegun_ = false;
    wasLocked_ = false;
}

void PathPlanner::complete_moves() noexcept {
    const trajectory::Snapshot &e = view_.executor;
    if (!isPathBegun_) {
        return;
    }
    while (!pending_.isEmpty()) {
        const PendingCommand &p = pending_.oldest();
        const bool isReached = e.done_move >= p.after_move;
        const bool isStanding = e.motion == trajectory::Motion::REST && e.done_move >= planner_.last_move();
        if (!isReached || ((p.isFlush || p.isProbe) && !isStanding)) {
            return;
        }
        if (p.indexer >= 0) {
            const std::uint32_t open = view_.indexers_busy | view_.indexers_stuck;
            const bool isLocked = p.isIndexed && (open >> p.indexer & 1U) == 0;
            pending_.newest().isIndexed = isStanding;  // it is alone
            if (!isLocked) {
                return;
            }
        }
        if (p.isProbe && e.isDropping) {
            return;  // its stop has not completed and may reach its end
        }
        const bool isTripped = p.isProbe && view_.probe_trips != probe_trips_;
        probe_trips_ = isTripped ? view_.probe_trips : probe_trips_;
        if (p.isProbe && p.isTripRequired && !isTripped) {
            Fault fault;
            fault.kind = FaultKind::PROBE_NOT_TRIPPED;
            fault.detail = p.isAwayProbe ? 1 : 0;
            fault.source = p.source;
            channels_.planner_faults.push(fault);
        }
        last_done_ = p.id;
        answer(p.id, AnswerKind::DONE, Reason::NONE);
        pending_.drop();
    }
}

/// Takes as many commands as fit. Returns true if it took one.
bool PathPlanner::take_commands() noexcept {
    bool isAny = false;
    isQueueFull_ = false;
    for (int n = 0; n < MAX_COMMANDS_PER_UPDATE; ++n) {
        const PathCommand *c = channels_.path.front();
        const bool isRoom =
            channels_.planner_answers.size() + pending_.size() + 2 < channels_.planner_answers.capacity();
        if (c == nullptr || !isRoom) {
            break;
        }
        const auto age = static_cast<std::int32_t>(c->epoch - epoch_);
        if (age > 0) {
            break;  // the controller has not started this epoch
        }
        if (age < 0 || isBroken_) {
            answer(c->id, AnswerKind::STALE, Reason::NONE);
        } else if (isWaiting(*c)) {
            break;
        } else {
            refused_index_ = -1;
            const Reason reason = accept(*c);
            if (reason != Reason::NONE) {
                answer(c->id, AnswerKind::REFUSED, reason);
                isBroken_ = true;
                planner_.release_end();
            }
        }
        channels_.path.drop();
        isAny = true;
    }
    return isAny;
}

/// True when this command has to wait for an action of the executor.
bool PathPlanner::isWaiting(const PathCommand &c) noexcept {
    if (view_.executor.isDropping || view_.isTypePending ||
        (pending_.isEmpty() && view_.indexers_busy != 0)) {
        return true;
    }
    const bool isAfterLone =
        !pending_.isEmpty() && (pending_.newest().isProbe || pending_.newest().indexer >= 0);
    const bool isIndexing = indexer_of(c.body) >= 0;
    const bool isLone = std::holds_alternative<Probe>(c.body) || isIndexing;
    const bool isStillMoving = isIndexing && isPathBegun_ && !isIdle();
    if (isAfterLone || isStillMoving || (isLone && !pending_.isEmpty())) {
        planner_.release_end();
        return true;
    }
    if (isPathBegun_ && !isIdle() && !planner_.suits()) {
        planner_.release_end();
        return true;
    }
    // The corners of a thread depend on the spindle speed.
    const auto *line = std::get_if<Line>(&c.body);
    if (line != nullptr && line->terms.isThread() && wasLocked_ && !areSpindlesReady()) {
        return true;
    }
    const bool isOutput = std::holds_alternative<SynchedDigitalOutput>(c.body) ||
                          std::holds_alternative<SynchedAnalogOutput>(c.body);
    if (isOutput && link_.store.events.size() >= link_.store.events.capacity()) {
        planner_.release_end();  // previous moves change when the path is executed to here
        isQueueFull_ = true;
        return true;
    }
    isQueueFull_ = isPathBegun_ && !planner_.hasRoom();
    return isQueueFull_ || pending_.size() + 2 >= PendingCommands::CAPACITY;
}

/// True if all accepted commands have been executed.
bool PathPlanner::isIdle() const noexcept {
    const trajectory::Snapshot &e = view_.executor;
    return pending_.isEmpty() && e.motion == trajectory::Motion::REST && e.done_move >= planner_.last_move();
}

/// Begins a path if there is none. Jerk limits and the tolerance of a path change only at standstill.
void PathPlanner::begin_path(const PathCommand &c) noexcept {
    const bool isOutput = std::holds_alternative<SynchedDigitalOutput>(c.body) ||
                          std::holds_alternative<SynchedAnalogOutput>(c.body);
    if (!isPathBegun_ || (!isOutput && isIdle() && !planner_.suits())) {
        planner_.begin(view_.position, view_.executor);
        isPathBegun_ = true;
    }
}

Reason PathPlanner::accept_flush(const PathCommand &c) noexcept {
    if (!isPathBegun_) {
        last_done_ = c.id;
        answer(c.id, AnswerKind::DONE, Reason::NONE);
        return Reason::NONE;
    }
    planner_.release_end();
    add_pending(c, {});
    pending_.newest().isFlush = true;
    return Reason::NONE;
}

/// Every path command must have a handler here; otherwise it does not compile.
Reason PathPlanner::accept(const PathCommand &c) noexcept {
    const auto on_path = [&](auto accept_it) {
        if (!view_.isEnabled || view_.isStopping) {
            return Reason::NOT_ENABLED;
        }
        if (view_.mode != Mode::COORD) {
            return Reason::WRONG_MODE;
        }
        return accept_it();
    };
    const auto begun = [&](auto accept_it) {
        return on_path([&] {
            begin_path(c);
            return accept_it();
        });
    };
    const Overloaded handlers{
        [&](const Flush &) { return accept_flush(c); },
        [&](const RigidTap &tap) { return begun([&] { return accept_tap(c, tap); }); },
        [&](const Line &line) { return begun([&] { return accept_line(c, line.end, line.terms); }); },
        [&](const Arc &arc) { return begun([&] { return accept_arc(c, arc); }); },
        [&](const Probe &probe) { return begun([&] { return accept_probe(c, probe); }); },
        [&](const SynchedDigitalOutput &output) { return begun([&] { return accept_digital(c, output); }); },
        [&](const SynchedAnalogOutput &output) { return begun([&] { return accept_analog(c, output); }); },
    };
    return std::visit(handlers, c.body);
}

bool PathPlanner::areSpindlesReady() const noexcept {
    const std::uint32_t all = (1U << config_.num_spindles) - 1U;
    return (view_.spindles_ready & all) == all;
}

/// Moves that wait for spindles start when these are at speed. Threads start at the index of their spindle,
/// so that each pass begins at the same angle.
void PathPlanner::open_gates() noexcept {
    const trajectory::Sequence gate = isPathBegun_ ? planner_.waiting_gate(view_.executor) : 0;
    if (gate != 0 && !pending_.isEmpty() && pending_.newest().indexer >= 0) {
        if ((view_.indexers_unlocked >> pending_.newest().indexer & 1U) != 0) {
            planner_.open_gate(gate, 0);
        }
        return;
    }
    if (gate == 0 || !areSpindlesReady()) {
        return;
    }
    double delay_s = 0;
    if (planner_.isPhased(gate)) {
        const auto n = static_cast<std::size_t>(planner_.spindle_of(gate));
        const double rps = view_.spindle_rps[n];
        constexpr double SLOWEST_RPS = 1e-3;
        if (std::abs(rps) < SLOWEST_RPS) {
            return;
        }
        const bool isDriven = planner_.isLocked(gate);  // the executor then determines the start
        const bool isTap = planner_.isTap(gate);
        const bool isKnown = isTap || planner_.isPassKnown(view_.executor);
        if (isDriven && !(isKnown && (isTap ? isTapPossible(gate) : isThreadPossible(gate)))) {
            return;
        }
        const double turned = (view_.spindle_revs[n] + rps * planner_.latency_s()) * (rps > 0 ? 1.0 : -1.0);
        delay_s = isDriven ? 0.0 : (std::ceil(turned) - turned) / std::abs(rps);
    }
    planner_.open_gate(gate, delay_s);
}

/// A thread that the machine cannot follow is not started, because its pitch would be wrong.
bool PathPlanner::isThreadPossible(trajectory::Sequence gate) noexcept {
    constexpr double ROUNDING = 1e-9;
    const double load = planner_.pass_load(gate);
    if (load <= 1.0 + ROUNDING) {
        return true;
    }
    tell_impossible(gate, FaultKind::THREAD_TOO_FAST, load);
    return false;
}

bool PathPlanner::isTapPossible(trajectory::Sequence gate) noexcept {
    const trajectory::TapVerdict verdict = planner_.check_tap(gate);
    switch (verdict.obstacle) {
    case trajectory::TapObstacle::NONE: return true;
    case trajectory::TapObstacle::TOO_FAST:
        tell_impossible(gate, FaultKind::TAP_TOO_FAST, verdict.value);
        break;
    case trajectory::TapObstacle::TOO_ABRUPT:
        tell_impossible(gate, FaultKind::TAP_TOO_ABRUPT, verdict.value);
        break;
    case trajectory::TapObstacle::TOO_SUDDEN:
        tell_impossible(gate, FaultKind::TAP_TOO_SUDDEN, verdict.value);
        break;
    case trajectory::TapObstacle::TOO_SHALLOW:
        tell_impossible(gate, FaultKind::TAP_TOO_SHALLOW, verdict.value);
        break;
    }
    return false;
}

static_assert(static_cast<int>(trajectory::Overreach::Kind::NO_ANSWER) ==
                  static_cast<int>(PlannerModuleFault::NO_ANSWER) &&
              static_cast<int>(trajectory::Overreach::Kind::NOT_THERE) ==
                  static_cast<int>(PlannerModuleFault::NOT_THERE));

/// If the machine cannot follow the speeds of a planner module, the path stops and ends there.
void PathPlanner::tell_overreach(const trajectory::Overreach &overreach) noexcept {
    if (overreach.kind == trajectory::Overreach::Kind::NONE) {
        return;
    }
    isBroken_ = true;
    Fault fault;
    fault.kind = FaultKind::PLANNER_MODULE;
    fault.detail = static_cast<std::uint16_t>(overreach.kind);
    fault.value = overreach.value;
    const trajectory::MoveTag &tag = link_.store.move(overreach.move);
    fault.source = {tag.line, tag.file_index, tag.block};
    channels_.planner_faults.push(fault);
}

/// Reports each gate only once.
void PathPlanner::tell_impossible(trajectory::Sequence gate, FaultKind kind, double value) noexcept {
    if (refused_gate_ == gate) {
        return;
    }
    refused_gate_ = gate;
    Fault fault;
    fault.kind = kind;
    fault.index = static_cast<std::int16_t>(planner_.spindle_of(gate));
    fault.value = value;
    const trajectory::MoveTag &tag = link_.store.move(gate);
    fault.source = {tag.line, tag.file_index, tag.block};
    channels_.planner_faults.push(fault);
}

void PathPlanner::follow_steps() noexcept {
    if (!isPathBegun_) {
        return;
    }
    if (view_.steps != steps_) {
        steps_ = view_.steps;
        isStepPending_ = view_.isStepping;
    }
    if (!view_.isStepping) {
        isStepPending_ = false;
        planner_.set_step(false, 0);
        return;
    }
    if (isStepPending_ && planner_.hasNext(view_.executor)) {
        isStepPending_ = false;
        step_from_ = view_.executor.done_move;
        planner_.set_step(true, planner_.next_block(view_.executor));
        return;
    }
    const bool isOver = view_.executor.motion == trajectory::Motion::REST &&
                        view_.executor.done_move > step_from_ && !planner_.hasNext(view_.executor);
    if (!isStepPending_ && (isOver || planner_.isAtStepStop(view_.executor))) {
        link_.steps_done.store(steps_, std::memory_order_release);
    }
}

/// Includes corners, for axes with external offsets and for joints that these move.
void PathPlanner::publish_extent() noexcept {
    const PathExtent extent = window_.extent();
    link_.extent.write(extent);
    PoseRange room{reach_.limits().low, reach_.limits().high};
    for (int i = 0; i < geometry::AXIS_COUNT && !extent.isEmpty; ++i) {
        const bool isShared = (reach_.limits().offset_axes >> i & 1U) != 0;
        room.low[i] = isShared ? extent.range.axes.low[i] - CORNER_ROUNDING : room.low[i];
        room.high[i] = isShared ? extent.range.axes.high[i] + CORNER_ROUNDING : room.high[i];
    }
    trajectory::JointRoom joints;
    joints.joints = extent.isEmpty ? 0 : reach_.limits().shared.joints;
    for (std::size_t j = 0; j < joints.low.size(); ++j) {
        joints.low[j] = extent.range.joints.low[j] - CORNER_ROUNDING;
        joints.high[j] = extent.range.joints.high[j] + CORNER_ROUNDING;
    }
    planner_.set_room(room.low, room.high, joints);
}

void PathPlanner::publish() noexcept {
    if (pending_.isEmpty()) {
        link_.type_asks_seen.store(view_.type_asks, std::memory_order_release);
    }
    const int indexer = pending_.isEmpty() || pending_.newest().isIndexed ? -1 : pending_.newest().indexer;
    const std::uint64_t wanted = indexer >= 0 ? std::uint64_t{1} << indexer : 0;
    link_.indexers_wanted.store(drops_ << 32 | wanted, std::memory_order_release);
    link_.queue_depth.store(pending_.size(), std::memory_order_relaxed);
    link_.isQueueFull.store(isQueueFull_ ? 1 : 0, std::memory_order_relaxed);
    link_.last_done_id.store(last_done_, std::memory_order_release);
}

void PathPlanner::answer(CommandId id, AnswerKind kind, Reason reason) noexcept {
    Answer a;
    a.id = id;
    a.kind = kind;
    a.reason = reason;
    a.index = kind == AnswerKind::REFUSED ? refused_index_ : static_cast<std::int16_t>(-1);
    a.isPath = true;
    channels_.planner_answers.push(a);  // take_commands reserves space for all pending answers
}

}  // namespace mw::motion
