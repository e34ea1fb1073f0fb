// SPDX-License-Identifier: GPL-2.0-or-later
// Looks at a program before the machine starts: what is known to stop it in the middle of a cut refuses it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "machine/analysis/program_check.hh"

namespace mw::programs {

struct StartCheckOptions {
    double most_seconds = 5.0;  ///< of real time
    std::uint64_t most_blocks = 10000000;
    bool wantsTime =
        true;  ///< reckon the time that the planner expects, where that leaves enough for reading on
    bool isBlockDeleteOn = true;
    machine::PathPoints *points = nullptr;  ///< gets the path
};

struct StartCheck {
    bool isRefused = false;  ///< the sink has the errors
    bool isWhole = false;    ///< false: a limit or a signal has ended the look ahead
    std::uint64_t blocks = 0;
    std::optional<machine::TimeFigures> time;
};

/// Interprets the program for the machine as it stands after homing; runs no Python and no user M codes. An
/// error refuses the program; errors behind a place where its way depends on what only the running machine
/// knows (probes, inputs, HAL values, Python) are warnings, and that place is said.
StartCheck check_before_start(const machine::MachineConfig &machine, const std::string &program,
                              gcode::ToolSource &tools, gcode::ParameterSource &values,
                              diagnostics::Sink &sink, const StartCheckOptions &options = {});

}  // namespace mw::programs
