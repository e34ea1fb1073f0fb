// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the port: connections in and out, on loopback.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "clients/rsh/server.hh"

namespace mw::rsh {
namespace {

/// Returns each byte. A full stop ends the conversation, an exclamation mark the server.
class Echo final : public Conversation {
  public:
    Echo(std::atomic<int> &living, bool mute) : living_(living), isMute_(mute) { ++living_; }
    ~Echo() override { --living_; }
    void take(std::string_view bytes) override { in_ += bytes; }
    void end_input() override { over_ = true; }
    bool isFull() const override { return false; }
    void step(double) override {
        out_ += isMute_ ? "" : in_;
        over_ = over_ || in_.find('.') != std::string::npos;
        is_end_ = is_end_ || in_.find('!') != std::string::npos;
        over_ = over_ || is_end_;
        in_.clear();
    }
    std::string &output() override { return out_; }
    bool isBusy() const override { return false; }
    bool isOver() const override { return over_; }
    bool wantsShutdown() const override { return is_end_; }

  private:
    std::atomic<int> &living_;
    bool isMute_;
    std::string in_, out_;
    bool over_ = false, is_end_ = false;
};

class RshServerTest : public ::testing::Test {
  protected:
    void start(int max_sessions = -1) {
        ServerSettings settings;
        settings.port = 0;
        settings.max_sessions = max_sessions;
        auto made = Server::listen(settings, [this] { return std::make_unique<Echo>(living, mute); });
        ASSERT_TRUE(made.has_value()) << made.error().str();
        server = std::move(*made);
        thread = std::thread([this] { server->run([this] { return !ended; }, 0.01); });
    }
    void TearDown() override {
        ended = true;
        if (thread.joinable()) {
            thread.join();
        }
    }
    int connect() const {
        const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(static_cast<std::uint16_t>(server->port()));
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(fd, reinterpret_cast<const sockaddr *>(&place), sizeof place), 0);
        return fd;
    }
    /// Bytes until the peer closes, or at most this many.
    static std::string hear(int fd, std::size_t most) {
        std::string all;
        char byte = 0;
        while (all.size() < most && ::read(fd, &byte, 1) == 1) {
            all += byte;
        }
        return all;
    }
    static void say(int fd, const std::string &text) {
        EXPECT_EQ(::write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }

    std::atomic<int> living{0};
    bool mute = false;
    std::atomic<bool> ended{false};
    std::unique_ptr<Server> server;
    std::thread thread;
};

TEST_F(RshServerTest, SeveralAreServedAtOnceAndAPortIsHadOnce) {
    start();
    const int one = connect(), other = connect();
    say(other, "b");
    say(one, "a");
    EXPECT_EQ(hear(one, 1), "a");
    EXPECT_EQ(hear(other, 1), "b");
    ServerSettings same;
    same.port = server->port();
    EXPECT_FALSE(Server::listen(same, [] { return nullptr; }).has_value());
    ::close(one);
    say(other, "c.");
    EXPECT_EQ(hear(other, 9), "c.") << "then it is closed";
    ::close(other);
    while (living > 0) {
        std::this_thread::yield();
    }
}

TEST_F(RshServerTest, MoreThanAreWantedAreTurnedAway) {
    start(1);
    const int one = connect();
    say(one, "a");
    EXPECT_EQ(hear(one, 1), "a");
    const int other = connect();
    EXPECT_EQ(hear(other, 1), "");
    ::close(one);
    ::close(other);
}

TEST_F(RshServerTest, LastWordsAreSaidWhenTheServerEnds) {
    start();
    const int one = connect();
    say(one, "end!");
    EXPECT_EQ(hear(one, 9), "end!");
    thread.join();
    ::close(one);
}

TEST_F(RshServerTest, ItAlsoEndsForWhoHasNothingMoreToHear) {
    mute = true;
    start();
    const int one = connect();
    say(one, "!");
    EXPECT_EQ(hear(one, 9), "");
    thread.join();
    ::close(one);
}

TEST_F(RshServerTest, WhatIsLongComesWhole) {
    start();
    const int one = connect();
    std::string all(300000, 'x');
    std::thread writer([&] { say(one, all + '.'); });
    EXPECT_EQ(hear(one, all.size() + 9), all + '.');
    writer.join();
    ::close(one);
}

TEST_F(RshServerTest, AnAddressThatIsNoneIsToldInOneLine) {
    ServerSettings settings;
    settings.address = "nowhere";
    const auto made = Server::listen(settings, [] { return nullptr; });
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().str(), "'nowhere' is no address");
}

}  // namespace
}  // namespace mw::rsh
