// SPDX-License-Identifier: GPL-2.0-or-later
// Machine on or off, the mode of motion, and the stop that ends in off.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

struct Power {
    Mode mode = Mode::FREE;
    bool isEnabled = false;
    bool isStopping = false;    ///< category 1: everything brakes, off at standstill
    std::uint32_t enables = 0;  ///< counts how often it was switched on

    /// Accepts commands that move something.
    bool isReady() const noexcept { return isEnabled && !isStopping; }
};

/// Conditions for a change of the mode.
struct ModeConditions {
    bool isHoming = false, isMoving = false;
    bool needsHome = false;  ///< Cartesian modes need a known pose
    bool areAllHomed = false;
};
/// Modes change only at standstill; NONE when the change is possible, or not needed.
Reason check_mode(const Power &power, Mode mode, const ModeConditions &conditions) noexcept;

/// True when the stop begins with this call.
bool begin_stop(Power &power) noexcept;
void switch_on(Power &power) noexcept;
void switch_off(Power &power) noexcept;

}  // namespace mw::motion
