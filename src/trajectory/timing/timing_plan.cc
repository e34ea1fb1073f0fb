// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/timing_plan.hh"

#include <cmath>

#include "trajectory/timing/acceleration_limited.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

void TimingPlan::begin(const Snapshot &now) noexcept {
    profile_.begin();
    commitments_.begin(now, draft_.end);
    draft_.at = {};
    draft_.reached = 0;
    draft_.overreach = {};
    start_delay_s_ = 0;
}

void TimingPlan::look(const PathView &view, const Snapshot &now) noexcept {
    oldest_phase_ = commitments_.oldest_phase(now);
    if (!view.path.isAllDriven()) {
        profile_.pass_backward(view, view.path.last_piece(), false);
    }
}

bool TimingPlan::isSteady(const Scales &before, const Scales &after, bool isFollowed) noexcept {
    bool isSame =
        after.feed == before.feed && after.rapid == before.rapid && after.max_velocity == before.max_velocity;
    ++steady_updates_;
    const double slight =
        steady_updates_ > TimingTuning::STEADY_UPDATES ? TimingTuning::DRIFTED : TimingTuning::CHANGED;
    for (std::size_t i = 0; i < after.spindle_rps.size() && isSame && isFollowed; ++i) {
        const double rps = before.spindle_rps[i];
        isSame = std::abs(after.spindle_rps[i] - rps) <= slight * std::abs(rps);
    }
    steady_updates_ = isSame ? steady_updates_ : 0;
    return isSame;
}

void TimingPlan::renew_all(const PathView &view) noexcept {
    profile_.pass_backward(view, view.path.last_piece(), true);
}

void TimingPlan::rescale(const PathView &view) noexcept {
    renew_all(view);
    profile_.change_from(view.path.oldest_piece());
}

void TimingPlan::renew_span(const PathView &view, Sequence low, Sequence high) noexcept {
    profile_.renew(view, low, high);
}

Demand TimingPlan::demand(const PathView &view, const Snapshot &now) noexcept {
    if (now.isHeld || now.motion == Motion::BRAKE) {
        return {};
    }
    const Sequence changed = profile_.changed_from();
    const bool isPlanChanged = changed != 0 && changed <= draft_.at.piece + 1;
    if (commitments_.isPending(now)) {
        return {isPlanChanged ? Demand::Kind::NOTHING : Demand::Kind::EXTEND, {}};
    }
    std::optional<LeaderState> from;
    if (now.motion == Motion::REST) {
        from = start_state(view.path, now);
    } else if (commitments_.isTaken(now) && !isPlanChanged) {
        profile_.keep();
        return {Demand::Kind::EXTEND, {}};
    } else {
        from = predict(view.path, now, outlook(now));
    }
    const bool isFree = from && !isBeforeBarrier(view, *from);
    return isFree ? Demand{Demand::Kind::PLAN, *from} : Demand{};
}

Demand TimingPlan::tried_demand(const PathView &view, const Snapshot &now) const noexcept {
    const bool isPending = commitments_.isPending(now);
    if (now.isHeld || isPending) {
        return {};
    }
    std::optional<LeaderState> from;
    if (now.motion == Motion::REST) {
        from = start_state(view.path, now);
    } else {
        const Sequence changed = profile_.changed_from();
        const bool isShort = !draft_.isAtEndOf(view.path) && draft_.seconds - seconds_driven(now) <
                                                                 TimingTuning::RENEWAL * settings_.horizon_s;
        const bool isChanged = changed != 0 && changed <= draft_.looked_at + 1;
        if (commitments_.isTaken(now) && !isShort && !isChanged) {
            return {};
        }
        from = predict(view.path, now, outlook(now));
    }
    if (!from || isBeforeBarrier(view, *from)) {
        return {};
    }
    return {Demand::Kind::PLAN, *from};
}

bool TimingPlan::change_to(PathStore &store, const Snapshot &now, const Commit &commit) noexcept {
    if (!commitments_.change_to(store, now, commit, settings_.latency)) {
        return false;
    }
    profile_.keep();
    return true;
}

void TimingPlan::plan(const PathView &view, PathStore &store, const Snapshot &now,
                      const LeaderState &from) noexcept {
    const Sequence begin = draft_.end;
    draft_.begin(from);
    if (start_delay_s_ > 0 && from.v <= 0) {
        draft_.wait(store, start_delay_s_);
    }
    const Sequence waited = draft_.end;
    append_accelerated(draft_, store, {view, profile_, oldest_phase_}, draft_.seconds + settings_.horizon_s);
    Commit commit;
    commit.switch_cycle = now.cycle + settings_.latency;
    commit.begin = begin;
    commit.end = draft_.end;
    if (draft_.end == waited || !change_to(store, now, commit)) {
        draft_.end = begin;
        return;
    }
    start_delay_s_ = 0;
}

void TimingPlan::extend(const PathView &view, PathStore &store, const Snapshot &now) noexcept {
    const Sequence end = draft_.end;
    append_accelerated(draft_, store, {view, profile_, oldest_phase_},
                       seconds_driven(now) + settings_.horizon_s);
    if (draft_.end != end) {
        commitments_.extend(store, now, draft_.end);
    }
}

bool TimingPlan::draft(const PathView &view, PathStore &store, Sequence begin,
                       const LeaderState &from) noexcept {
    const TimingView timing{view, profile_, oldest_phase_};
    draft_.end = begin;
    draft_.begin(from);
    draft_.looked_at = from.piece;
    if (start_delay_s_ > 0 && from.v <= 0) {
        draft_.wait(store, start_delay_s_);
    }
    const Sequence waited = draft_.end;
    append_to_horizon(draft_, store, timing, start_delay_s_ + settings_.horizon_s);
    const double until_s = draft_.seconds;
    const bool isEmpty = draft_.end == waited && from.v <= 0;
    if (isEmpty || !append_stop(draft_, store, timing) || draft_.isStopPassed(view.path, begin)) {
        return false;
    }
    draft_.seconds = until_s;
    return true;
}

bool TimingPlan::commit(PathStore &store, const Snapshot &now, Sequence begin) noexcept {
    Commit commit;
    commit.switch_cycle = now.cycle + settings_.latency;
    commit.begin = begin;
    commit.end = draft_.end;
    const bool isTold = change_to(store, now, commit);
    start_delay_s_ = isTold ? 0.0 : start_delay_s_;
    return isTold;
}

}  // namespace mw::trajectory
