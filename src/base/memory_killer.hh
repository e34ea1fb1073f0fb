// SPDX-License-Identifier: GPL-2.0-or-later
// Which process the kernel ends first when memory is gone: that with the highest sum of its size (per mille
// of the computer's memory) and its oom_score_adj (-1000 to 1000, inherited). Each process of a machine has a
// place in this order: the realtime process last, then task and HAL programs, then programs of operators,
// screens first.
#pragma once

#include <sys/types.h>

namespace mw {

constexpr int TASK_OOM_STEP = 100;     ///< task above the realtime process
constexpr int PROGRAM_OOM_STEP = 200;  ///< displays and user M codes above task
constexpr int SCREENS_OOM_STEP = 500;  ///< servers of screens above what starts them

/// Adds `step` to the value of `process` (0: this one). Everyone may for his own processes. False: unchanged.
bool raise_oom_score(int step, pid_t process = 0);

/// Sets the value of this process to `wanted`, or to the lowest above it that the kernel permits: below the
/// value that its session began with only with CAP_SYS_RESOURCE, which this process then gives up unless it
/// is root's. Returns the value that holds then.
int lower_oom_score(int wanted);

}  // namespace mw
