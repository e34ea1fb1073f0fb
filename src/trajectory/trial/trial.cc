// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/trial.hh"

#include <algorithm>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

/// False when the joints exceed a limit at this sample, or cannot be there.
bool Trial::push(const PathView &view, const Pose &pose, Sequence piece) noexcept {
    ++tick_;
    pieces_[tick_ % DEPENDS] = piece;
    const Workspace &workspace = view.conditions.workspace;
    const JointLimits &joints = workspace.joints;
    double *places = joints_.places(tick_);
    std::fill_n(places, MAX_JOINTS, 0.0);
    return workspace.map->joints_at(pose, places) &&
           joints_.isSound({static_cast<std::size_t>(joints.count), joints.velocity.data(),
                            joints.acceleration.data(), view.conditions.limits.period_s()},
                           tick_);
}

bool Trial::push_phase(const PathView &view, const Phase &phase, double t) noexcept {
    const PathStore &store = view.path.store();
    return push(view, position_at(store, store.piece(phase.piece), phase.x_at(t)), phase.piece);
}

/// What the executor still does until the plan begins. It is committed already; what follows is compared with
/// it.
void Trial::drive_on(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept {
    const PathStore &store = view.path.store();
    const Piece &piece = store.piece(plan.from.piece);
    const Pose rest = position_at(store, piece, plan.from.x);
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
            push(view, rest, 0);
        } else {
            t = isOver ? store.phase(n).duration : t + dt;
            push_phase(view, store.phase(n), t);
        }
    }
}

bool Trial::isPlanSound(const PathView &view, const TrialPlan &plan) noexcept {
    const PathStore &store = view.path.store();
    const std::uint64_t start = tick_;
    double t = 0;
    Sequence n = plan.begin;
    while (n < plan.end && tick_ - start < TrialTuning::MOST_SAMPLES) {
        if (!push_phase(view, store.phase(n), t)) {
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
    const Phase &last = store.phase(plan.end - 1);
    for (int i = 0; n == plan.end && i < 2; ++i) {
        if (!push_phase(view, last, last.duration)) {
            return false;
        }
    }
    return true;
}

Verdict Trial::check(const PathView &view, const Snapshot &now, const TrialPlan &plan) noexcept {
    tick_ = DEPENDS;
    pieces_.fill(0);
    joints_.begin();
    drive_on(view, now, plan);
    return {isPlanSound(view, plan), tick_};
}

Cause Trial::cause_of(const Verdict &verdict, Sequence first_free) const noexcept {
    Cause cause;
    for (std::uint64_t i = 0; i < DEPENDS; ++i) {
        const Sequence k = pieces_[(verdict.tick - i) % DEPENDS];
        const bool isFree = k >= first_free && k > 0;
        cause.isAfterDriven = cause.isAfterDriven || !isFree;
        cause.high = isFree ? std::max(cause.high, k) : cause.high;
        cause.low = isFree ? (cause.low == 0 ? k : std::min(cause.low, k)) : cause.low;
    }
    return cause;
}

}  // namespace mw::trajectory
