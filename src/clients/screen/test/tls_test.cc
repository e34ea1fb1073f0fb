// SPDX-License-Identifier: GPL-2.0-or-later
// Tests invalid input at the port for other computers (J3): records in pieces, corrupted records, no records,
// handshakes that never end. Such input is not accepted, does not delay other clients, and uses no lasting
// memory.
#include <filesystem>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "clients/screen/server/server.hh"
#include "clients/screen/test/tls_peer.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using test::TlsPeer;

const std::string TOKEN(64, 'c');

class Parrot final : public Application {
  public:
    void answer(const Request &request, Reply reply) override {
        ++answered;
        reply({.type = "text/plain", .body = request.path});
    }
    void opened(SessionId, Role, Protection) override {}
    void received(SessionId session, std::string_view text) override {
        server->send(session, std::string(text));
    }
    void closed(SessionId) override {}

    Server *server = nullptr;
    int answered = 0;
};

class TlsTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("mw_tls_" + std::to_string(::getpid()));
        limits.connections = 6;
        limits.kept_connections = 2;
        limits.greetings_per_s = limits.greetings_at_once = 1e9;
        listen();
    }
    ~TlsTest() override { fs::remove_all(folder); }

    void listen() {
        auto certificate = read_or_make_certificate(folder.string(), {"127.0.0.1"});
        ASSERT_TRUE(certificate.has_value()) << certificate.error().str();
        RemoteDoor door{
            "127.0.0.1", 0, {}, Access(Tokens({{Role::OPERATE, TOKEN}})), std::move(*certificate)};
        server = nullptr;
        auto made = Server::listen({.port = 0, .limits = limits, .remote = std::move(door)});
        ASSERT_TRUE(made.has_value()) << made.error().str();
        server = std::move(*made);
        parrot.server = server.get();
    }
    void turn() { server->run_for(parrot, std::chrono::microseconds(200)); }
    bool run_until(const std::function<bool()> &isDone, int turns = 15000) {
        for (int i = 0; i < turns && !isDone(); ++i) {
            turn();
        }
        return isDone();
    }
    /// Sends all data in pieces of `size`, until `isDone`.
    bool talk(TlsPeer &peer, const std::function<bool()> &isDone, std::size_t size = std::string::npos) {
        return run_until([&] {
                   peer.think();
                   peer.send(size);
                   return isDone() || peer.isClosed;
               }) &&
               isDone();
    }
    bool greet(TlsPeer &peer, std::size_t size = std::string::npos) {
        return talk(peer, [&] { return peer.isUp() && peer.out.empty(); }, size);
    }
    std::string request(const std::string &path, const std::string &more = "") const {
        return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server->remote_port()) +
               "\r\nAuthorization: Bearer " + TOKEN + "\r\n" + more + "\r\n";
    }
    /// True if a valid client receives an answer.
    bool isServed(const TlsPeer::Wish &wish = {}) {
        TlsPeer peer(server->remote_port(), wish);
        if (!greet(peer)) {
            return false;
        }
        peer.say(request("/api/here", "Connection: close\r\n"));
        return talk(peer, [&] { return peer.received.ends_with("/api/here"); });
    }
    /// True if the server closes the connection without an HTTP answer.
    bool isTurnedAway(TlsPeer &peer) {
        return run_until([&] {
                   peer.think();
                   return peer.isClosed;
               }) &&
               peer.received.empty() && parrot.answered == 0;
    }

    ServerLimits limits;
    fs::path folder;
    Parrot parrot;
    std::unique_ptr<Server> server;
};

TEST_F(TlsTest, RecordsMayComeInAnyPieces) {
    for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
        for (const std::size_t size : {1UL, 2UL, 5UL, 100UL}) {
            TlsPeer peer(server->remote_port(), {.version = version});
            ASSERT_TRUE(greet(peer, size)) << size;
            peer.say(request("/api/machine"));
            EXPECT_TRUE(talk(peer, [&] { return peer.received.ends_with("/api/machine"); }, size)) << size;
        }
    }
}

TEST_F(TlsTest, WhatIsNoGreetingEndsIt) {
    const std::string old_greeting("\x80\x2e\x01\x00\x02\x00\x15\x00\x00\x00\x10", 11);  // handshake of SSL 2
    const std::string tls_1_0("\x16\x03\x01\x00\x2d\x01\x00\x00\x29\x03\x01", 11);
    const std::string ends = std::string(32, 'r') + std::string("\x00\x00\x02\x00\x2f\x01\x00", 7);
    const std::string long_record("\x16\x03\x01\xff\xff", 5), alert("\x15\x03\x01\x00\x02\x02\x28", 7);
    for (const std::string &bytes :
         {std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), std::string("\x05\x01\x00\r\n\r\n", 7),
          std::string(20000, '\0'), std::string(300, '\xff'), old_greeting + std::string(40, 'x'),
          tls_1_0 + ends, long_record + std::string(70000, 'y'), alert,
          std::string("\x17\x03\x03\x00\x05hello", 10)}) {
        TlsPeer peer(server->remote_port(), {});
        peer.out = bytes;
        run_until([&] {
            peer.send();
            return peer.out.empty() || peer.isClosed;
        });
        EXPECT_TRUE(isTurnedAway(peer)) << bytes.substr(0, 5);
    }
    EXPECT_TRUE(isServed());
}

