// SPDX-License-Identifier: GPL-2.0-or-later
// Which corners are rounded, how wide and how fast, and which are stops. Pure.
#pragma once

#include "trajectory/path/stretch.hh"

namespace mw::trajectory {

/// From `a` into `b`, which follows it.
Corner corner_between(const Leg &a, const Leg &b, const Conditions &conditions) noexcept;

}  // namespace mw::trajectory
