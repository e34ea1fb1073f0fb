// SPDX-License-Identifier: GPL-2.0-or-later
// The common part of linuxcncrsh and schedrmt: the command line, the machine and the port.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/options/command_line.hh"
#include "clients/rsh/conversation.hh"
#include "clients/rsh/server.hh"
#include "clients/rsh/settings.hh"
#include "clients/rsh/shared_view.hh"
#include "messages/client/client.hh"
#include "programs/remote/remote_client.hh"

namespace mw::programs {

/// The command line of a program that serves lines of text.
struct TextServerWords {
    std::string program = {}, what = {};  ///< name and purpose of the program, for --help
    bool has_dialects = false;            ///< the option --dialect exists
    rsh::Settings settings = {};
    rsh::ServerSettings server = {};
    std::string ini = {}, dialect = "2.10";
    bool isQuiet = false;

    options::CommandLine line();
    Result<> parse(std::vector<std::string> words);

  private:
    Result<> check_passwords() const;
};

/// The protocol of such a program.
class TextService {
  public:
    virtual ~TextService() = default;
    virtual std::unique_ptr<rsh::Conversation> begin() = 0;
    /// Called before conversations continue.
    virtual void step(const messages::MachineStatus &) {}
};

/// Objects that a service uses; they must outlive the service.
struct TextMachine {
    const rsh::Settings &settings;
    rsh::SharedView &view;
    std::string instance;
};

using TextServiceMaking = std::unique_ptr<TextService> (*)(const TextMachine &);

/// Runs until the machine ends, a signal arrives or a client sends SHUTDOWN; returns the exit status.
int serve_text(TextServerWords words, const std::vector<std::string> &arguments, TextServiceMaking make);

}  // namespace mw::programs
