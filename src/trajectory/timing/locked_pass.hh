// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that are locked to the angle of a spindle (threads): their limits, and how much of the acceleration
// is for what. The executor drives them. Formulas: docs/developer/planner.md.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/timing/speed_profile.hh"

namespace mw::trajectory {

/// Last known piece of the pass that begins with `first`.
Sequence pass_end(const PathView &view, Sequence first) noexcept;

/// The pass that begins with `first`, at the present speed of its spindle.
Pass make_pass(const PathView &view, Sequence first) noexcept;

/// Writes what the executor needs to know of each piece of the pass.
void fill_pass(PlannedPath &path, const PathLimits &limits, const Pass &pass) noexcept;

/// Speed that the pass from this move on needs at the present speed of its spindle, over what the machine and
/// the operator allow.
double pass_load(const PathView &view, Sequence move) noexcept;

}  // namespace mw::trajectory
