// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the HAL files and commands that an INI names, in order.
#pragma once

#include <functional>

#include "hal/core/host.hh"
#include "hal/script/programs.hh"
#include "machine/assembly/machine.hh"

namespace mw::machine {

class HalSetup {
  public:
    /// `programs`: starts what loadusr names beside the parts of this process; null: nothing else is started.
    HalSetup(const MachineParts &parts, hal::Host &host, hal::script::ProgramHost *programs,
             const MachineOptions &options)
        : parts_(parts), host_(host), programs_(programs), options_(options) {}

    /// Makes the in-process part for `loadusr hal_manualtoolchange`.
    std::function<Result<>()> on_tool_change_program;

    /// The first failure ends it; its message has file, line and column of the HAL file. What was left out is
    /// told in one warning.
    Result<> run();

  private:
    const MachineParts &parts_;
    hal::Host &host_;
    hal::script::ProgramHost *programs_;
    const MachineOptions &options_;
};

}  // namespace mw::machine
