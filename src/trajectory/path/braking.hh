// SPDX-License-Identifier: GPL-2.0-or-later
// How hard a stop may brake on a curve. Planning side, pure.
#pragma once

#include "trajectory/path/conditions.hh"

namespace mw::trajectory {

/// The braking of a curved piece that is driven at most at `limit.v`. Where turning and braking pull a
/// coordinate the same way they share its acceleration, as limit.a says for all; where they pull against each
/// other each may take all of it. Without a gain it is limit.a everywhere. Formulas:
/// docs/developer/planner.md
/// ("Stops on curves").
Braking braking_on(const PathStore &store, const Piece &piece, const Conditions &conditions,
                   const SpeedLimit &limit) noexcept;

/// For Braking::Part: the largest float that is not above `x`.
float lesser_float(double x) noexcept;

}  // namespace mw::trajectory
