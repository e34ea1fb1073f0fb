// SPDX-License-Identifier: GPL-2.0-or-later
// The machine for Tcl programs: a client with the settings of a program. It does not use Tcl.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/ini/ini_file.hh"
#include "clients/rsh/commander.hh"
#include "clients/rsh/orders.hh"
#include "clients/rsh/own_state.hh"
#include "clients/rsh/settings.hh"
#include "clients/rsh/words.hh"

namespace mw::tcl {

using rsh::Words;

/// All calls come from one thread. Its questions and orders are those of linuxcncrsh, whose tables it uses.
class Shell {
  public:
    /// `viewer` and `joining` are for the machine; `ini` is its INI file.
    Shell(client::Viewer viewer, rsh::Joining joining, ini::IniFile ini);

    const messages::MachineStatus &status() const { return own.kept != nullptr ? *own.kept : view_.status(); }
    /// Reads the current status; with `isUpdating` off the status changes only here.
    Result<> update();
    /// Called before a question.
    Result<> look();

    /// The words after the name in an answer of GET.
    Result<std::string> told(const std::string &question, const Words &words = {});
    /// SET; returns an empty text, or the reason of the rejection, which is an answer and not an error of the
    /// program.
    Result<std::string> ask(const std::string &order, const Words &words = {});
    Result<std::string> send(const messages::Command &command);
    Result<std::string> jog(const rsh::JogTarget &target, double velocity);
    Result<std::string> stop_jog(const rsh::JogTarget &target);
    /// Renews jogs; call it often while isJogging().
    void keep_jogging();
    bool isJogging() const { return commander_.isJogging(); }

    /// Waits for the last command; "timeout" when the time expires first.
    Result<std::string> wait(bool untilDone);
    /// Nothing if there is none.
    std::optional<std::string> next_line(messages::MessageKind kind);
    bool isMachineAlive() const { return view_.isMachineAlive(); }

    const ini::IniFile &ini() const { return *ini_; }
    /// Sets another file for emc_ini.
    void set_ini(ini::IniFile ini);
    rsh::OwnState own;

  private:
    Result<std::string> finish(rsh::Waiting waiting);
    Result<bool> isOver(const rsh::Waiting &waiting, bool untilDone);

    std::unique_ptr<ini::IniFile> ini_;
    rsh::Settings settings_;
    rsh::SharedView view_;
    rsh::Commander commander_;
    std::deque<std::string> errors_;
};

}  // namespace mw::tcl
