// SPDX-License-Identifier: GPL-2.0-or-later
// The screen server of a machine: its routes with the facts of the INI file, the running machine and its HAL.
#pragma once

#include <functional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "clients/screen/path/path_readers.hh"
#include "clients/screen/routes/api.hh"
#include "clients/screen/server/server.hh"
#include "machine/config/loaded_config.hh"

namespace mw::screen {

struct MachineScreenOptions {
    std::string ini;       ///< whole path
    std::string instance;  ///< of HAL and of the mailbox
    std::string version;   ///< of the server
    std::string screen_folder;
    std::string programs;     ///< folder of halcmd and haltcl
    bool is_display = false;  ///< it runs [HAL]POSTGUI_HALFILE and _HALCMD
};

/// Data for the screens, except the paths of programs.
ApiSetup api_setup(const MachineScreenOptions &options, const machine::LoadedConfig &loaded,
                   diagnostics::Sink &sink);

/// Addresses that the tabs show in frames.
std::vector<std::string> frames_of(const MachineFacts &facts);

/// The routes of one machine, with the threads for their work. Ends them when it ends; the server must
/// outlive it.
class MachineScreen {
  public:
    MachineScreen(Server &server, const machine::LoadedConfig &loaded, ApiSetup setup);
    ~MachineScreen();
    MachineScreen(const MachineScreen &) = delete;
    MachineScreen &operator=(const MachineScreen &) = delete;

    /// Answers for a moment.
    void run();

  private:
    Server &server_;
    PathReaders readers_;
    Worker disk_, hal_;
    Api api_;
};

}  // namespace mw::screen
