// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid taps before they begin: whether the machine can follow the spindle through its reversals, and with
// what. Formulas: docs/integrator/spindles.md.
#pragma once

#include <cstdint>

#include "trajectory/timing/speed_profile.hh"

namespace mw::trajectory {

/// Part of the acceleration that a tap or a short pass may use: with jerk limits one change of it may come
/// within the averaging time of another.
double tap_share(const PathLimits &limits) noexcept;

/// Data for the executor of the tap whose first piece is `first`, with its spindle at `rps`.
TapTerms tap_terms(const PathView &view, Sequence first, double rps) noexcept;

/// Why a tap that begins with `move` cannot be made at the present speed of its spindle.
enum class TapObstacle : std::uint8_t {
    NONE,
    TOO_FAST,     ///< value: the speed that is needed over what the machine, or the operator, allows
    TOO_ABRUPT,   ///< value: the acceleration with which the spindle turns back over what the machine allows
    TOO_SUDDEN,   ///< value: deviation of the average from the helix while the spindle reverses [revolutions]
    TOO_SHALLOW,  ///< value: the depth that gaining speed and turning back take over what there is
};
struct TapVerdict {
    TapObstacle obstacle = TapObstacle::NONE;
    double value = 0;
};
TapVerdict check_tap(const PathView &view, Sequence move) noexcept;

}  // namespace mw::trajectory
