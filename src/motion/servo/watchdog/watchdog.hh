// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the task process is alive: the kernel's word, and its count of loops. And whether the servo thread
// ran.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

/// What there is to see of the task process.
struct TaskSigns {
    std::uint64_t loops = 0;  ///< of task
    /// Of the host of the realtime process, every 50 ms: a thread of the priority of task. 0: it does not
    /// look.
    std::uint64_t looks = 0;
    bool isDead = false;
};

/// Task that does not loop hangs, is stopped, or gets no processor. In the last case other threads of its
/// priority do not get one either: that time counts a quarter.
struct Watchdog {
    bool isOn = false, isLost = false;
    double timeout_s = 0.5;
    double standing_s = 0;  ///< since the count has moved or a Heartbeat came, while the host looked
    double starved_s = 0;   ///< while it did not
    double unseen_s = 0;    ///< since the host has looked
    TaskSigns last;
    std::int64_t last_step_ns = 0;
};

CommandResult take(Watchdog &watchdog, const SetWatchdog &command) noexcept;
CommandResult take(Watchdog &watchdog, const Heartbeat &command) noexcept;

/// One cycle; true in the one in which the task process is found lost.
bool step(Watchdog &watchdog, const TaskSigns &signs, double period_s) noexcept;

/// One cycle of the servo thread itself: [s] since the last one, when that is far too long; else 0.
double gap_s(Watchdog &watchdog, std::int64_t time_ns) noexcept;

}  // namespace mw::motion
