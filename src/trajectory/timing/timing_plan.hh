// SPDX-License-Identifier: GPL-2.0-or-later
// When the path is where: the profile, the plan in the making, and what of it the executor has been told.
#pragma once

#include "trajectory/timing/commitments.hh"
#include "trajectory/timing/plan_draft.hh"
#include "trajectory/timing/plan_to_stop.hh"

namespace mw::trajectory {

struct PlannerSettings {
    double period_s = 1e-3;           ///< of the servo
    std::uint64_t latency = 3;        ///< cycles from a plan's making to its start
    double horizon_s = 0.1;           ///< how far ahead phases are committed
    bool isMerging = true;            ///< nearly straight lines become one
    SpeedChooser *chooser = nullptr;  ///< chooses speeds instead of the fastest; stays valid
};

/// What an update has to do.
struct Demand {
    enum class Kind : std::uint8_t {
        NOTHING,
        EXTEND,  ///< the current plan continues
        PLAN,    ///< another one from `from` on
    };
    Kind kind = Kind::NOTHING;
    LeaderState from;
};

class TimingPlan {
  public:
    explicit TimingPlan(const PlannerSettings &settings) noexcept : settings_(settings) {}

    void begin(const Snapshot &now) noexcept;
    /// The next plan that begins at standstill begins with a dwell.
    void delay_start(double delay_s) noexcept { start_delay_s_ = delay_s; }
    /// The executor is at `now`; there may be more pieces.
    void look(const PathView &view, const Snapshot &now) noexcept;

    /// Overrides have changed by too little to count. `isFollowed`: the speed of a spindle matters.
    bool isSteady(const Scales &before, const Scales &after, bool isFollowed) noexcept;
    /// Gates or single blocks have changed; speeds at all pieces' starts may.
    void renew_all(const PathView &view) noexcept;
    /// Overrides have changed, so speeds within pieces have as well.
    void rescale(const PathView &view) noexcept;
    /// The limits of the pieces [low, high] have changed.
    void renew_span(const PathView &view, Sequence low, Sequence high) noexcept;
    /// What follows can still be kept from this state.
    bool isKept(const PathView &view, const LeaderState &from) const noexcept {
        return profile_.isKept(view.path, from);
    }

    /// What is due where plans are committed as they are made: with limits of acceleration.
    Demand demand(const PathView &view, const Snapshot &now) noexcept;
    /// What is due where each plan ends in a stop and is tried out.
    Demand tried_demand(const PathView &view, const Snapshot &now) const noexcept;

    void extend(const PathView &view, PathStore &store, const Snapshot &now) noexcept;
    void plan(const PathView &view, PathStore &store, const Snapshot &now, const LeaderState &from) noexcept;

    /// Number of the next phase.
    Sequence phases_end() const noexcept { return draft_.end; }
    Outlook outlook(const Snapshot &now) const noexcept {
        return {commitments_.phases_end(now), settings_.latency, settings_.period_s};
    }
    /// Makes a plan to be tried, with phases from `begin` on; false when there is none.
    bool draft(const PathView &view, PathStore &store, Sequence begin, const LeaderState &from) noexcept;
    /// Passes it to the executor; false when the store is full.
    bool commit(PathStore &store, const Snapshot &now, Sequence begin) noexcept;
    /// Phases from `begin` on are free again.
    void discard(Sequence begin) noexcept { draft_.end = begin; }

    /// The limit that the speed chooser exceeded. The path stops there.
    const Overreach &overreach() const noexcept { return draft_.overreach; }
    /// The plan runs to the end of the known path.
    bool isAtEndOf(const PlannedPath &path) const noexcept { return draft_.isAtEndOf(path); }

  private:
    double seconds_driven(const Snapshot &now) const noexcept {
        return commitments_.cycles_since_change(now) * settings_.period_s;
    }
    bool change_to(PathStore &store, const Snapshot &now, const Commit &commit) noexcept;

    PlannerSettings settings_;
    SpeedProfile profile_;
    PlanDraft draft_;
    Commitments commitments_;
    Sequence oldest_phase_ = 1;
    double start_delay_s_ = 0;
    int steady_updates_ = 0;  ///< since spindles have changed their speeds by more than a little
};

}  // namespace mw::trajectory
