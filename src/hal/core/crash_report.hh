// SPDX-License-Identifier: GPL-2.0-or-later
// The message of a process that runs realtime functions when one of them crashes.
#pragma once

#include <string>
#include <vector>

namespace mw::hal {

/// Reports a crash of this process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) on standard error with its
/// function, component and thread, and stores it in the instance for attached processes. Then it removes
/// `leftovers` (paths), and the signal ends the process. Call once per process, at its start; existing
/// handlers are called afterwards.
void report_crashes(const std::string &program, const std::vector<std::string> &leftovers = {});

/// Sets the activity of this thread that a crash report outside of HAL threads names; null: none. The text
/// must stay valid. [any thread, realtime-safe]
void set_activity(const char *activity) noexcept;

}  // namespace mw::hal
