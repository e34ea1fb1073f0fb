// SPDX-License-Identifier: GPL-2.0-or-later
// Order in which the kernel ends processes when memory is exhausted. It ends the process with the highest sum
// of its size (per mille of the computer's memory) and its oom_score_adj (-1000 to 1000, inherited). Screens
// are ended first, then programs of operators, then task and HAL programs, and the realtime process last.
#pragma once

#include <sys/types.h>

namespace mw {

constexpr int TASK_OOM_STEP = 100;     ///< task above the realtime process
constexpr int PROGRAM_OOM_STEP = 200;  ///< displays and user M codes above task
constexpr int SCREENS_OOM_STEP = 500;  ///< servers of screens above the process that starts them

/// Adds `step` to the OOM score of `process` (0: this process). Any user may do that for their own processes.
/// Returns false if the score was not changed.
bool raise_oom_score(int step, pid_t process = 0);

/// Sets the OOM score of this process to `wanted`, or to the lowest higher value that the kernel permits. A
/// value below the initial one of the session needs CAP_SYS_RESOURCE; the process then drops that capability
/// unless it runs as root. Returns the resulting value.
int lower_oom_score(int wanted);

}  // namespace mw
