// SPDX-License-Identifier: GPL-2.0-or-later
// Second stage of a servo cycle: checks the drives, the limits and the task process, and decides which stop
// category a fault needs.
#pragma once

#include <cstdint>

#include "motion/servo/parts.hh"
#include "motion/servo/watchdog/watchdog.hh"

namespace mw::motion {

class SafetyMonitor {
  public:
    CommandResult take(const SetWatchdog &command) noexcept { return watchdog_.take(command); }
    CommandResult take(const Heartbeat &command) noexcept { return watchdog_.take(command); }
    bool isTaskLost() const noexcept { return watchdog_.isTaskLost(); }

    /// Called after the feedback of the cycle. `spindles_lost`: bit per spindle whose feedback is not a
    /// number.
    [[gnu::hot]] void step(ControllerParts &parts, const Inputs &in, std::uint32_t spindles_lost) noexcept;

  private:
    void check_positions(ControllerParts &parts, std::uint32_t lost_positions) noexcept;
    void check_task(ControllerParts &parts) noexcept;
    void check_servo_thread(ControllerParts &parts, std::int64_t time_ns) noexcept;

    Watchdog watchdog_;
};

/// Switches the machine off when a stop of category 1 has reached standstill.
[[gnu::hot]] void finish_stop(ControllerParts &parts) noexcept;

}  // namespace mw::motion
