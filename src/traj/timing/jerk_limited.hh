// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits: the profile of a leader whose mean is commanded (docs/motion/planner.md).
// Between rising and falling the leader keeps its speed for as long as the mean takes, so that the
// acceleration never swings by more than the mean can spread.
#pragma once

#include "traj/timing/plan_draft.hh"

namespace mw::traj {

/// Appends phases until the plan lasts `until_s` or ends for now.
void append_smooth(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept;
/// From where the plan leads to a stop; false when there is no room for it.
bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept;
/// The same with what curves leave for braking alone. `isAtOnce`: also behind a rise that is still in the
/// mean, which keeps to the jerk where both swings together do.
bool append_hard_stop(PlanDraft &draft, PathStore &store, const TimingView &view, bool isAtOnce) noexcept;

}  // namespace mw::traj