TEST_F(TlsTest, AGreetingThatIsCutAnywhereLeavesNothingBehind) {
    for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
        std::size_t whole = 0;
        {
            TlsPeer peer(server->remote_port(), {.version = version});
            ASSERT_TRUE(run_until([&] {
                peer.think();
                whole += peer.out.size();
                peer.send();
                return peer.isUp();
            }));
        }
        for (std::size_t end = 0; end < whole; end += 7) {  // many more than the number of slots
            TlsPeer peer(server->remote_port(), {.version = version});
            std::size_t left = end;
            run_until(
                [&] {
                    peer.think();
                    const std::size_t waiting = peer.out.size();
                    peer.send(left);
                    left -= waiting - peer.out.size();
                    return left == 0;
                },
                20);
        }
        EXPECT_TRUE(isServed());
    }
}

TEST_F(TlsTest, ASpoiledByteEndsIt) {
    for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
        for (std::size_t at = 5; at < request("/api/machine").size() + 20; at += 13) {
            TlsPeer peer(server->remote_port(), {.version = version});
            ASSERT_TRUE(greet(peer));
            const std::string asked = request("/api/machine");
            peer.say(asked);
            ASSERT_GT(peer.out.size(), asked.size() + 20);  // its head and its tag
            peer.out[at] = static_cast<char>(peer.out[at] ^ 1);
            peer.send();
            EXPECT_TRUE(isTurnedAway(peer)) << at;
        }
    }
    EXPECT_TRUE(isServed());
}

TEST_F(TlsTest, GreetingsThatNeverEndAreEnded) {
    limits.greeting_time = milliseconds(100);
    listen();
    TlsPeer own(server->port(), {.hasTls = false});  // a screen on this computer, which does not use TLS
    own.out = "GET /api/socket HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server->port()) +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    own.send();
    std::vector<std::unique_ptr<TlsPeer>> slow;
    for (int i = 0; i < limits.connections - limits.kept_connections; ++i) {
        slow.push_back(std::make_unique<TlsPeer>(server->remote_port(), TlsPeer::Wish{}));
        slow.back()->think();
    }
    TlsPeer late(server->remote_port(), {});
    EXPECT_TRUE(isTurnedAway(late));  // all slots are in use
    const std::size_t before = own.taken;
    const bool are_ended = run_until([&] {
        own.out = std::string("\x81\x81\0\0\0\0x", 7);
        own.send();
        own.think();
        int ended = 0;
        for (const auto &one : slow) {
            one->send(1);  // sends one byte at a time without end
            one->think();
            ended += one->isClosed ? 1 : 0;
        }
        return ended == static_cast<int>(slow.size());
    });
    EXPECT_TRUE(are_ended);
    EXPECT_GT(own.taken, before + 3 * 20);  // three bytes for each renewal: it was served in this time
    EXPECT_TRUE(isServed());
}

TEST_F(TlsTest, NoKeysAreMadeAnewAtAPeersWish) {
    TlsPeer peer(server->remote_port(), {.version = TLS1_2_VERSION});
    ASSERT_TRUE(greet(peer));
    const auto seal = [&peer] {
        std::string bytes(64, '\0');
        bytes.resize(SSL_get_finished(peer.tls(), bytes.data(), bytes.size()));
        return bytes;
    };
    const std::string first = seal();
    ASSERT_EQ(SSL_renegotiate(peer.tls()), 1);
    SSL_do_handshake(peer.tls());
    peer.think();
    EXPECT_FALSE(peer.out.empty());  // it has requested the key update
    run_until(
        [&] {
            peer.send();
            peer.think();
            return peer.isClosed;
        },
        500);
    EXPECT_EQ(seal(), first);
    EXPECT_TRUE(isServed());
}

TEST_F(TlsTest, ManyChangesOfKeysEndIt) {
    const auto change = [](TlsPeer &peer, int times) {
        for (int i = 0; i < times; ++i) {
            SSL_key_update(peer.tls(), SSL_KEY_UPDATE_NOT_REQUESTED);
            SSL_do_handshake(peer.tls());
        }
    };
    TlsPeer modest(server->remote_port(), {}), endless(server->remote_port(), {});
    ASSERT_TRUE(greet(modest) && greet(endless));
    change(modest, 20);
    modest.say(request("/api/machine"));
    EXPECT_TRUE(talk(modest, [&] { return modest.received.ends_with("/api/machine"); }));
    parrot.answered = 0;
    change(endless, 200);
    endless.say(request("/api/machine"));
    endless.send();
    EXPECT_TRUE(isTurnedAway(endless));
    EXPECT_TRUE(isServed());
}

TEST_F(TlsTest, GroupsThatTakeLongAreNotHad) {
    EXPECT_TRUE(isServed({.groups = "X25519"}));
    EXPECT_TRUE(isServed({.groups = "P-256"}));
    parrot.answered = 0;
    for (const char *groups : {"ffdhe2048", "ffdhe8192", "P-521", "X448"}) {
        TlsPeer peer(server->remote_port(), {.groups = groups});
        peer.think();
        peer.send();
        EXPECT_TRUE(isTurnedAway(peer)) << groups;
        EXPECT_FALSE(peer.isUp()) << groups;
    }
}

TEST_F(TlsTest, SoManyGreetingsAreHeardInASecond) {
    limits.greetings_per_s = 20;
    limits.greetings_at_once = 3;
    listen();
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 8; ++i) {
        EXPECT_TRUE(isServed()) << i;  // none is rejected; they wait
    }
    EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(200));
}

}  // namespace
}  // namespace mw::screen
