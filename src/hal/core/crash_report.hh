// SPDX-License-Identifier: GPL-2.0-or-later
// What a process that runs realtime functions says when one of them crashes.
#pragma once

#include <string>
#include <vector>

namespace mw::hal {

/// From now on a crash of this process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) is told on standard error
/// with the function, component and thread that it happened in, and noted in the instance for the processes
/// that are attached to it; then `leftovers` (paths) are removed and the signal takes its course. For the
/// whole process, once, from main() or what stands for it; a handler that is there already is called after.
void report_crashes(const std::string &program, const std::vector<std::string> &leftovers = {});

}  // namespace mw::hal
