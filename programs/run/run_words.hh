// SPDX-License-Identifier: GPL-2.0-or-later
// The words of `millwright run`.
#pragma once

#include <string>
#include <vector>

#include "programs/run/run_session.hh"

namespace mw::programs {

struct RunWords {
    std::string ini, program, trace, plot, certificate, homing_module, planner_module;
    bool realtime = false, strict = false, estimated = true, checked = true, confirmed = false;
    ProgramSwitches switches;
    double patience_s = 60.0;
    int from_line = 0;  ///< 0: the first
};

/// Text of --help.
std::string run_help();
Result<RunWords> parse_run(const std::vector<std::string> &words);

}  // namespace mw::programs
