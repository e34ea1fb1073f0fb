// SPDX-License-Identifier: GPL-2.0-or-later
// Options and run of the program rs274.
#pragma once

#include <cstdio>
#include <string>

#include "base/result.hh"

namespace mw::gcode {

struct StandaloneOptions {
    enum class OnError { CONTINUE, MDI, STOP };
    std::string input, output;
    std::string tool_file, var_file, ini_file;
    std::string plugin;  ///< shared object of another interpreter
    OnError on_error = OnError::STOP;
    bool isBlockDelete = false;
    bool stack_shown = false;
    bool is_batch = false;
};

/// Runs the program; canon calls go to the output, errors to standard error. Returns the exit status.
int run_standalone(const StandaloneOptions &options);

}  // namespace mw::gcode
