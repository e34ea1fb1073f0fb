// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits every plan is tried out before it is committed, sample by sample up to its stop, as the
// executor will drive it: swing of the acceleration within the mean, and deviation from the programmed path.
// What fails is made slower where it failed.
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

namespace {

double ulp(double x) noexcept {
    return std::abs(x) * 0x1p-52;
}

}  // namespace

void Planner::push_sample(const LeaderSample &sample, Sequence piece) noexcept {
    const std::uint64_t n = ++trial_tick_;
    TrialSample &to = trial_[n % HISTORY_CAPACITY];
    const TrialSample &one = trial_[(n - 1) % HISTORY_CAPACITY];
    const TrialSample &two = trial_[(n - 2) % HISTORY_CAPACITY];
    to.leader = sample;
    to.piece = piece;
    tolerance_tick_ = sample.tolerance != one.leader.tolerance ? n : tolerance_tick_;
    to.bend = (sample.pose - one.leader.pose) - (one.leader.pose - two.leader.pose);
    const LeaderSample &old = trial_[(n - filter_) % HISTORY_CAPACITY].leader;
    trial_sum_ = trial_sum_ + (sample.pose - old.pose);
    trial_s_sum_ += sample.s - old.s;
}

/// Fills what was before the plan: the executor's history, then what it still does until the plan begins.
void Planner::start_trial(const Snapshot &now, const State &from) noexcept {
    const std::uint64_t known = filter_ + 4;
    const Piece &piece = store_.piece(from.piece);
    LeaderSample start{position_at(store_, piece, from.x), piece.programmed_s + from.x,
                       tolerance_at(piece, from.x), piece.move};
    trial_tick_ = 2 * HISTORY_CAPACITY;
    const bool isFresh = now.motion == Motion::REST && now.isSettled;
    for (std::uint64_t i = 0; i <= known; ++i) {
        const std::uint64_t back = known - i;
        const std::uint64_t tick = std::max(now.first_tick, now.tick > back ? now.tick - back : 0);
        TrialSample &to = trial_[(trial_tick_ - back) % HISTORY_CAPACITY];
        to.leader = isFresh ? start : store_.history[tick % HISTORY_CAPACITY];
        to.piece = 0;
    }
    trial_origin_ = start.pose;
    trial_s_origin_ = start.s;
    trial_sum_ = {};
    trial_s_sum_ = 0;
    for (std::uint64_t i = 0; i <= filter_ + 1; ++i) {
        TrialSample &to = trial_[(trial_tick_ - i) % HISTORY_CAPACITY];
        const Pose &one = trial_[(trial_tick_ - i - 1) % HISTORY_CAPACITY].leader.pose;
        const Pose &two = trial_[(trial_tick_ - i - 2) % HISTORY_CAPACITY].leader.pose;
        to.bend = (to.leader.pose - one) - (one - two);
        if (i < filter_) {
            trial_sum_ = trial_sum_ + (to.leader.pose - trial_origin_);
            trial_s_sum_ += to.leader.s - trial_s_origin_;
        }
    }
    joint_tick_ = 0;
    tolerance_tick_ = trial_tick_;
    // Until the plan begins.
    Sequence n = now.phase;
    double t = now.time_in_phase;
    const Sequence end = plan_ends_[now.plan % plan_ends_.size()];
    LeaderSample rest = trial_[trial_tick_ % HISTORY_CAPACITY].leader;
    for (std::uint64_t c = 1; c < settings_.latency; ++c) {
        double dt = settings_.period_s;
        bool isOver = now.motion == Motion::REST;
        while (!isOver && dt >= store_.phase(n).duration - t) {
            dt -= store_.phase(n).duration - t;
            isOver = n + 1 >= end;
            n += isOver ? 0 : 1;
            t = 0;
        }
        if (now.motion == Motion::REST) {
            push_sample(rest, 0);
        } else {
            t = isOver ? store_.phase(n).duration : t + dt;
            try_sample(store_.phase(n), t);
        }
        if (joint_map_ != nullptr) {
            areJointsSound();  // committed already; what follows is compared with it
        }
    }
}

void Planner::try_sample(const Phase &phase, double t) noexcept {
    const Piece &piece = store_.piece(phase.piece);
    const double x = phase.x0 + t * (phase.v0 + t * (0.5 * phase.a + t * phase.j * (1.0 / 6.0)));
    const bool isSecond = piece.blend_d > 0 && piece.offset + x >= piece.blend_d;
    push_sample({position_at(store_, piece, x), piece.programmed_s + x, tolerance_at(piece, x),
                 piece.move + (isSecond ? 1 : 0)},
                phase.piece);
}

