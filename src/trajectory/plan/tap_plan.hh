// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid taps before they begin: whether the machine can follow the spindle through its reversals, and with
// what. Formulas: docs/integrator/spindles.md.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/path/conditions.hh"

namespace mw::trajectory {

/// Why a tap cannot be made at the present speed of its spindle.
enum class TapObstacle : std::uint8_t {
    NONE,
    TOO_FAST,     ///< value: the speed that is needed over what the machine, or the operator, allows
    TOO_ABRUPT,   ///< value: the acceleration with which the spindle turns back over what the machine allows
    TOO_SUDDEN,   ///< value: deviation of the tool from the helix while the spindle reverses [revolutions]
    TOO_SHALLOW,  ///< value: the depth that gaining speed and turning back take over what there is
};
struct TapVerdict {
    TapObstacle obstacle = TapObstacle::NONE;
    double value = 0;
};

}  // namespace mw::trajectory

namespace mw::trajectory::plan {

/// The way in of a tap.
struct TapRequest {
    const Primitive &line;
    const MoveRequest &request;
    const Conditions &conditions;

    double rps() const noexcept { return conditions.scales.spindle_rps[spindle()]; }
    const SpindleBrakings &brakings() const noexcept { return conditions.brakings[spindle()]; }
    double encoder_step() const noexcept { return conditions.encoder_steps[spindle()]; }
    std::size_t spindle() const noexcept { return static_cast<std::size_t>(request.spindle); }
};

/// What the executor needs to know of a tap, with its spindle at its present speed.
TapTerms tap_terms(const TapRequest &tap) noexcept;

TapVerdict check_tap(const TapRequest &tap) noexcept;

}  // namespace mw::trajectory::plan
