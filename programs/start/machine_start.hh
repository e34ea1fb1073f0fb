// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that is kept up with its display and the programs beside it, from the start to the end of all.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/config/loaded_config.hh"
#include "programs/run/machine_access.hh"
#include "programs/start/display_program.hh"
#include "programs/start/side_programs.hh"

namespace mw::programs {

struct StartSettings {
    std::string ini;
    bool isDisplayed = true;
    std::vector<std::string> display_words;  ///< more words for the display
    machine::MachineOptions options;
};

/// One thread. Whatever it has started is gone when run() returns.
class MachineStart {
  public:
    MachineStart(StartSettings settings, machine::LoadedConfig &loaded, diagnostics::Sink &sink);

    /// The exit status: that of the display, 0 after a signal, 1 when something was refused or has failed.
    int run();

  private:
    int run_machine();
    Result<> prepare();
    Result<> make();
    void make_parameter_file();
    void check_places();
    Result<> keep_up();
    Result<> cycle();
    Result<> take_down();
    void end_programs();
    void run_shutdown_file();
    void tell_messages();

    StartSettings settings_;
    machine::LoadedConfig &loaded_;
    diagnostics::Sink &sink_;
    std::string instance_;
    std::vector<std::string> display_words_;
    std::unique_ptr<machine::Machine> machine_;
    std::optional<OwnMachine> access_;
    std::optional<DisplayProgram> display_;
    std::optional<SidePrograms> side_programs_;
    std::optional<int> display_status_;
    bool isLossTold_ = false;  ///< that the output of this program is lost: once
};

}  // namespace mw::programs
