// SPDX-License-Identifier: GPL-2.0-or-later
// Screens with a task and a server controlled by the test, in virtual time.
#pragma once

#include <optional>

#include <gtest/gtest.h>

#include "clients/screen/session/screens.hh"
#include "clients/screen/test/fakes.hh"

namespace mw::screen::test {

inline constexpr std::int64_t MS = 1000000;

class ScreensTest : public testing::Test {
  protected:
    ScreensTest() {
        setup.connect = [this]() -> Result<client::Client> {
            return is_up ? client::Client::join(task.memory.segment()) : fail("no machine here");
        };
        setup.connect_for_all = [this]() -> Result<client::Client> {
            return is_up ? client::Client::join(task.memory.segment(), client::Role::OPERATOR,
                                                client::Places::RESERVED)
                         : fail("no machine here");
        };
        setup.version = "0.1";
        setup.status_note = "status only";
        screens.emplace(sockets, setup);
    }
    /// The server is killed and started again.
    void start_again() {
        screens.emplace(sockets, setup);
        now_ns += 1000 * MS;
        task.message_ns = now_ns;
    }
    /// Advances the time in steps of a tick, with task cycles between them.
    std::vector<mailbox::CommandServer::Delivery> go(std::int64_t ms) {
        std::vector<mailbox::CommandServer::Delivery> taken;
        for (const std::int64_t end = now_ns + ms * MS; now_ns < end;) {
            now_ns += 10 * MS;
            task.message_ns = now_ns;
            for (auto &one : task.cycle()) {
                taken.push_back(std::move(one));
            }
            screens->tick(now_ns);
        }
        return taken;
    }
    void say(SessionId session, const std::string &text) { screens->received(session, text, now_ns); }
    void command(SessionId session, int id, const std::string &message, const std::string &fields = "") {
        say(session, R"({"id":)" + std::to_string(id) + R"(,"command":{"message":")" + message + '"' +
                         (fields.empty() ? "" : "," + fields) + "}}");
    }
    void open(SessionId session) {
        screens->opened(session, {Role::OPERATE, Protection::LOCAL}, now_ns);
        sockets.take(session);
    }
    std::vector<Json> of_kind(SessionId session, const char *key) {
        std::vector<Json> found;
        for (const Json &one : sockets.take(session)) {
            if (one.contains(key)) {
                found.push_back(one);
            }
        }
        return found;
    }

    FakeTask task;
    FakeSockets sockets;
    ScreensSetup setup;
    std::optional<Screens> screens;
    std::int64_t now_ns = 1;
    bool is_up = true;
};

}  // namespace mw::screen::test
