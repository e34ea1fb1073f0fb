// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/trial.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/exact_arc.hh"
#include "trajectory/path/stretch.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

double ulp(double x) noexcept {
    return std::abs(x) * 0x1p-52;
}

}  // namespace

void Trial::push(const LeaderSample &leader, Sequence piece, std::uint64_t filter) noexcept {
    const std::uint64_t n = ++tick_;
    Sample &to = sample(n);
    const Sample &one = sample(n - 1);
    const Sample &two = sample(n - 2);
    to.leader = leader;
    to.piece = piece;
    tolerance_tick_ = leader.tolerance != one.leader.tolerance ? n : tolerance_tick_;
    to.bend = (leader.pose - one.leader.pose) - (one.leader.pose - two.leader.pose);
    const LeaderSample &old = sample(n - filter).leader;
    sum_ = sum_ + (leader.pose - old.pose);
    s_sum_ += leader.s - old.s;
}

void Trial::push_phase(const PathView &view, const Phase &phase, double t) noexcept {
    const PathStore &store = view.path.store();
    const Piece &piece = store.piece(phase.piece);
    const double x = phase.x_at(t);
    const bool isSecond = piece.blend_d > 0 && piece.offset + x >= piece.blend_d;
    push({position_at(store, piece, x), piece.programmed_s + x, tolerance_at(piece, x),
          piece.move + (isSecond ? 1 : 0)},
         phase.piece, view.conditions.limits.filter());
}

/// Fills what was before the plan from the executor's history.
void Trial::start(const PathView &view, const Snapshot &now, const LeaderState &from) noexcept {
    const PathStore &store = view.path.store();
    const std::uint64_t filter = view.conditions.limits.filter();
    const std::uint64_t known = filter + 4;
    const Piece &piece = store.piece(from.piece);
    const LeaderSample standing{position_at(store, piece, from.x), piece.programmed_s + from.x,
                                tolerance_at(piece, from.x), piece.move};
    tick_ = 2 * HISTORY_CAPACITY;
    const bool isFresh = now.motion == Motion::REST && now.isSettled;
    arc_ = 0;
    for (std::uint64_t i = 0; i <= known; ++i) {
        const std::uint64_t back = known - i;
        const std::uint64_t tick = std::max(now.first_tick, now.tick > back ? now.tick - back : 0);
        Sample &to = sample(tick_ - back);
        to.leader = isFresh ? standing : store.history[tick % HISTORY_CAPACITY];
        to.piece = 0;
    }
    if (!isFresh && (view.conditions.workspace.isMapped() || view.conditions.limits.isFiltered())) {
        take_arc(view, now);
    }
    origin_ = standing.pose;
    s_origin_ = standing.s;
    sum_ = {};
    s_sum_ = 0;
    for (std::uint64_t i = 0; i <= filter + 1; ++i) {
        Sample &to = sample(tick_ - i);
        const Pose &one = sample(tick_ - i - 1).leader.pose;
        const Pose &two = sample(tick_ - i - 2).leader.pose;
        to.bend = (to.leader.pose - one) - (one - two);
        if (i < filter) {
            sum_ = sum_ + (to.leader.pose - origin_);
            s_sum_ += to.leader.s - s_origin_;
        }
    }
    joints_.begin();
    axes_.begin();
    tolerance_tick_ = tick_;
    along_tick_ = arc_ != 0 ? arc_tick_ : 0;
}

