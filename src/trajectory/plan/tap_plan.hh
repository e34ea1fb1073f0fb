// SPDX-License-Identifier: GPL-2.0-or-later
// Checks a rigid tap before it begins: whether the machine can follow the spindle through its reversals, and
// calculates its limits. Formulas: docs/integrator/spindles.md.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/path/conditions.hh"

namespace mw::trajectory {

/// Reason why a tap is not possible at the current spindle speed.
enum class TapObstacle : std::uint8_t {
    NONE,
    TOO_FAST,     ///< value: needed speed divided by the maximum of the machine or the operator
    TOO_ABRUPT,   ///< value: acceleration of the reversing spindle divided by the maximum of the tool
    TOO_SUDDEN,   ///< value: deviation of the tool from the helix while the spindle reverses [rev]
    TOO_SHALLOW,  ///< value: depth for acceleration and reversal divided by the depth of the tap
};
struct TapVerdict {
    TapObstacle obstacle = TapObstacle::NONE;
    double value = 0;
};

}  // namespace mw::trajectory

namespace mw::trajectory::plan {

/// The cut of a tap.
struct TapRequest {
    const Primitive &line;
    const MoveRequest &request;
    const Conditions &conditions;

    double rps() const noexcept { return conditions.scales.spindle_rps[spindle()]; }
    const SpindleBrakings &brakings() const noexcept { return conditions.brakings[spindle()]; }
    double encoder_step() const noexcept { return conditions.encoder_steps[spindle()]; }
    std::size_t spindle() const noexcept { return static_cast<std::size_t>(request.spindle); }
};

/// Data of a tap for the executor, at the current spindle speed.
TapTerms tap_terms(const TapRequest &tap) noexcept;

TapVerdict check_tap(const TapRequest &tap) noexcept;

}  // namespace mw::trajectory::plan
