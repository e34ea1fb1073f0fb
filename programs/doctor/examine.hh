// SPDX-License-Identifier: GPL-2.0-or-later
// All that is looked at before a machine is started.
#pragma once

#include <csignal>
#include <functional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "machine/config/loaded_config.hh"

namespace mw::doctor {

struct Scope {
    bool hasHal = true;     ///< HAL files are carried out, under the virtual clock
    bool hasSystem = true;  ///< kernel, processors and rights
    double latency_s = 10;  ///< 0: not measured
    /// What the machine's display reads of the settings; empty: not examined.
    std::function<void(const machine::LoadedConfig &, diagnostics::Sink &)> display;
};

/// Tells findings to `sink`, which has errors when the machine would not start or not work.
void examine(const std::string &ini, const Scope &scope, volatile std::sig_atomic_t &stop,
             diagnostics::Sink &sink);

/// One line: "file:line:column: error: what (what to do)"; findings on the computer begin with "system".
std::string finding_line(const diagnostics::Diagnostic &finding);

}  // namespace mw::doctor
