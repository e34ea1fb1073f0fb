// SPDX-License-Identifier: GPL-2.0-or-later
// HAL commands in a Tcl interpreter. [one thread]
#pragma once

#include <tcl.h>

#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/script/script.hh"
#include "hal/script/session.hh"

namespace mw::hal::tcl {

/// Adds the HAL commands to `interpreter`: each by its name, except where Tcl has a command of that name
/// (gets, list, exit), and all as `hal COMMAND ...`. getp, gets, list, ptype, stype and status return their
/// result; show, save and help print it. The value of setp and sets is an expression. `session` must outlive
/// the interpreter.
void add_commands(Tcl_Interp *interpreter, script::Session &session);

/// Creates an array SECTION with the elements ITEM for every INI entry; each value is a list of all its
/// values.
void add_ini(Tcl_Interp *interpreter, const script::IniLookup &ini);

/// An interpreter for one session. `exit` ends the script, not the process.
class Interpreter final : public script::ScriptRunner {
  public:
    explicit Interpreter(script::Session &session);
    ~Interpreter() override;
    Interpreter(const Interpreter &) = delete;
    Interpreter &operator=(const Interpreter &) = delete;

    Result<> run_file(const std::string &path, const std::vector<std::string> &arguments) override;
    Result<> run_standard_input() override;

  private:
    void set_arguments(const std::string &path, const std::vector<std::string> &arguments);
    Error error_here(const std::string &path) const;

    script::Session &session_;
    Tcl_Interp *interpreter_;
};

}  // namespace mw::hal::tcl
