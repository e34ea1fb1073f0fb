// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the HAL files and commands of an INI file, in order.
#pragma once

#include <functional>

#include "base/diagnostics/sink.hh"
#include "hal/core/host.hh"
#include "hal/script/programs.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

class HalSetup {
  public:
    /// `programs` starts programs of loadusr that are not parts of this process; null: none are started.
    HalSetup(const MachineParts &parts, hal::Host &host, hal::script::ProgramHost *programs,
             const MachineOptions &options)
        : parts_(parts), host_(host), programs_(programs), options_(options) {}

    /// Creates the in-process part for `loadusr hal_manualtoolchange`.
    std::function<Result<>()> on_tool_change_program;

    /// Ends at the first failure, with file, line and column of the HAL file in the message. One warning
    /// names omitted programs.
    Result<> run();

  private:
    const MachineParts &parts_;
    hal::Host &host_;
    hal::script::ProgramHost *programs_;
    const MachineOptions &options_;
};

}  // namespace mw::machine
