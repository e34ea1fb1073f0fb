// SPDX-License-Identifier: GPL-2.0-or-later
// Checks whether the task process is alive, by the kernel and by its count of loops, and whether the servo
// thread ran.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

/// Signs of life of the task process.
struct TaskSigns {
    std::uint64_t loops = 0;  ///< of task
    /// Count of the host of the realtime process, every 50 ms: a thread with the priority of task. 0: it does
    /// not count.
    std::uint64_t looks = 0;
    bool isDead = false;
};

/// A task that does not loop hangs, is stopped, or gets no processor. In the last case other threads of its
/// priority get none either: that time counts a quarter.
class Watchdog {
  public:
    CommandResult take(const SetWatchdog &command) noexcept;
    CommandResult take(const Heartbeat &command) noexcept;

    /// One cycle; true in the cycle in which the task process is found lost.
    bool step(const TaskSigns &signs, double period_s) noexcept;
    /// One cycle of the servo thread itself: time since the last one [s] if it is far too long; else 0.
    double gap_s(std::int64_t time_ns) noexcept;

    bool isTaskLost() const noexcept { return lost_; }
    /// Since task gave a sign of life [s].
    double silent_s() const noexcept { return silent_s_ + starved_s_; }

  private:
    bool on_ = false, lost_ = false;
    double timeout_s_ = 0.5;
    double silent_s_ = 0;   ///< since the count changed or a Heartbeat came, while the host counted
    double starved_s_ = 0;  ///< while the host did not count
    double unseen_s_ = 0;   ///< since the host has counted
    TaskSigns last_;
    std::int64_t last_step_ns_ = 0;
};

}  // namespace mw::motion
