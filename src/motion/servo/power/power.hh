// SPDX-License-Identifier: GPL-2.0-or-later
// Machine on or off, the mode of motion, and the stop that ends with off.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

/// Conditions for a change of the mode.
struct ModeConditions {
    bool isHoming = false, isMoving = false;
    bool needsHome = false;  ///< Cartesian modes need a known pose
    bool areAllHomed = false;
};

/// A stop of category 1 is active only while the machine is on.
class Power {
  public:
    Mode mode() const noexcept { return mode_; }
    bool isEnabled() const noexcept { return enabled_; }
    /// Category 1: everything brakes, off at standstill.
    bool isStopping() const noexcept { return stopping_; }
    /// True if commands that move something are accepted.
    bool isReady() const noexcept { return enabled_ && !stopping_; }
    /// Counts how often the machine was switched on.
    std::uint32_t enables() const noexcept { return enables_; }

    /// Modes change only at standstill. NONE if the change is possible, or not needed.
    Reason check_mode(Mode mode, const ModeConditions &conditions) const noexcept;
    void set_mode(Mode mode) noexcept { mode_ = mode; }
    /// True if the stop starts with this call.
    bool begin_stop() noexcept;
    void switch_on() noexcept;
    void switch_off() noexcept;

  private:
    Mode mode_ = Mode::FREE;
    bool enabled_ = false;
    bool stopping_ = false;
    std::uint32_t enables_ = 0;
};

}  // namespace mw::motion
