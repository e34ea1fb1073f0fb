// SPDX-License-Identifier: GPL-2.0-or-later
// Checks path commands and passes accepted ones to the planner.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "motion/planner/path_planner.hh"
#include "trajectory/tuning.hh"

namespace mw::motion {

namespace {

/// An axis that moves less than this counts as stopped [machine units, degrees].
constexpr double LEAST_WAY = 1e-9;

bool isFinite(const geometry::Pose &p) noexcept {
    return std::all_of(p.c.begin(), p.c.end(), [](double x) { return std::isfinite(x); });
}

/// Reason why a move is not possible with these settings.
Reason check_terms(const MoveTerms &terms, int num_spindles) noexcept {
    const bool areNumbers = std::isfinite(terms.feed) && std::isfinite(terms.tolerance) &&
                            std::isfinite(terms.naivecam_tolerance) && std::isfinite(terms.corner_scale) &&
                            std::isfinite(terms.feed_per_revolution);
    if (!areNumbers) {
        return Reason::NOT_A_NUMBER;
    }
    const bool isSpindle = terms.synch_spindle >= 0 && terms.synch_spindle < num_spindles;
    return terms.feed < 0 || terms.tolerance < 0 || !isSpindle ? Reason::OUT_OF_RANGE : Reason::NONE;
}

/// Type of a move for the status and the trace.
MotionType type_of(const PathBody &body, const MoveTerms &terms) noexcept {
    if (std::holds_alternative<Probe>(body)) {
        return MotionType::PROBING;
    }
    if (terms.isRapid) {
        return MotionType::TRAVERSE;
    }
    return std::holds_alternative<Arc>(body) ? MotionType::ARC : MotionType::FEED;
}

}  // namespace

trajectory::MoveRequest PathPlanner::request_for(const PathCommand &c,
                                                 const MoveTerms &terms) const noexcept {
    trajectory::MoveRequest r;
    r.tag.id = c.id;
    r.tag.line = terms.source.line;
    r.tag.file_index = terms.source.file_index;
    r.tag.block = terms.source.block;
    r.tag.type = static_cast<std::uint8_t>(type_of(c.body, terms));
    r.tag.requested_velocity = terms.feed;
    r.join = terms.mode;
    r.tolerance = terms.tolerance;
    r.corner_scale = terms.corner_scale > 0 ? terms.corner_scale : reach_.limits().corner_scale;
    const bool hasFeed = terms.feed > 0 || terms.feed_per_revolution > 0;
    r.isRapid = terms.isRapid || !hasFeed;
    r.isOverridable = terms.isFeedOverridable;
    r.feed_per_revolution = terms.feed_per_revolution;
    r.spindle = terms.synch_spindle;
    // A thread begins when the spindle is at speed; feed per revolution follows the current speed.
    r.isLocked = terms.isThread();
    const bool isChainStart = r.isLocked && !wasLocked_;
    r.isPhased = isChainStart;
    r.isGated = terms.isWaitingForSpindleSpeed || isChainStart;
    return r;
}

void PathPlanner::add_pending(const PathCommand &c, const SourceTag &source) noexcept {
    PendingCommand p;
    p.id = c.id;
    p.after_move = planner_.last_move();
    p.source = source;
    p.epoch = c.epoch;
    pending_.add(p);
}

/// Soft limits minus the range of external offsets. The move is published first, so that offsets do not use
/// travel it needs.
TravelRange PathPlanner::available_travel(const TravelRange &move) noexcept {
    TravelRange room{{reach_.limits().low, reach_.limits().high},
                     {reach_.limits().joints.low, reach_.limits().joints.high}};
    if (reach_.limits().offset_axes == 0) {
        return room;
    }
    constexpr int TRIES = 1000;
    window_.add(move, planner_.last_move());
    publish_extent();
    std::atomic_thread_fence(std::memory_order_seq_cst);
    PoseRange offsets;
    if (!link_.offsets.read(offsets, TRIES)) {
        return {{room.axes.high, room.axes.low}, {}};  // no range fits; a servo cycle does not take this long
    }
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const bool isShared = (reach_.limits().offset_axes >> i & 1U) != 0;
        room.axes.low[i] -= isShared ? offsets.low[i] : 0.0;
        room.axes.high[i] -= isShared ? offsets.high[i] : 0.0;
    }
    const JointRange taken = reach_.limits().shared.within(offsets);
    for (std::size_t j = 0; j < taken.low.size(); ++j) {  // 0 for joints that are not shared
        room.joints.low[j] -= taken.low[j];
        room.joints.high[j] -= taken.high[j];
    }
    return room;
}

