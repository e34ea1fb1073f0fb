// SPDX-License-Identifier: GPL-2.0-or-later
// schedrmt: a queue of programs for a running machine, by lines of text over TCP.
#include <chrono>

#include "clients/schedule/session.hh"
#include "programs/commands.hh"
#include "programs/remote/text_server.hh"

namespace mw::programs {
namespace {

class ScheduleService final : public TextService {
  public:
    explicit ScheduleService(const TextMachine &machine)
        : machine_(machine),
          scheduler_([this] { return connect_to_operate(machine_.instance); }, folder_of(machine)) {}
    std::unique_ptr<rsh::Conversation> begin() override {
        return std::make_unique<schedule::Session>(
            schedule::Shared{machine_.settings, machine_.view, scheduler_});
    }
    void step(const messages::MachineStatus &status) override {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        scheduler_.step(status, std::chrono::duration<double>(now).count());
    }

  private:
    static std::string folder_of(const TextMachine &machine) {
        const rsh::Settings &settings = machine.settings;
        return settings.program_folder.empty() && settings.ini != nullptr ? settings.ini->folder()
                                                                          : settings.program_folder;
    }

    TextMachine machine_;
    schedule::Scheduler scheduler_;
};

}  // namespace

int command_schedule(const std::vector<std::string> &arguments) {
    TextServerWords words{"schedrmt",
                          "Runs a queue of programs on the running machine. Clients control the queue by "
                          "lines of text over TCP\n(man page schedrmt). Ends with the machine, at SHUTDOWN "
                          "from a client, or at SIGINT or SIGTERM.\n",
                          false};
    return serve_text(std::move(words), arguments, [](const TextMachine &machine) {
        return std::unique_ptr<TextService>(std::make_unique<ScheduleService>(machine));
    });
}

}  // namespace mw::programs
