// SPDX-License-Identifier: GPL-2.0-or-later
// Replacements of the server and of task.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/screen/http/background_jobs.hh"
#include "clients/screen/http/http_types.hh"
#include "messages/client/client.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::screen::test {

using Json = nlohmann::json;

class FakeSockets final : public Sockets {
  public:
    void send(SessionId session, std::string text) override { sent[session].push_back(Json::parse(text)); }
    bool isIdle(SessionId session) const override { return !busy.contains(session) || !busy.at(session); }
    void close(SessionId session) override { closed.push_back(session); }

    std::vector<Json> take(SessionId session) { return std::exchange(sent[session], {}); }

    std::map<SessionId, std::vector<Json>> sent;
    std::map<SessionId, bool> busy;
    std::vector<SessionId> closed;
};

/// Runs each job at once.
class Here final : public BackgroundJobs {
  public:
    void run(Job job, Reply reply) override { reply(job()); }
};

/// A task that behaves as set by the test.
class FakeTask {
  public:
    /// Runs one cycle; each command is DONE unless the test keeps it.
    std::vector<mailbox::CommandServer::Delivery> cycle() {
        now_ns += 1000000;
        ++status->cycle;
        auto taken = desk.take(now_ns);
        for (const auto &delivery : taken) {
            if (!keeping) {
                desk.tell(delivery.serial, messages::Progress::DONE, "");
            }
        }
        desk.publish(*status);
        return taken;
    }

    mailbox::Memory memory = mailbox::Memory::in_process();
    std::int64_t message_ns = 0;  ///< time of the next message
    mailbox::CommandServer desk{memory.segment(), mailbox::CommandServer::Rights::HERE,
                                [this] { return message_ns; }};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    bool keeping = false;
};

}  // namespace mw::screen::test
