// SPDX-License-Identifier: GPL-2.0-or-later
// What a run says at its end.
#pragma once

#include <string>

#include "machine/machine.hh"
#include "machine/operator.hh"
#include "machine/path_monitor.hh"

namespace mw::machine {

struct Summary {
    const std::string &program;
    const MachineConfig &machine;
    OperatorFigures run;
    RunFigures path;
    RealtimeFigures realtime;
    bool wasRealtime;
};

/// Prints to standard output, one figure a line.
void print_summary(const Summary &summary);

}  // namespace mw::machine
