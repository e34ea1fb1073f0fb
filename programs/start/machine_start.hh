// SPDX-License-Identifier: GPL-2.0-or-later
// A running machine with its display and additional programs, from the start to the end of all of them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/config/loaded_config.hh"
#include "programs/run/machine_access.hh"
#include "programs/start/display_program.hh"
#include "programs/start/program_certifier.hh"
#include "programs/start/side_programs.hh"

namespace mw::programs {

struct StartSettings {
    std::string ini;
    bool displayed = true;
    std::vector<std::string> display_words;  ///< additional arguments for the display
    machine::MachineOptions options;
};

/// All calls come from one thread. Everything that it has started has ended when run() returns.
class MachineStart {
  public:
    MachineStart(StartSettings settings, machine::LoadedConfig &loaded, diagnostics::Sink &sink);

    /// Returns the exit status: that of the display, 0 after a signal, 1 after a rejection or failure.
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
    void tell_certificates();

    StartSettings settings_;
    machine::LoadedConfig &loaded_;
    diagnostics::Sink &sink_;
    std::string instance_;
    std::vector<std::string> display_words_;
    std::unique_ptr<machine::Machine> machine_;
    std::optional<OwnMachine> access_;
    std::optional<ProgramCertifier> certifier_;
    std::optional<DisplayProgram> display_;
    std::optional<SidePrograms> side_programs_;
    std::optional<int> display_status_;
    bool loss_reported_ = false;  ///< lost output has been reported
};

}  // namespace mw::programs
