// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as programs in Tcl see it: a client with the words that a program has set for itself. Knows no
// Tcl.
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

/// One thread. Its questions and orders are those of linuxcncrsh, whose tables it uses.
class Shell {
  public:
    /// `viewer` and `joining`: of the machine. `ini` is its INI file.
    Shell(client::Viewer viewer, rsh::Joining joining, ini::IniFile ini);

    const messages::MachineStatus &status() const { return own.kept != nullptr ? *own.kept : view_.status(); }
    /// Takes the status as it is now; with `isUpdating` off only this does.
    Result<> update();
    /// Before a question.
    Result<> look();

    /// The words behind the name of an answer of GET.
    Result<std::string> told(const std::string &question, const Words &words = {});
    /// SET; an empty text, or the reason of the rejection: that is an answer, not an error of the program.
    Result<std::string> ask(const std::string &order, const Words &words = {});
    Result<std::string> send(const messages::Command &command);
    Result<std::string> jog(const rsh::JogTarget &target, double velocity);
    Result<std::string> stop_jog(const rsh::JogTarget &target);
    /// Renews what is jogged; often while isJogging().
    void keep_jogging();
    bool isJogging() const { return commander_.isJogging(); }

    /// For the last thing that was asked; "timeout" when it is over before.
    Result<std::string> wait(bool untilDone);
    /// Nothing: none is there.
    std::optional<std::string> next_line(messages::MessageKind kind);
    bool isMachineAlive() const { return view_.isMachineAlive(); }

    const ini::IniFile &ini() const { return *ini_; }
    /// Another file for emc_ini.
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