/// The least tolerance of the samples in the mean.
double Planner::trial_tolerance() const noexcept {
    const std::uint64_t n = trial_tick_;
    const std::uint64_t differing = n >= tolerance_tick_ + filter_ ? 1 : filter_;
    double tolerance = UNLIMITED;
    for (std::uint64_t i = 0; i < differing; ++i) {
        const double p = trial_[(n - i) % HISTORY_CAPACITY].leader.tolerance;
        tolerance = p > 0 ? std::min(tolerance, p) : tolerance;
    }
    return tolerance;
}

/// Distance of the commanded mean from the programmed path, each matched with the mean place: in order.
double Planner::trial_deviation(std::uint64_t tick) noexcept {
    const double n = static_cast<double>(filter_);
    const Pose mean = trial_origin_ + trial_sum_ * (1.0 / n);
    const double s = trial_s_origin_ + trial_s_sum_ / n;
    Sequence m =
        std::clamp(trial_[(tick + 1 - filter_) % HISTORY_CAPACITY].leader.move, first_move_, last_move_);
    while (m > first_move_ && s < move_plan(m).start_s) {
        --m;
    }
    while (m < last_move_ && s > move_plan(m).start_s + store_.primitive(m).length) {
        ++m;
    }
    const Pose off = mean - programmed_at(m, s - move_plan(m).start_s);
    return std::max(geom::norm_linear(off), geom::norm_abc(off));
}

/// Speed and acceleration of the leader itself: a plan from a state that bounds made lower since no longer
/// allow for brakes too late.
bool Planner::isLeaderSound() const noexcept {
    const std::uint64_t n = trial_tick_;
    const Pose &at = trial_[n % HISTORY_CAPACITY].leader.pose;
    const Pose step = at - trial_[(n - 1) % HISTORY_CAPACITY].leader.pose;
    const Pose &bend = trial_[n % HISTORY_CAPACITY].bend;
    const double period = settings_.period_s;
    const bool isAccelerationTried = n >= along_tick_ + 3;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double rounding = 4.0 * ulp(at[i]);
        const double v = highest_.velocity[k] * period * TrialTuning::SLACK + rounding;
        const double a = highest_.acceleration[k] * period * period * TrialTuning::SLACK + rounding;
        if (std::abs(step[i]) > v || (isAccelerationTried && std::abs(bend[i]) > a)) {
            return false;
        }
    }
    return true;
}

/// The acceleration along the path at a tick, as a vector.
Pose Planner::along_bend(std::uint64_t tick) const noexcept {
    const TrialSample &at = trial_[tick % HISTORY_CAPACITY];
    const Pose step = at.leader.pose - trial_[(tick - 1) % HISTORY_CAPACITY].leader.pose;
    const double length2 = geom::dot(step, step);
    return length2 > 0 ? step * (geom::dot(at.bend, step) / length2) : Pose{};
}

bool Planner::isTrialSound() noexcept {
    const std::uint64_t n = trial_tick_;
    along_share_ = 0;
    if (joint_map_ != nullptr && !areJointsSound()) {
        excess_ = TrialTuning::UNMEASURED;
        return false;
    }
    if (!isFiltered()) {
        return true;
    }
    const Sequence piece = trial_[n % HISTORY_CAPACITY].piece;
    const Piece &on = store_.piece(piece);
    const double x = trial_[n % HISTORY_CAPACITY].leader.s - on.programmed_s;
    const bool isAlong = piece != 0 && on.isAlong && x > 2.0 * on_along(on.length) && x < on.length;
    along_tick_ = isAlong ? n : along_tick_;
    if (!isLeaderSound()) {
        excess_ = TrialTuning::UNMEASURED;
        return false;
    }
    if (n < along_tick_ + filter_ + 3) {
        return true;  // kept by along_limit
    }
    const Pose swing = trial_[n % HISTORY_CAPACITY].bend - trial_[(n - filter_) % HISTORY_CAPACITY].bend;
    const double span = settings_.period_s * settings_.period_s * filter_s();
    const Pose &at = trial_[n % HISTORY_CAPACITY].leader.pose;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double allowed =
            wanted_.jerk[static_cast<std::size_t>(i)] * span * (1.0 + TrialTuning::ROUNDING) +
            4.0 * ulp(at[i]);
        if (std::abs(swing[i]) > allowed) {
            excess_ = std::abs(swing[i]) / allowed;
            along_share_ = (along_bend(n) - along_bend(n - filter_))[i] / swing[i];
            return false;
        }
    }
    const double xyz =
        wanted_.jerk[XYZ_NORM] * span * (1.0 + TrialTuning::ROUNDING) + 8.0 * ulp(geom::norm_xyz(at));
    if (geom::norm_xyz(swing) > xyz) {
        excess_ = geom::norm_xyz(swing) / xyz;
        along_share_ = geom::norm_xyz(along_bend(n) - along_bend(n - filter_)) / geom::norm_xyz(swing);
        return false;
    }
    const double tolerance = trial_tolerance();
    if (tolerance >= UNLIMITED) {
        return true;
    }
    excess_ = trial_deviation(n) / tolerance;
    return excess_ <= 1.0;
}