/// What the executor still does until the plan begins.
void Trial::drive_on(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept {
    const PathStore &store = view.path.store();
    const LeaderSample rest = sample(tick_).leader;
    Sequence n = now.phase;
    double t = now.time_in_phase;
    for (std::uint64_t c = 1; c < plan.outlook.latency; ++c) {
        double dt = plan.outlook.period_s;
        bool isOver = now.motion == Motion::REST;
        while (!isOver && dt >= store.phase(n).duration - t) {
            dt -= store.phase(n).duration - t;
            isOver = n + 1 >= plan.outlook.phases_end;
            n += isOver ? 0 : 1;
            t = 0;
        }
        if (now.motion == Motion::REST) {
            push(rest, 0, view.conditions.limits.filter());
        } else {
            t = isOver ? store.phase(n).duration : t + dt;
            push_phase(view, store.phase(n), t);
        }
        // Committed already; what follows is compared with it.
        if (view.conditions.workspace.isMapped()) {
            areJointsSound(view);
        }
        areAxesSound(view);
    }
}

/// Minimum tolerance of the samples in the average.
double Trial::least_tolerance(std::uint64_t filter) const noexcept {
    const std::uint64_t differing = tick_ >= tolerance_tick_ + filter ? 1 : filter;
    double tolerance = UNLIMITED;
    for (std::uint64_t i = 0; i < differing; ++i) {
        const double p = sample(tick_ - i).leader.tolerance;
        tolerance = p > 0 ? std::min(tolerance, p) : tolerance;
    }
    return tolerance;
}

/// Distance of the commanded average from the programmed path, each at the averaged position, in order.
double Trial::deviation(const PathView &view) const noexcept {
    const PlannedPath &path = view.path;
    const std::uint64_t filter = view.conditions.limits.filter();
    const double s = s_origin_ + s_sum_ / static_cast<double>(filter);
    Sequence m = std::clamp(sample(tick_ + 1 - filter).leader.move, path.first_move(), path.last_move());
    while (m > path.first_move() && s < path.move(m).start_s) {
        --m;
    }
    while (m < path.last_move() && s > path.move(m).start_s + path.primitive(m).length) {
        ++m;
    }
    const Pose off = mean(filter) - path.programmed_at(m, s - path.move(m).start_s);
    return std::max(geometry::norm_linear(off), geometry::norm_abc(off));
}

bool Trial::isNearPath(const PathView &view) noexcept {
    const double tolerance = least_tolerance(view.conditions.limits.filter());
    if (tolerance >= UNLIMITED) {
        return true;
    }
    excess_ = deviation(view) / tolerance;
    return excess_ <= 1.0;
}

/// Speed and acceleration of the reference itself: a plan from a state that lower bounds no longer allow
/// brakes too late.
bool Trial::isLeaderSound(const PathLimits &limits) const noexcept {
    const Pose &at = sample(tick_).leader.pose;
    const Pose step = at - sample(tick_ - 1).leader.pose;
    const Pose &bend = sample(tick_).bend;
    const double period = limits.period_s();
    const bool isAccelerationTried = tick_ >= along_tick_ + 3;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double rounding = 4.0 * ulp(at[i]);
        const double v = limits.highest().velocity[k] * period * TrialTuning::SLACK + rounding;
        const double a = limits.highest().acceleration[k] * period * period * TrialTuning::SLACK + rounding;
        if (std::abs(step[i]) > v || (isAccelerationTried && std::abs(bend[i]) > a)) {
            return false;
        }
    }
    return true;
}

/// The acceleration along the path at a tick, as a vector.
Pose Trial::along_bend(std::uint64_t tick) const noexcept {
    const Sample &at = sample(tick);
    const Pose step = at.leader.pose - sample(tick - 1).leader.pose;
    const double length2 = geometry::dot(step, step);
    return length2 > 0 ? step * (geometry::dot(at.bend, step) / length2) : Pose{};
}

/// The acceleration step of the reference within the averaging time is at most what the jerk limits allow.
bool Trial::isSwingSound(const PathLimits &limits) noexcept {
    const std::uint64_t n = tick_;
    const std::uint64_t before = n - limits.filter();
    const PerLimited &jerk = limits.wanted().jerk;
    const Pose swing = sample(n).bend - sample(before).bend;
    const double span = limits.period_s() * limits.period_s() * limits.filter_s();
    const Pose &at = sample(n).leader.pose;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double allowed =
            jerk[static_cast<std::size_t>(i)] * span * (1.0 + TrialTuning::ROUNDING) + 4.0 * ulp(at[i]);
        if (std::abs(swing[i]) > allowed) {
            excess_ = std::abs(swing[i]) / allowed;
            along_share_ = (along_bend(n) - along_bend(before))[i] / swing[i];
            return false;
        }
    }
    const double xyz =
        jerk[XYZ_NORM] * span * (1.0 + TrialTuning::ROUNDING) + 8.0 * ulp(geometry::norm_xyz(at));
    if (geometry::norm_xyz(swing) > xyz) {
        excess_ = geometry::norm_xyz(swing) / xyz;
        along_share_ = geometry::norm_xyz(along_bend(n) - along_bend(before)) / geometry::norm_xyz(swing);
        return false;
    }
    return true;
}

