// SPDX-License-Identifier: GPL-2.0-or-later
// halcmd and halrun: options, input and the realtime process around a session.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/result.hh"
#include "hal/host/host_client.hh"
#include "hal/script/ini_file_lookup.hh"
#include "hal/script/session.hh"

namespace mw::hal::tools {

struct CommandLine {
    script::SessionOptions session;
    std::string ini_path;            ///< -i
    bool readsInput = false;         ///< -f: from a file, or standard input without a name
    std::vector<std::string> words;  ///< what follows the options: files with -f (or halrun), else a command
    bool wantsHelp = false;          ///< -h
    bool isInteractive = false;      ///< halrun -I
    bool isKilling = false;          ///< halrun -U
    bool wantsTcl = false;           ///< halrun -T
};

/// Reads the options of both programs; single letters, several behind one dash.
Result<CommandLine> parse_command_line(const std::vector<std::string> &arguments);

/// The INI file of -i while a session uses it.
class IniOption {
  public:
    /// Nothing to do without a path.
    Result<> load(const std::string &path);
    const script::IniLookup *lookup() const { return lookup_.get(); }
    /// Null without a path.
    const ini::IniFile *file() const { return file_.get(); }

  private:
    diagnostics::Sink sink_;
    std::unique_ptr<ini::IniFile> file_;
    std::unique_ptr<script::IniFileLookup> lookup_;
};

/// Reads commands from standard input until its end or exit, with a prompt on a terminal.
/// The first failure, unless it is a person who types.
Result<> run_standard_input(script::Session &session);

/// Runs the HAL files of an INI file in two passes; an error unless it has [HAL]TWOPASS.
Result<> run_two_pass_ini(script::Session &session, const ini::IniFile &ini);

/// Joins the running realtime process, or starts one, which then stays.
Result<std::unique_ptr<HostClient>> join_or_start();

/// `halcmd`: attached to the running instance. The exit status.
int halcmd(const std::vector<std::string> &arguments);
/// `halcmd_twopass`: attached to the running instance, or starting one. The exit status.
int halcmd_twopass(const std::vector<std::string> &arguments);
/// `haltcl`: a Tcl script or session, attached as halcmd is. The exit status.
int haltcl(const std::vector<std::string> &arguments);
/// `realtime start|stop|restart|status`: a realtime process that stays. The exit status; of `status` 1 when
/// none runs.
int realtime(const std::vector<std::string> &arguments);
/// Ends the realtime process of the instance and the programs on it, if there is one: `halrun -U`.
int end_running(const char *program);
/// `halrun`: with a realtime process of its own around the commands. The exit status.
int halrun(const std::vector<std::string> &arguments);

}  // namespace mw::hal::tools
