// SPDX-License-Identifier: GPL-2.0-or-later
// Checks path commands and passes accepted ones to the planner.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "motion/planner/path_planner.hh"
#include "trajectory/tuning.hh"

namespace mw::motion {

namespace {

constexpr double SOFT_LIMIT_ROUNDING = 1e-6;
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

/// Remaining travel to a soft limit, from the end of a line, or from its start if the sense is -1.
TravelToLimit room_behind(const trajectory::Primitive &line, double sense,
                          const PathLimits &limits) noexcept {
    const geometry::Pose &end = sense > 0 ? line.end : line.start;
    TravelToLimit room;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double slope = sense * line.lin[i];
        if (slope == 0) {
            continue;
        }
        const double limit = slope > 0 ? limits.high[i] : limits.low[i];
        const double way = (limit - end[i]) / slope;
        if (way < room.way) {
            room = {way, i, -1};
        }
    }
    return room;
}

/// Travel of joints that external offsets also move; 0 for other joints.
JointRange shared_extent(const trajectory::Primitive &p, const SharedJoints &shared) noexcept {
    JointRange out;
    for (std::uint32_t left = shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        trajectory::extent_along(p, shared.slope[j], out.low[j], out.high[j]);
    }
    return out;
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
    r.corner_scale = terms.corner_scale > 0 ? terms.corner_scale : limits_.corner_scale;
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
    TravelRange room{{limits_.low, limits_.high}, {limits_.joints.low, limits_.joints.high}};
    if (limits_.offset_axes == 0) {
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
        const bool isShared = (limits_.offset_axes >> i & 1U) != 0;
        room.axes.low[i] -= isShared ? offsets.low[i] : 0.0;
        room.axes.high[i] -= isShared ? offsets.high[i] : 0.0;
    }
    const JointRange taken = limits_.shared.within(offsets);
    for (std::size_t j = 0; j < taken.low.size(); ++j) {  // 0 for joints that are not shared
        room.joints.low[j] -= taken.low[j];
        room.joints.high[j] -= taken.high[j];
    }
    return room;
}

/// Checks soft limits over the whole move, and joint limits if joints are not axes.
Reason PathPlanner::check_reach(const trajectory::Primitive &p, int indexer) noexcept {
    geometry::Pose low;
    geometry::Pose high;
    trajectory::extent(p, low, high);
    const JointRange joints = shared_extent(p, limits_.shared);
    const TravelRange reach = available_travel({{low, high}, joints});
    const PoseRange &room = reach.axes;
    if (view_.indexers_stuck != 0 && indexer < 0) {
        return Reason::INDEXER_OPEN;
    }
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        refused_index_ = static_cast<std::int16_t>(i);
        const bool isMoving = high[i] - low[i] > LEAST_WAY;
        if (isMoving && (limits_.axes & (1U << i)) == 0) {
            return Reason::NO_SUCH_AXIS;
        }
        const int lock = limits_.indexer[static_cast<std::size_t>(i)];
        if (isMoving && lock >= 0 && lock != indexer) {
            return Reason::INDEXER_ALONE;
        }
        // A move from outside the limits is accepted if it ends inside.
        const double from = p.start[i];
        const bool isLow = low[i] < std::min(room.low[i], from) - SOFT_LIMIT_ROUNDING ||
                           p.end[i] < room.low[i] - SOFT_LIMIT_ROUNDING;
        const bool isHigh = high[i] > std::max(room.high[i], from) + SOFT_LIMIT_ROUNDING ||
                            p.end[i] > room.high[i] + SOFT_LIMIT_ROUNDING;
        if (isMoving && (isLow || isHigh)) {
            return Reason::BEYOND_SOFT_LIMIT;
        }
    }
    refused_index_ = -1;
    const bool isChecked = kinematics_.identity() == nullptr && kinematics_.isShareable();
    const Reason reason = isChecked ? check_joints(p, reach.joints) : Reason::NONE;
    return reason == Reason::NONE ? check_shared(p, joints, reach.joints) : reason;
}

/// On an arc a joint can exceed the positions sampled by check_joints(). Shared joints are checked exactly.
Reason PathPlanner::check_shared(const trajectory::Primitive &p, const JointRange &move,
                                 const JointRange &room) noexcept {
    const JointRange start = limits_.shared.at(p.start);
    for (std::uint32_t left = limits_.shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const bool isOut = move.low[j] < std::min(room.low[j], start.low[j]) - SOFT_LIMIT_ROUNDING ||
                           move.high[j] > std::max(room.high[j], start.high[j]) + SOFT_LIMIT_ROUNDING;
        if (isOut) {
            refused_index_ = static_cast<std::int16_t>(j);
            return Reason::JOINT_BEYOND_LIMIT;
        }
    }
    return Reason::NONE;
}