Reason PathPlanner::check_reach(const trajectory::Primitive &p, int indexer) noexcept {
    const TravelRange move = reach_.extent(p);
    const TravelRange room = available_travel(move);
    if (view_.indexers_stuck != 0 && indexer < 0) {
        return Reason::INDEXER_OPEN;
    }
    const Refusal refusal = reach_.check(p, move, room, indexer);
    refused_index_ = refusal.index;
    return refusal.reason;
}

/// The joint whose lock opens for a rapid move of its axis alone; -1: none.
int PathPlanner::indexer_of(const PathBody &body) const noexcept {
    const auto *line = std::get_if<Line>(&body);
    if (line == nullptr || !line->terms.isRapid) {
        return -1;
    }
    const geometry::Pose way = line->end - (isPathBegun_ ? planner_.end() : view_.position);
    int joint = -1;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        if (std::abs(way[i]) <= LEAST_WAY) {
            continue;
        }
        if (joint >= 0 || reach_.limits().indexer[static_cast<std::size_t>(i)] < 0) {
            return -1;
        }
        joint = reach_.limits().indexer[static_cast<std::size_t>(i)];
    }
    return joint;
}

Reason PathPlanner::accept_line(const PathCommand &c, const geometry::Pose &end,
                                const MoveTerms &terms) noexcept {
    Reason reason = isFinite(end) ? check_terms(terms, config_.num_spindles) : Reason::NOT_A_NUMBER;
    if (reason != Reason::NONE) {
        return reason;
    }
    const trajectory::Primitive p = trajectory::make_line(planner_.end(), end);
    const int indexer = indexer_of(c.body);
    reason = check_reach(p, indexer);
    if (reason != Reason::NONE) {
        return reason;
    }
    if (p.length > 1e-12 * (1.0 + geometry::norm(end))) {
        trajectory::MoveRequest request = request_for(c, terms);
        if (indexer >= 0) {  // it is sent alone, like a probe, and waits at its gate until it is unlocked
            request.join = PathMode::EXACT_STOP;
            request.isGated = true;
            request.tag.type = static_cast<std::uint8_t>(MotionType::INDEX_ROTARY);
        }
        planner_.add(p, request);
        wasLocked_ = terms.isThread();
    }
    add_pending(c, terms.source);
    if (indexer >= 0) {
        pending_.newest().indexer = indexer;
        planner_.release_end();
    }
    return Reason::NONE;
}

Reason PathPlanner::accept_arc(const PathCommand &c, const Arc &arc) noexcept {
    const bool areNumbers =
        isFinite(arc.end) && isFinite(arc.centre) && isFinite(arc.normal) && std::isfinite(arc.angle_rad);
    Reason reason = areNumbers ? check_terms(arc.terms, config_.num_spindles) : Reason::NOT_A_NUMBER;
    if (reason != Reason::NONE) {
        return reason;
    }
    trajectory::Primitive p;
    const trajectory::ArcShape shape{arc.centre, arc.normal, arc.angle_rad, arc.isInUvw};
    if (trajectory::make_arc(planner_.end(), arc.end, shape, p) != trajectory::ArcFault::NONE) {
        return Reason::BAD_ARC;
    }
    reason = check_reach(p);
    if (reason != Reason::NONE) {
        return reason;
    }
    planner_.add(p, request_for(c, arc.terms));
    wasLocked_ = arc.terms.isThread();
    add_pending(c, arc.terms.source);
    return Reason::NONE;
}

