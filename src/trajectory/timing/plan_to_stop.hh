// SPDX-License-Identifier: GPL-2.0-or-later
// Plans that reach to the horizon and then to a stop, for machines whose joints are not axes: each is tried
// out as a whole before the executor gets it.
#pragma once

#include "trajectory/timing/plan_draft.hh"

namespace mw::trajectory {

/// Appends phases until the plan lasts `until_s` or ends for now.
void append_to_horizon(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept;
/// From the end of the plan to a stop; false when the store is full.
bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept;

}  // namespace mw::trajectory