/// The exact arc of the reference, 0: none.
Sequence Trial::arc_at(const PathView &view, const LeaderSample &leader) noexcept {
    const PlannedPath &path = view.path;
    const Sequence m = leader.move;
    if (m < path.first_move() || m > path.last_move()) {
        return 0;
    }
    const Primitive &p = path.primitive(m);
    const double x = leader.s - path.move(m).start_s;
    const bool isOn =
        isExactArc(p, path.move(m).request, view.conditions.limits) && x > on_along(p.length) && x < p.length;
    return isOn ? m : 0;
}

/// The newest samples of the executor's history from the arc on which the reference moves, or moved within
/// the averaging time. Before the arc the reference was stopped.
void Trial::take_arc(const PathView &view, const Snapshot &now) noexcept {
    const LeaderHistory &history = view.path.store().history;
    const std::uint64_t filter = view.conditions.limits.filter();
    const auto at = [&](std::uint64_t back) { return history[(now.tick - back) % HISTORY_CAPACITY]; };
    std::uint64_t back = 0;
    while (back < filter && back < now.tick && arc_ == 0) {
        const bool isMoving = at(back).s != at(back + 1).s;
        arc_ = isMoving ? arc_at(view, at(back)) : 0;
        ++back;
    }
    if (arc_ == 0) {
        return;
    }
    arc_tick_ = tick_ - (back - 1);
    const double start_s = view.path.move(arc_).start_s;
    LeaderSample leader = at(0);
    for (std::uint64_t i = 0; i <= filter + 4; ++i) {
        const bool isKnown = leader.s > start_s && i < now.tick;
        leader = isKnown ? at(i) : leader;
        if (leader.s <= start_s) {
            leader.s = start_s;
            leader.pose = view.path.primitive(arc_).start;
        }
        sample(tick_ - i).leader = leader;
    }
}

/// On an exact arc, and while a part of it is within the averaging time, the averaged position on it is
/// commanded.
Pose Trial::commanded(const PathView &view) noexcept {
    const std::uint64_t filter = view.conditions.limits.filter();
    const bool isMoving = sample(tick_).leader.s != sample(tick_ - 1).leader.s;
    if (const Sequence arc = arc_at(view, sample(tick_).leader); arc != 0 && isMoving) {
        arc_ = arc;
        arc_tick_ = tick_;
    }
    if (arc_ == 0 || tick_ >= arc_tick_ + filter) {
        return mean(filter);
    }
    // The reference stops for the averaging time before and after, so all averaged positions are on the arc.
    const double s = s_origin_ + s_sum_ / static_cast<double>(filter) - view.path.move(arc_).start_s;
    return position_at(view.path.primitive(arc_), std::clamp(s, 0.0, view.path.primitive(arc_).length));
}

bool Trial::areJointsSound(const PathView &view) noexcept {
    const Workspace &workspace = view.conditions.workspace;
    const JointLimits &joints = workspace.joints;
    double *places = joints_.places(tick_);
    std::fill_n(places, MAX_JOINTS, 0.0);
    if (!workspace.map->joints_at(commanded(view), places)) {
        joints_.forget();
        return false;
    }
    return joints_.isSound({.count = static_cast<std::size_t>(joints.count),
                            .velocity = joints.velocity.data(),
                            .acceleration = joints.acceleration.data(),
                            .jerk = joints.jerk.data(),
                            .period_s = view.conditions.limits.period_s(),
                            .isJerkLimited = view.conditions.limits.isFiltered()},
                           tick_);
}