/// The moves in and out are two moves that the executor drives as one.
Reason PathPlanner::accept_tap(const PathCommand &c, const RigidTap &tap) noexcept {
    Reason reason = isFinite(tap.end) && std::isfinite(tap.pitch_scale)
                        ? check_terms(tap.terms, config_.num_spindles)
                        : Reason::NOT_A_NUMBER;
    if (reason != Reason::NONE) {
        return reason;
    }
    if (kinematics_.identity() == nullptr && !kinematics_.isShareable()) {
        return Reason::RIGID_TAPPING;  // the motion of the joints cannot be calculated in advance
    }
    const trajectory::Primitive in = trajectory::make_line(planner_.end(), tap.end);
    const bool isLine = in.length > 1e-12 * (1.0 + geometry::norm(tap.end));
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        // Both ends would need clearance for the reversal that external offsets never use.
        if (in.lin[i] != 0 && ((reach_.limits().offset_axes | reach_.limits().shared.axes) >> i & 1U) != 0) {
            refused_index_ = static_cast<std::int16_t>(i);
            return Reason::TAP_OFFSET;
        }
    }
    if (!isLine || !tap.terms.isThread() || !(tap.pitch_scale > 0)) {
        return Reason::OUT_OF_RANGE;
    }
    if ((view_.spindles_reversible & (1U << tap.terms.synch_spindle)) == 0) {
        return Reason::ONE_WAY_SPINDLE;
    }
    const ReachCheck::Joints start = reach_.end_joints();
    reason = check_reach(in);
    const ReachCheck::Joints bottom = reach_.end_joints();
    reach_.set_end_joints(start);  // end of the tap
    if (reason != Reason::NONE) {
        return reason;
    }
    MoveTerms terms = tap.terms;
    terms.mode = PathMode::EXACT_STOP;
    trajectory::MoveRequest request = request_for(c, terms);
    const double turn = terms.feed_per_revolution;
    const TravelToLimit before = reach_.travel_past(in, -1, start, turn);
    const TravelToLimit behind = reach_.travel_past(in, 1, bottom, turn);
    const TravelToLimit &least = before.way < behind.way ? before : behind;
    if (least.way < trajectory::TapTuning::LEAST_ROOM * turn) {
        const int joint = least.joint < MAX_JOINTS ? least.joint : -1;
        refused_index_ = static_cast<std::int16_t>(least.joint >= 0 ? joint : least.axis);
        return least.joint >= 0 ? Reason::TAP_JOINT_ROOM : Reason::TAP_ROOM;
    }
    request.isTapped = true;
    request.isGated = request.isPhased = request.isTap = true;
    request.tap_scale = tap.pitch_scale;
    request.room_before = before.way;
    request.room_behind = behind.way;
    planner_.add(in, request);
    request.isGated = request.isPhased = request.isTap = false;
    planner_.add(trajectory::make_line(in.end, in.start), request);
    planner_.release_end();
    wasLocked_ = false;
    add_pending(c, terms.source);
    return Reason::NONE;
}

/// A probe is sent alone: it waits until earlier moves have completed, and later moves wait for it. A probe
/// that need not trip may begin in its target state: its first cycle then ends it.
Reason PathPlanner::accept_probe(const PathCommand &c, const Probe &probe) noexcept {
    if (probe.mustTrip && view_.isProbeClosed != probe.isAway) {
        return probe.isAway ? Reason::PROBE_ALREADY_OPEN : Reason::PROBE_ALREADY_TRIPPED;
    }
    const trajectory::Sequence before = planner_.last_move();
    MoveTerms terms = probe.terms;
    terms.mode = PathMode::EXACT_STOP;
    const Reason reason = accept_line(c, probe.end, terms);
    if (reason != Reason::NONE) {
        return reason;
    }
    if (planner_.last_move() != before) {
        trajectory::MoveTag &tag = link_.store.move(planner_.last_move());
        tag.isProbe = true;
        tag.isProbeAway = probe.isAway;
    }
    planner_.release_end();
    pending_.newest().isProbe = true;
    pending_.newest().isTripRequired = probe.mustTrip;
    pending_.newest().isAwayProbe = probe.isAway;
    return Reason::NONE;
}

Reason PathPlanner::accept_digital(const PathCommand &c, const SynchedDigitalOutput &output) noexcept {
    if (output.index < 0 || output.index >= config_.num_dio) {
        return Reason::NO_SUCH_OUTPUT;
    }
    trajectory::PathEvent event;
    event.index = static_cast<std::int16_t>(output.index);
    event.value = output.isOn ? 1 : 0;
    return accept_event(c, event);
}

Reason PathPlanner::accept_analog(const PathCommand &c, const SynchedAnalogOutput &output) noexcept {
    if (output.index < 0 || output.index >= config_.num_aio) {
        return Reason::NO_SUCH_OUTPUT;
    }
    if (!std::isfinite(output.value)) {
        return Reason::NOT_A_NUMBER;
    }
    trajectory::PathEvent event;
    event.isAnalog = true;
    event.index = static_cast<std::int16_t>(output.index);
    event.value = output.value;
    return accept_event(c, event);
}

Reason PathPlanner::accept_event(const PathCommand &c, const trajectory::PathEvent &event) noexcept {
    if (!planner_.add_event(event)) {
        return Reason::QUEUE_FULL;
    }
    add_pending(c, {});
    return Reason::NONE;
}

}  // namespace mw::motion
