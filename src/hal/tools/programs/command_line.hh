// SPDX-License-Identifier: GPL-2.0-or-later
// halcmd and halrun: options, input and the realtime process around a session.
#pragma once

#include <memory>
#include <string>
#include <utility>
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
    std::vector<std::string> words;  ///< words after the options: files with -f (or halrun), else a command
    bool wants_help = false;         ///< -h
    bool interactive = false;        ///< halrun -I
    bool killing = false;            ///< halrun -U
    bool wants_tcl = false;          ///< halrun -T
};

/// Reads the options of both programs: single letters, which may share a dash.
Result<CommandLine> parse_command_line(const std::vector<std::string> &arguments);

/// The INI file of -i, used by a session.
class IniOption {
  public:
    /// No effect without a path.
    Result<> load(const std::string &path);
    const script::IniLookup *lookup() const { return lookup_.get(); }
    /// Null without a path.
    const ini::IniFile *file() const { return file_.get(); }

  private:
    diagnostics::Sink sink_;
    std::unique_ptr<ini::IniFile> file_;
    std::unique_ptr<script::IniFileLookup> lookup_;
};

/// Runs commands from standard input until its end or exit, with a prompt on a terminal. Returns the first
/// failure, except for typed commands.
Result<> run_standard_input(script::Session &session);

/// Runs the HAL files of an INI file in two passes; an error unless it has [HAL]TWOPASS.
Result<> run_two_pass_ini(script::Session &session, const ini::IniFile &ini);

/// A realtime process that was joined, or started because none was running. A process started here ends with
/// this object if its HAL is empty, else it continues.
class JoinedHost {
  public:
    JoinedHost(std::unique_ptr<HostClient> host, bool isStartedHere)
        : host_(std::move(host)), started_here_(isStartedHere) {}
    ~JoinedHost();
    JoinedHost(JoinedHost &&) = default;
    JoinedHost &operator=(JoinedHost &&) = delete;

    /// The realtime process continues, also with an empty HAL.
    void keep() noexcept { started_here_ = false; }
    HostClient &operator*() const noexcept { return *host_; }
    HostClient *operator->() const noexcept { return host_.get(); }

  private:
    std::unique_ptr<HostClient> host_;
    bool started_here_;
};

/// Joins the running realtime process, or starts one.
Result<JoinedHost> join_or_start();

/// `halcmd`: attached to the running instance. Returns the exit status.
int halcmd(const std::vector<std::string> &arguments);
/// `halcmd_twopass`: attached to the running instance, or starts one. Returns the exit status.
int halcmd_twopass(const std::vector<std::string> &arguments);
/// `haltcl`: a Tcl script or session, attached as halcmd is. Returns the exit status.
int haltcl(const std::vector<std::string> &arguments);
/// `realtime start|stop|restart|status`: a persistent realtime process. Returns the exit status; for `status`
/// 1 when none runs.
int realtime(const std::vector<std::string> &arguments);
/// `halrun -U`: ends the realtime process of the instance and its programs.
int end_running(const char *program);
/// `halrun`: runs commands with its own realtime process. Returns the exit status.
int halrun(const std::vector<std::string> &arguments);

}  // namespace mw::hal::tools
