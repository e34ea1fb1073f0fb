// SPDX-License-Identifier: GPL-2.0-or-later
// HAL files in another language (Tcl). A shared part that is loaded on demand runs them, so that everything
// else works without it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::hal::script {

class Session;

/// An interpreter with the HAL commands of one session, which must outlive it. [the session's thread]
class ScriptRunner {
  public:
    virtual ~ScriptRunner() = default;
    /// Runs a script; an error has file and line if the interpreter reports them.
    virtual Result<> run_file(const std::string &path, const std::vector<std::string> &arguments) = 0;
    /// Runs commands from standard input until its end or `exit`, with a prompt on a terminal.
    virtual Result<> run_standard_input() = 0;
};

/// The Tcl interpreter of hal/tcl; an error when that part (or Tcl) is not installed.
Result<std::unique_ptr<ScriptRunner>> load_tcl(Session &session);

/// Symbol that the shared part exports; returns null when it was built with another `layout` of Session.
inline constexpr const char *NEW_SCRIPT_RUNNER = "mw_new_script_runner";
using NewScriptRunner = ScriptRunner *(*)(Session *session, std::size_t layout);
/// Differs when the program and the shared part were built from different sources.
std::size_t session_layout();

}  // namespace mw::hal::script
