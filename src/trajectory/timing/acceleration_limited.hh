// SPDX-License-Identifier: GPL-2.0-or-later
// The fastest profile within limits of speed and acceleration.
#pragma once

#include "trajectory/timing/plan_draft.hh"

namespace mw::trajectory {

/// Appends phases until the plan lasts `until_s` or ends for now.
void append_accelerated(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept;

}  // namespace mw::trajectory
