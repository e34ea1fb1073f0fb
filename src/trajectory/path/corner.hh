// SPDX-License-Identifier: GPL-2.0-or-later
// Which corners are rounded, how wide and how fast, and which are stops. Pure.
#pragma once

#include "trajectory/path/stretch.hh"

namespace mw::trajectory {

/// From `a` into `b`, which follows it.
Corner corner_between(const Leg &a, const Leg &b, const Conditions &conditions) noexcept;

/// Maximum speed through a corner with jerk limits whose deviation per change of the tangent may be `share`:
/// the moving average over v tau deviates by v tau / 8 and a blend of d = need v^2, at most `most_d`, within
/// it by d^2 / (6 v tau) more.
double speed_through(double share, double need, double most_d, double tau) noexcept;

}  // namespace mw::trajectory
