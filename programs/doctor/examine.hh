// SPDX-License-Identifier: GPL-2.0-or-later
// All checks before the start of a machine.
#pragma once

#include <csignal>
#include <functional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "machine/config/loaded_config.hh"

namespace mw::doctor {

struct Scope {
    bool has_hal = true;     ///< run the HAL files under the virtual clock
    bool has_system = true;  ///< examine kernel, processors and rights
    double latency_s = 10;   ///< 0: not measured
    /// Examines the settings of the machine's display; empty: not examined.
    std::function<void(const machine::LoadedConfig &, diagnostics::Sink &)> display;
};

/// Reports findings to `sink`, which has errors if the machine would not start or not work.
void examine(const std::string &ini, const Scope &scope, volatile std::sig_atomic_t &stop,
             diagnostics::Sink &sink);

/// One line: "file:line:column: error: what (what to do)"; findings about the computer begin with "system".
std::string finding_line(const diagnostics::Diagnostic &finding);

}  // namespace mw::doctor
