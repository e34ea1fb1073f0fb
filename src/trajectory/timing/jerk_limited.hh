// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits: the profile of a reference whose moving average is commanded (docs/developer/planner.md).
// Between acceleration and deceleration the reference keeps its speed for the averaging time, so that the
// acceleration step never exceeds what the average can spread.
#pragma once

#include "trajectory/timing/plan_draft.hh"

namespace mw::trajectory {

/// How a stop is made.
struct StopShape {
    bool isHard = false;  ///< with what curves leave for braking alone
    /// Also right after an acceleration within the averaging time, if the jerk limit allows both steps
    /// together.
    bool isAtOnce = false;
    /// Part of the deceleration for the averaging time; more only if the later pieces need it. The average
    /// may still contain a curve for which the whole deceleration is too large a step.
    double first_share = 1;
    /// The same after that: a stop shorter than the averaging time has its whole deceleration as a step. More
    /// than 1: only the trial knows what is left.
    double share = 1;
};

/// Appends phases until the plan lasts `until_s` or ends for now.
void append_smooth(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept;
/// From the end of the plan to a stop; false when the store is full.
bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view, const StopShape &shape) noexcept;

}  // namespace mw::trajectory