/// Checks the axes where reference or average is on an exact arc: the acceleration step of the reference has
/// no meaning there.
bool Trial::areAxesSound(const PathView &view) noexcept {
    if (!view.conditions.limits.isFiltered()) {
        return true;
    }
    const Pose at = commanded(view);
    if (arc_ == 0 || tick_ >= arc_tick_ + view.conditions.limits.filter() + 3) {
        return true;
    }
    const Primitive &arc = view.path.primitive(arc_);
    const Limits &limits = view.conditions.limits.highest();
    const Limits &wanted = view.conditions.limits.wanted();
    std::copy_n(at.c.data(), geometry::AXIS_COUNT, axes_.places(tick_));
    return axes_.isSound({.count = geometry::AXIS_COUNT,
                          .velocity = limits.velocity.data(),
                          .acceleration = limits.acceleration.data(),
                          .jerk = wanted.jerk.data(),
                          .hasNorm = true,
                          .period_s = view.conditions.limits.period_s(),
                          .isJerkLimited = true,
                          .size = 2.0 * (arc.radius + std::max(0.0, arc.dradius * arc.length))},
                         tick_);
}

/// The reference is on an arc whose averaged position is commanded, or the averaging time contains one:
/// ExactArc keeps the limits there and areAxesSound checks them.
bool Trial::isOnExactArc(const PathView &view) noexcept {
    const Sequence piece = sample(tick_).piece;
    const Piece &on = view.path.piece(piece);
    const double x = sample(tick_).leader.s - on.programmed_s;
    const bool isOn = piece != 0 && on.isAlong && x > 2.0 * on_along(on.length) && x < on.length;
    along_tick_ = isOn ? tick_ : along_tick_;
    return tick_ < along_tick_ + view.conditions.limits.filter() + 3;
}

bool Trial::isNewestSound(const PathView &view) noexcept {
    const PathLimits &limits = view.conditions.limits;
    along_share_ = 0;
    if (view.conditions.workspace.isMapped() && !areJointsSound(view)) {
        const bool isMeasured = limits.isFiltered() && joints_.excess() > 1;
        excess_ = isMeasured ? joints_.excess() : TrialTuning::UNMEASURED;
        return false;
    }
    if (!limits.isFiltered()) {
        return true;
    }
    const bool isExact = isOnExactArc(view);
    if (!areAxesSound(view)) {
        excess_ = axes_.excess();
        along_share_ = 1;
        return false;
    }
    if (!isLeaderSound(limits)) {
        excess_ = TrialTuning::UNMEASURED;
        return false;
    }
    return isExact || (isSwingSound(limits) && isNearPath(view));
}

bool Trial::isPlanSound(const PathView &view, const TrialPlan &plan) noexcept {
    const PathStore &store = view.path.store();
    const std::uint64_t start = tick_;
    double t = 0;
    Sequence n = plan.begin;
    while (n < plan.end && tick_ - start < TrialTuning::MOST_SAMPLES) {
        push_phase(view, store.phase(n), t);
        if (!isNewestSound(view)) {
            return false;
        }
        t += plan.outlook.period_s;
        const Sequence before = n;
        while (n < plan.end && t >= store.phase(n).duration) {
            t -= store.phase(n).duration;
            ++n;
        }
        // More than the executor would pass in one cycle.
        if (n - before > TrialTuning::MOST_PHASES) {
            return false;
        }
    }
    // The average catches up while the reference is stopped.
    const Phase &last = store.phase(plan.end - 1);
    for (std::uint64_t i = 0; n == plan.end && i <= view.conditions.limits.filter(); ++i) {
        push_phase(view, last, last.duration);
        if (!isNewestSound(view)) {
            return false;
        }
    }
    return true;
}

Verdict Trial::check(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept {
    start(view, now, plan.from);
    drive_on(view, now, plan);
    const bool isSound = isPlanSound(view, plan);
    return {isSound, tick_, excess_, along_share_};
}

Cause Trial::cause_of(const Verdict &verdict, const PathLimits &limits, Sequence first_free) const noexcept {
    Cause cause;
    for (std::uint64_t i = 0; i <= limits.filter() + 2; ++i) {
        const Sequence k = sample(verdict.tick - i).piece;
        const bool isFree = k >= first_free && k > 0;
        cause.isAfterDriven = cause.isAfterDriven || !isFree;
        cause.high = isFree ? std::max(cause.high, k) : cause.high;
        cause.low = isFree ? (cause.low == 0 ? k : std::min(cause.low, k)) : cause.low;
    }
    return cause;
}

}  // namespace mw::trajectory
