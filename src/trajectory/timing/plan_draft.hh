// SPDX-License-Identifier: GPL-2.0-or-later
// A plan in the making: phases in the store's ring, and the state that they lead to.
#pragma once

#include "trajectory/path/speed_choice.hh"
#include "trajectory/timing/speed_profile.hh"

namespace mw::trajectory {

/// Inputs for making phases; not stored.
struct TimingView {
    const PathView &on;
    const SpeedProfile &profile;
    Sequence oldest_phase = 1;  ///< earlier ones are free

    const PlannedPath &path() const noexcept { return on.path; }
};

struct PlanDraft {
    LeaderState at;          ///< where the plan leads
    double seconds = 0;      ///< when, from its beginning on
    Sequence end = 1;        ///< number of the next phase
    Sequence looked_at = 0;  ///< the farthest piece that the plan depends on
    Overreach overreach;     ///< of the speed chooser: the plan ends there
    Sequence reached = 0;    ///< the piece with whose end it ends, if that was the path's last, otherwise 0

    /// Another plan from this state on.
    void begin(const LeaderState &from) noexcept {
        at = from;
        seconds = 0;
    }
    /// The plan runs to the end of the known path.
    bool isAtEndOf(const PlannedPath &path) const noexcept {
        return reached != 0 && reached == path.last_piece();
    }
    bool hasRoom(Sequence oldest_phase, Sequence phases) const noexcept {
        return end + phases - oldest_phase < PHASE_CAPACITY;
    }
    /// Phases of the speed chooser for the rest of the current piece; returns how many are in `out`. None
    /// where they exceed a limit, which is stored.
    int choose(const TimingView &view, double cap, double out2, std::span<ChosenPhase> out) noexcept;
    /// Appends a phase over `length` that ends at the speed `v1`.
    void append(PathStore &store, double length, double v1) noexcept;
    /// Appends a dwell.
    void wait(PathStore &store, double duration) noexcept;
    /// True if it passes, after phase `begin`, a point where it has to stop: reduced accelerations left no
    /// stop from the end of the plan before.
    bool isStopPassed(const PlannedPath &path, Sequence begin) const noexcept;
    /// On to the next piece, whose start is the end of this one.
    void enter_next_piece() noexcept { at = {at.piece + 1, 0, at.v}; }
};

}  // namespace mw::trajectory