/// The plan since phase `begin` runs through a place where it has to stand: an attempt that made
/// accelerations less left no way to stop from where the plan before it leads.
bool Planner::isStopPassed(Sequence begin) const noexcept {
    for (Sequence n = begin; n < plan_end_; ++n) {
        const Phase &p = store_.phase(n);
        if (p.x0 <= 0 && p.v0 > 0 && piece_plan(p.piece).isStopBefore) {
            return true;
        }
    }
    return false;
}

bool Planner::isPlanSound(const Snapshot &now, const State &from, Sequence begin) noexcept {
    start_trial(now, from);
    failed_tick_ = 0;
    along_tick_ = 0;
    const std::uint64_t start = trial_tick_;
    double t = 0;
    Sequence n = begin;
    while (n < plan_end_ && trial_tick_ - start < TrialTuning::MOST_SAMPLES) {
        try_sample(store_.phase(n), t);
        if (!isTrialSound()) {
            failed_tick_ = trial_tick_;
            return false;
        }
        t += settings_.period_s;
        const Sequence before = n;
        while (n < plan_end_ && t >= store_.phase(n).duration) {
            t -= store_.phase(n).duration;
            ++n;
        }
        // More than the executor would pass in one cycle.
        if (n - before > TrialTuning::MOST_PHASES) {
            failed_tick_ = trial_tick_;
            return false;
        }
    }
    // The mean catches up while the leader stands.
    const Phase &last = store_.phase(plan_end_ - 1);
    for (std::uint64_t i = 0; n == plan_end_ && i <= filter_; ++i) {
        try_sample(last, last.duration);
        if (!isTrialSound()) {
            failed_tick_ = trial_tick_;
            return false;
        }
    }
    return true;
}

void Planner::scale_piece(Sequence piece, double speed, double acceleration) noexcept {
    piece_plan(piece).v_limit *= speed;
    AccelBound &bound = store_.piece(piece).acceleration;
    for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
        bound.alpha[i] *= acceleration;
        bound.beta[i] *= acceleration;
    }
}

/// As scale_piece, and can be taken back.
void Planner::ease_piece(Sequence piece, double speed, double acceleration) noexcept {
    PiecePlan &plan = piece_plan(piece);
    if (plan.eased_in != replan_) {
        plan.eased_in = replan_;
        plan.eased_speed = 1;
        plan.eased_acceleration = 1;
    }
    plan.eased_speed *= speed;
    plan.eased_acceleration *= acceleration;
    scale_piece(piece, speed, acceleration);
}

/// Takes back what this replanning has eased: it did not help, since the trial failed for what was driven
/// before.
void Planner::take_back_easing() noexcept {
    for (Sequence k = oldest_piece_; k <= last_piece_; ++k) {
        PiecePlan &plan = piece_plan(k);
        if (plan.eased_in == replan_) {
            scale_piece(k, 1.0 / plan.eased_speed, 1.0 / plan.eased_acceleration);
            plan.eased_in = 0;
            plan.v2_in = -1;
        }
    }
    pass_backward(last_piece_, true);
}

/// No piece loses more than a part of its acceleration to `factor` and those before it.
bool Planner::canBeGentler(Sequence low, Sequence high, double factor) const noexcept {
    for (Sequence k = low; k <= high; ++k) {
        if (!(piece_plan(k).gentle * factor >= EasingTuning::LEAST_ALONG)) {
            return false;
        }
    }
    return true;
}

/// The attempt before has made accelerations along the path less, and that was not what failed.
void Planner::take_back_gentleness() noexcept {
    if (gentle_.low == 0) {
        return;
    }
    for (Sequence k = gentle_.low; k <= gentle_.high; ++k) {
        ease_piece(k, 1.0, 1.0 / gentle_.factor);
        piece_plan(k).gentle /= gentle_.factor;
    }
    pass_backward(std::min(gentle_.high + 1, last_piece_), true);
    gentle_ = {};
}

