// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcncrsh: controls a running machine by lines of text over TCP.
#include "clients/rsh/session.hh"
#include "programs/commands.hh"
#include "programs/remote/text_server.hh"

namespace mw::programs {
namespace {

class RshService final : public TextService {
  public:
    explicit RshService(const TextMachine &machine) : machine_(machine) {}
    std::unique_ptr<rsh::Conversation> begin() override {
        return std::make_unique<rsh::Session>(machine_.settings, machine_.view,
                                              [this] { return connect_to_operate(machine_.instance); });
    }

  private:
    TextMachine machine_;
};

}  // namespace

int command_rsh(const std::vector<std::string> &arguments) {
    TextServerWords words{
        "linuxcncrsh",
        "Accepts commands for the running machine as lines of text over TCP (man page linuxcncrsh). Ends "
        "with the\nmachine, at SHUTDOWN from a client, or at SIGINT or SIGTERM.\n",
        true};
    return serve_text(std::move(words), arguments, [](const TextMachine &machine) {
        return std::unique_ptr<TextService>(std::make_unique<RshService>(machine));
    });
}

}  // namespace mw::programs
