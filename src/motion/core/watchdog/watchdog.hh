// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the task process is alive: the kernel's word, and its count of loops.
#pragma once

#include <cstdint>

#include "motion/api/command.hh"
#include "motion/core/verdict.hh"

namespace mw::motion {

struct Watchdog {
    bool isOn = false, isLost = false;
    double timeout_s = 0.5;
    double standing_s = 0;  ///< since the count has moved or a Heartbeat came
    std::uint64_t loops = 0;
};

Verdict take(Watchdog &watchdog, const SetWatchdog &command) noexcept;
Verdict take(Watchdog &watchdog, const Heartbeat &command) noexcept;

/// One cycle; true in the one in which the task process is found lost.
bool step(Watchdog &watchdog, std::uint64_t loops, bool isDead, double period_s) noexcept;

}  // namespace mw::motion
