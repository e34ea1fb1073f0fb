// SPDX-License-Identifier: GPL-2.0-or-later
// The summary at the end of a run.
#pragma once

#include <optional>
#include <string>

#include "machine/assembly/machine.hh"
#include "machine/certificate/path_monitor.hh"
#include "programs/run/run_session.hh"
#include "programs/run/start_check.hh"

namespace mw::programs {

struct Summary {
    const std::string &program;
    const machine::MachineConfig &machine;
    RunSessionFigures run;
    /// Nothing for a machine in another process.
    std::optional<machine::RunFigures> path{};
    std::string certificate{};  ///< table of the certificate; empty for a machine in another process
    std::optional<machine::RealtimeFigures> realtime{};
    bool was_realtime;
    const StartCheck &check;
};

/// Prints to standard output, one figure per line.
void print_summary(const Summary &summary);

}  // namespace mw::programs
