// SPDX-License-Identifier: GPL-2.0-or-later
// Which threads of this process run before those of other programs.
#pragma once

namespace mw {

/// The thread runs before those of ordinary programs, where this process may do that: by SCHED_RR of the
/// lowest priority, far below the servo thread, else by a nice value. What it starts is ordinary again.
/// @param thread_id as gettid() gives it; 0 is the calling thread
void raise_priority(int thread_id = 0) noexcept;
/// The thread is ordinary again.
void reset_priority(int thread_id = 0) noexcept;
/// The thread runs behind ordinary ones. Everybody may do that.
void lower_priority(int thread_id = 0) noexcept;

}  // namespace mw