/// What follows can still be kept from this state.
bool Planner::isKept(const State &from) const noexcept {
    const Piece &p = store_.piece(from.piece);
    const double out2 = from.piece == last_piece_ ? 0.0 : piece_plan(from.piece + 1).v2_in;
    return from.v * from.v <=
           p.acceleration.highest_before(out2, p.length - from.x) * (1.0 + TrialTuning::ROUNDING);
}

/// Makes what the failed sample depends on slower, as far as it is not driven yet: longer stands at stops,
/// then slower curves, then anything. False when nothing can be done from here.
bool Planner::ease(const State &from) noexcept {
    const Sequence first = from.v > 0 ? from.piece + 1 : from.piece;
    Sequence low = 0;
    Sequence high = 0;
    isAfterDriven_ = false;
    for (std::uint64_t i = 0; i <= filter_ + 2; ++i) {
        const Sequence k = trial_[(failed_tick_ - i) % HISTORY_CAPACITY].piece;
        const bool isFree = k >= first && k > 0;
        isAfterDriven_ = isAfterDriven_ || !isFree;
        high = isFree ? std::max(high, k) : high;
        low = isFree ? (low == 0 ? k : std::min(low, k)) : low;
    }
    if (low == 0) {
        return false;
    }
    const double tau = filter_s();
    double most_dwell = 0;  // that a stop may still become longer
    double rising_s = 0;    // what the pieces take to come to speed
    bool isAnyCurved = false;
    for (Sequence k = low; k <= high; ++k) {
        const PiecePlan &plan = piece_plan(k);
        most_dwell = plan.isStopBefore ? std::max(most_dwell, tau - plan.dwell_s) : most_dwell;
        isAnyCurved = isAnyCurved || isCurved(k);
        const double a = store_.piece(k).acceleration.at(0);
        rising_s += std::min(cap_of(k) / a, std::sqrt(2.0 * store_.piece(k).length / a));
    }
    const bool isGentle = (excess_ - 1.0) * rising_s < EasingTuning::STAND_WORTH * most_dwell &&
                          excess_ < EasingTuning::MOST_GENTLE;
    if (most_dwell > 0 && !isGentle) {
        for (Sequence k = low; k <= high; ++k) {
            PiecePlan &plan = piece_plan(k);
            plan.dwell_s = plan.isStopBefore ? std::min(tau, plan.dwell_s + EasingTuning::STAND_STEP * tau)
                                             : plan.dwell_s;
        }
        return true;
    }
    const bool hasHelped =
        failed_tick_ > eased_tick_ || excess_ - 1.0 < EasingTuning::HELPED * (eased_excess_ - 1.0);
    if (!hasHelped) {
        take_back_gentleness();
    }
    const double along = 1.0 - EasingTuning::ALONG_MARGIN * (excess_ - 1.0) / (along_share_ * excess_) -
                         EasingTuning::ALONG_ROOM;
    const bool isAlong = most_dwell <= 0 && along_share_ > EasingTuning::ALONG_SHARE && hasHelped &&
                         canBeGentler(low, high, along);
    // Where slower curves alone make it no better, it is what leads to them.
    const bool isEverything = !isAnyCurved || most_dwell > 0 || isAlong || excess_ >= eased_excess_;
    eased_excess_ = excess_;
    eased_tick_ = failed_tick_;
    const auto scale = [&](double speed, double acceleration) {
        for (Sequence k = low; k <= high; ++k) {
            if (isCurved(k) || isEverything) {
                ease_piece(k, speed, acceleration);
            }
            piece_plan(k).v2_in = -1;
        }
        pass_backward(std::min(high + 1, last_piece_), true);
    };
    const double slower = most_dwell > 0 || isAlong
                              ? 1.0
                              : std::clamp(EasingTuning::LEAST_SLOWER / std::sqrt(excess_),
                                           EasingTuning::SLOWEST, EasingTuning::LEAST_SLOWER);
    const double gentler = isAlong ? along
                                   : std::clamp(EasingTuning::LEAST_GENTLER / excess_, EasingTuning::GENTLEST,
                                                EasingTuning::LEAST_GENTLER);
    scale(slower, gentler);
    gentle_ = isAlong ? Gentleness{low, high, gentler} : Gentleness{};
    for (Sequence k = gentle_.low; k <= gentle_.high && k > 0; ++k) {
        piece_plan(k).gentle *= gentler;
    }
    if (from.v > 0 && !isKept(from)) {
        scale(1.0 / slower, 1.0 / gentler);
        gentle_ = {};
        return false;
    }
    return true;
}

bool Planner::isCurved(Sequence piece) const noexcept {
    const Piece &p = store_.piece(piece);
    return p.blend_d > 0 || store_.primitive(p.primitive).isArc || joint_map_ != nullptr;
}

}  // namespace mw::traj