/// True if the joints can move from one point of the path to the next. Halves the distance until the joints
/// change little, or until they would have to move so fast that the path would crawl. Joints that jump at a
/// singular pose do so at any distance.
bool PathPlanner::isSteady(const trajectory::Primitive &p, PathSample from, PathSample to) const noexcept {
    constexpr double MUCH = 30;  // [machine units, degrees]
    constexpr double LITTLE = 1;
    constexpr double SLOWEST = 0.005;  // as a fraction of the speed of the machine
    constexpr int HALVINGS = 40;
    const double wish = limits_.limits.velocity.back();
    const double slowest = wish < trajectory::UNLIMITED ? SLOWEST * wish : 0.0;
    const auto change = [&](const PathSample &a, const PathSample &b) {
        double most = 0;
        for (std::size_t j = 0; j < static_cast<std::size_t>(config_.num_joints); ++j) {
            most = std::max(most, std::abs(b.joints[j] - a.joints[j]));
        }
        return most;
    };
    const auto isCrawling = [&](const PathSample &a, const PathSample &b) {
        bool isSlow = false;
        for (std::size_t j = 0; j < static_cast<std::size_t>(config_.num_joints); ++j) {
            const double step = std::abs(b.joints[j] - a.joints[j]);
            isSlow = isSlow || (step > LITTLE && limits_.joints.velocity[j] * (b.at - a.at) < step * slowest);
        }
        return isSlow;
    };
    bool isMuch = change(from, to) > MUCH;
    for (int n = 0; n < HALVINGS && isMuch && !isCrawling(from, to); ++n) {
        PathSample middle{0.5 * (from.at + to.at), from.joints};
        if (map_.find(trajectory::position_at(p, middle.at), middle.joints.data()) !=
            kinematics::Status::OK) {
            return false;
        }
        (change(from, middle) > change(middle, to) ? to : from) = middle;
        isMuch = change(from, to) > LITTLE;
    }
    return !isMuch && !isCrawling(from, to);
}

Reason PathPlanner::check_joints(const trajectory::Primitive &p, const JointRange &room) noexcept {
    // Sufficient for an angle on a circle not to change by half a revolution between samples.
    constexpr int LEAST_SAMPLES = 64;
    constexpr double SAMPLES_PER_RAD = 1.5;
    constexpr double MOST_SAMPLES = 20000;
    const double sweep = std::abs(p.omega) * p.length;
    const int samples =
        std::max(LEAST_SAMPLES, static_cast<int>(std::min(sweep * SAMPLES_PER_RAD, MOST_SAMPLES)));
    PathSample last{0, end_joints_};
    std::array<double, MAX_JOINTS> begin{};
    for (int n = 0; n <= samples; ++n) {
        PathSample here{p.length * n / samples, last.joints};
        const kinematics::Status status = map_.find(trajectory::position_at(p, here.at), here.joints.data());
        if (status == kinematics::Status::UNREACHABLE) {
            return Reason::UNREACHABLE;
        }
        if (status == kinematics::Status::SINGULAR || (n > 0 && !isSteady(p, last, here))) {
            return Reason::SINGULAR;
        }
        begin = n == 0 ? here.joints : begin;
        const bool isOnTheWay = n < samples;
        for (int j = 0; j < config_.num_joints; ++j) {
            const auto i = static_cast<std::size_t>(j);
            // A joint outside its limit, for instance after its drive was off, may move back but not further
            // out.
            const double low = isOnTheWay ? std::min(room.low[i], begin[i]) : room.low[i];
            const double high = isOnTheWay ? std::max(room.high[i], begin[i]) : room.high[i];
            if (here.joints[i] < low - SOFT_LIMIT_ROUNDING || here.joints[i] > high + SOFT_LIMIT_ROUNDING) {
                refused_index_ = static_cast<std::int16_t>(j);
                return Reason::JOINT_BEYOND_LIMIT;
            }
        }
        last = here;
    }
    end_joints_ = last.joints;
    return Reason::NONE;
}

/// The travel past an end of a line that the joints can follow. `joints`: their positions at that end;
/// `turn`: travel per spindle revolution.
TravelToLimit PathPlanner::room_for_joints(const trajectory::Primitive &line, double sense,
                                           const TravelToLimit &axes, std::array<double, MAX_JOINTS> joints,
                                           double turn) const noexcept {
    constexpr int SAMPLES = 100;
    const geometry::Pose &end = sense > 0 ? line.end : line.start;
    TravelToLimit room = axes;
    const double most = trajectory::TapTuning::MOST_ROOM * turn;
    room.way = std::min(room.way, most);
    const trajectory::Primitive on = trajectory::make_line(end, end + line.lin * (sense * most));
    PathSample last{0, joints};
    for (int n = 1; n <= SAMPLES && last.at < room.way; ++n) {
        PathSample here{on.length * n / SAMPLES, last.joints};
        const bool isFound =
            map_.find(trajectory::position_at(on, here.at), here.joints.data()) == kinematics::Status::OK;
        int stopped = isFound && isSteady(on, last, here) ? -1 : MAX_JOINTS;
        for (int j = 0; j < config_.num_joints && stopped < 0; ++j) {
            const auto i = static_cast<std::size_t>(j);
            const bool isOut =
                here.joints[i] < limits_.joints.low[i] || here.joints[i] > limits_.joints.high[i];
            stopped = isOut ? j : stopped;
        }
        if (stopped >= 0) {
            return {last.at - trajectory::TapTuning::ROOM_MARGIN, -1, stopped};
        }
        last = here;
    }
    return room;
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
        if (joint >= 0 || limits_.indexer[static_cast<std::size_t>(i)] < 0) {
            return -1;
        }
        joint = limits_.indexer[static_cast<std::size_t>(i)];
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
        if (in.lin[i] != 0 && ((limits_.offset_axes | limits_.shared.axes) >> i & 1U) != 0) {
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
    const std::array<double, MAX_JOINTS> start = end_joints_;
    reason = check_reach(in);
    const std::array<double, MAX_JOINTS> bottom = end_joints_;
    end_joints_ = start;  // end of the tap
    if (reason != Reason::NONE) {
        return reason;
    }
    MoveTerms terms = tap.terms;
    terms.mode = PathMode::EXACT_STOP;
    trajectory::MoveRequest request = request_for(c, terms);
    TravelToLimit before = room_behind(in, -1, limits_);
    TravelToLimit behind = room_behind(in, 1, limits_);
    const double turn = terms.feed_per_revolution;
    if (kinematics_.identity() == nullptr) {
        before = room_for_joints(in, -1, before, start, turn);
        behind = room_for_joints(in, 1, behind, bottom, turn);
    }
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
