// SPDX-License-Identifier: GPL-2.0-or-later
// The web interface of a machine whose task answers every other command; programs are in a separate folder.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "clients/screen/routes/api.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::fuzz {

/// Executes each job immediately.
class Here final : public screen::BackgroundJobs {
  public:
    void run(Job job, screen::Reply reply) override { reply(job()); }
};

struct WebRig {
    WebRig() {
        std::string name = std::filesystem::temp_directory_path().string() + "/mw_fuzz_web_XXXXXX";
        if (::mkdtemp(name.data()) == nullptr) {
            std::abort();
        }
        folder = name;
        cycle();
    }
    ~WebRig() {
        std::error_code error;
        std::filesystem::remove_all(folder, error);
    }
    WebRig(const WebRig &) = delete;
    WebRig &operator=(const WebRig &) = delete;

    std::unique_ptr<screen::Api> api(screen::Sockets &sockets) {
        screen::ApiSetup setup;
        setup.facts.name = "Mill";
        setup.facts.axes = "XYZ";
        setup.facts.program_prefix = folder;
        setup.facts.program_extensions = {".ngc"};
        setup.facts.files.mdi_history = folder + "/lines";
        setup.facts.files.preferences = folder + "/preferences";
        setup.screen_folder = folder;
        setup.screens.connect = [this] { return client::Client::join(memory.segment()); };
        setup.read_path = [](const std::string &) {
            auto pieces = std::make_shared<screen::PieceQueue>();
            pieces->end();
            return Result<std::shared_ptr<screen::PieceQueue>>(std::move(pieces));
        };
        setup.connect_hal = []() -> Result<std::unique_ptr<hal::Host>> {
            return fail("no machine is running");
        };
        return std::make_unique<screen::Api>(sockets, screen::Threads{here, here}, std::move(setup),
                                             [this] { return now_ns; });
    }
    void cycle() {
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            desk.tell(delivery.serial,
                      delivery.serial % 2 == 0 ? messages::Progress::DONE : messages::Progress::REFUSED,
                      "no");
        }
        ++status->cycle;
        desk.publish(*status);
    }

    std::string folder;
    Here here;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 1;
};

}  // namespace mw::fuzz
