// SPDX-License-Identifier: GPL-2.0-or-later
// Checks a program before the machine starts. An error that would stop the program during a cut rejects it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "gcode/analysis/program_check.hh"
#include "machine/config/machine_config.hh"

namespace mw::programs {

struct StartCheckOptions {
    double most_seconds = 5.0;  ///< limit of real time
    std::uint64_t most_blocks = 10000000;
    bool wants_time = true;  ///< calculate the planner's time, if enough time for reading remains
    bool block_delete_on = true;
    gcode::PathPoints *points = nullptr;  ///< receives the path
};

struct StartCheck {
    bool isRefused = false;  ///< the errors are in the sink
    bool whole = false;      ///< false: a limit or a signal has ended the check
    std::uint64_t blocks = 0;
    std::optional<gcode::TimeFigures> time;
};

/// Interprets the program for the machine after homing, without Python and user M codes. An error rejects the
/// program; errors after a position from which it depends on values known only to the running machine
/// (probes, inputs, HAL values, Python) are warnings, and this position is reported.
StartCheck check_before_start(const machine::MachineConfig &machine, const std::string &program,
                              gcode::ToolSource &tools, gcode::ParameterSource &values,
                              diagnostics::Sink &sink, const StartCheckOptions &options = {});

}  // namespace mw::programs
