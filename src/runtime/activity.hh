// SPDX-License-Identifier: GPL-2.0-or-later
// Activity of a process.
#pragma once

#include "runtime/process.hh"

namespace mw::runtime {

enum class Activity : std::uint8_t {
    RUNNING,
    STOPPED,  ///< stopped by a signal (SIGSTOP, Ctrl-Z) or a debugger
    ENDED,    ///< ended, or a zombie
};
Activity activity_of(const ProcessId &process);

}  // namespace mw::runtime
