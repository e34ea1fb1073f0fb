// SPDX-License-Identifier: GPL-2.0-or-later
// Priority of threads of this process relative to other programs.
#pragma once

namespace mw {

/// Raises the thread above those of ordinary programs, if this process may: by SCHED_RR with the lowest
/// priority, far below the servo thread, else by a nice value. Threads started by this thread have normal
/// priority.
/// @param thread_id as gettid() returns it; 0 is the calling thread
void raise_priority(int thread_id = 0) noexcept;
/// Sets normal priority.
void reset_priority(int thread_id = 0) noexcept;
/// Lowers the thread below normal priority. Needs no privilege.
void lower_priority(int thread_id = 0) noexcept;

}  // namespace mw
