// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits: the profile of a leader whose mean is commanded (docs/developer/planner.md).
// Between rising and falling the leader keeps its speed for as long as the mean takes, so that the
// acceleration never swings by more than the mean can spread.
#pragma once

#include "trajectory/timing/plan_draft.hh"

namespace mw::trajectory {

/// How a stop is made.
struct StopShape {
    bool isHard = false;  ///< with what curves leave for braking alone
    /// Also behind a rise that is still in the mean, which keeps to the jerk where both swings together do.
    bool isAtOnce = false;
    /// Part of the brake for as long as the mean takes, more only where what follows could not be kept: the
    /// mean may still hold a turn from which the whole brake swings too far.
    double first_share = 1;
    /// The same behind that: a stop that is over within the mean swings it by all it takes. More than 1: the
    /// trial alone knows what is left.
    double share = 1;
};

/// Appends phases until the plan lasts `until_s` or ends for now.
void append_smooth(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept;
/// From where the plan leads to a stop; false when there is no room for it.
bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view, const StopShape &shape) noexcept;

}  // namespace mw::trajectory
