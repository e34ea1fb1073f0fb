// SPDX-License-Identifier: GPL-2.0-or-later
// What a run says at its end.
#pragma once

#include <optional>
#include <string>

#include "app/operator.hh"
#include "app/start_check.hh"
#include "machine/machine.hh"
#include "machine/path_monitor.hh"

namespace mw::app {

struct Summary {
    const std::string &program;
    const machine::MachineConfig &machine;
    OperatorFigures run;
    /// None of a machine in another process.
    std::optional<machine::RunFigures> path{};
    std::optional<machine::RealtimeFigures> realtime{};
    bool wasRealtime;
    const StartCheck &check;
};

/// Prints to standard output, one figure a line.
void print_summary(const Summary &summary);

}  // namespace mw::app
