// SPDX-License-Identifier: GPL-2.0-or-later
// Monitors the task process, through the kernel and by its loop count, and monitors the servo thread.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

/// Signs of life of the task process.
struct TaskSigns {
    std::uint64_t loops = 0;  ///< of task
    /// Count of the realtime host, every 50 ms, in a thread with the priority of task. 0: it does not count.
    std::uint64_t looks = 0;
    bool isDead = false;
};

/// A task that does not loop hangs, is stopped, or gets no processor time. In the last case other threads of
/// its priority also get none: that time counts a quarter.
class Watchdog {
  public:
    CommandResult take(const SetWatchdog &command) noexcept;
    CommandResult take(const Heartbeat &command) noexcept;

    /// One cycle; true in the cycle that detects the loss of task.
    bool step(const TaskSigns &signs, double period_s) noexcept;
    /// One cycle of the servo thread: time since the last one [s] if it is far too long; otherwise 0.
    double gap_s(std::int64_t time_ns) noexcept;

    bool isTaskLost() const noexcept { return lost_; }
    /// Time since the last sign of life from task [s].
    double silent_s() const noexcept { return silent_s_ + starved_s_; }

  private:
    bool on_ = false, lost_ = false;
    double timeout_s_ = 0.5;
    double silent_s_ = 0;   ///< since the count changed or a Heartbeat arrived, while the host counted
    double starved_s_ = 0;  ///< while the host did not count
    double unseen_s_ = 0;   ///< since the host last counted
    TaskSigns last_;
    std::int64_t last_step_ns_ = 0;
};

}  // namespace mw::motion
