// SPDX-License-Identifier: GPL-2.0-or-later
// What a run says at its end.
#pragma once

#include <optional>
#include <string>

#include "machine/analysis/path_monitor.hh"
#include "machine/assembly/machine.hh"
#include "programs/run/run_session.hh"
#include "programs/run/start_check.hh"

namespace mw::programs {

struct Summary {
    const std::string &program;
    const machine::MachineConfig &machine;
    RunSessionFigures run;
    /// None of a machine in another process.
    std::optional<machine::RunFigures> path{};
    std::optional<machine::RealtimeFigures> realtime{};
    bool wasRealtime;
    const StartCheck &check;
};

/// Prints to standard output, one figure a line.
void print_summary(const Summary &summary);

}  // namespace mw::programs
