// SPDX-License-Identifier: GPL-2.0-or-later
// The program rs274: its options and its run.
#pragma once

#include <cstdio>
#include <string>

#include "base/result.hh"

namespace mw::gcode {

struct StandaloneOptions {
    enum class OnError { CONTINUE, MDI, STOP };
    std::string input, output;
    std::string tool_file, var_file, ini_file;
    std::string plugin;  ///< another interpreter, a shared object
    OnError on_error = OnError::STOP;
    bool isBlockDelete = false;
    bool isStackShown = false;
    bool isBatch = false;
};

/// Runs as the options say; canon calls go to the output, errors to standard error. Returns the exit status.
int run_standalone(const StandaloneOptions &options);

}  // namespace mw::gcode
