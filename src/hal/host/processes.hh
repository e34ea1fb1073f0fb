// SPDX-License-Identifier: GPL-2.0-or-later
// Processes as the realtime process sees them.
#pragma once

#include <cstdint>

#include "hal/core/hal.hh"

namespace mw::hal {

/// Of the process that a pidfd names; 0: none.
std::int32_t pid_of(int fd);

/// Ends the components of processes that are gone, their outputs take their safe values; true when there were
/// any. Those of the controlling process, `spared_pid`, wait until the machine stands: a process with threads
/// counts as gone as soon as its first thread is, before its descriptor says so.
bool end_dead_components(Hal &hal, std::int32_t spared_pid);

}  // namespace mw::hal
