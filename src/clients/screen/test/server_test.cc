// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the server over a loopback socket: requests, limits, frames (J3).
#include <fcntl.h>

#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "clients/screen/test/server_peer.hh"

namespace mw::screen::test {
namespace {

TEST_F(ServerTest, OneConnectionCarriesManyRequests) {
    listen();
    Peer peer(server->port());
    const std::string first = ask(peer, "GET /a%20b?x=1&y=%2f HTTP/1.1\r\n" + host() + "\r\n", "GET /a b|");
    EXPECT_TRUE(first.starts_with("HTTP/1.1 200 OK\r\n")) << first;
    EXPECT_NE(first.find("X-Content-Type-Options: nosniff"), std::string::npos);
    EXPECT_EQ(echo.asked.at(0).query.at("x"), "1");
    EXPECT_EQ(echo.asked.at(0).query.at("y"), "/");
    const std::string second =
        ask(peer, "PUT /f HTTP/1.1\r\n" + host() + "Content-Length: 4\r\n\r\nbody", "PUT /f|body");
    EXPECT_TRUE(second.starts_with("HTTP/1.1 200 OK\r\n")) << second;
}

TEST_F(ServerTest, PagesOfOthersReachNothing) {
    listen();
    const std::string port = std::to_string(server->port());
    const auto with_host = [](const std::string &name) {
        return "GET /x HTTP/1.1\r\nHost: " + name + "\r\nConnection: close\r\n\r\n";
    };
    EXPECT_EQ(status_of(with_host("localhost:" + port)), "HTTP/1.1 200 OK");
    EXPECT_EQ(status_of(get("/x", "Origin: http://127.0.0.1:" + port + "\r\n")), "HTTP/1.1 200 OK");
    const std::size_t asked = echo.asked.size();
    for (const std::string &name :
         {"evil.example:" + port, std::string("127.0.0.1"), std::string("localhost:1"), std::string("")}) {
        EXPECT_EQ(status_of(with_host(name)), "HTTP/1.1 403 Forbidden") << name;
    }
    EXPECT_EQ(status_of("GET /x HTTP/1.1\r\nConnection: close\r\n\r\n"), "HTTP/1.1 403 Forbidden");
    for (const std::string origin :
         {"http://evil.example", "null", "https://127.0.0.1:", "http://127.0.0.1:1"}) {
        EXPECT_EQ(status_of(get("/x", "Origin: " + origin + "\r\n")), "HTTP/1.1 403 Forbidden") << origin;
        EXPECT_EQ(status_of(upgrade("/api/socket", "Origin: " + origin + "\r\n")).substr(0, 12),
                  "HTTP/1.1 403")
            << origin;
    }
    EXPECT_EQ(status_of(get("/api/path", "Sec-Fetch-Site: cross-site\r\n")), "HTTP/1.1 403 Forbidden");
    EXPECT_EQ(echo.asked.size(), asked);
    EXPECT_TRUE(echo.open.empty());
}

/// The kernel's answer for another user.
Result<SocketFacts> of_another_user(const Endpoint &client, const Endpoint &server) {
    auto found = SocketFinder()(client, server);
    if (found.has_value()) {
        found->uid = ::geteuid() + 1;
    }
    return found;
}

TEST_F(ServerTest, AnotherUserOfThisComputerHasStatusOnly) {
    listen(ServerOptions{.port = 0,
                         .local_tokens = Tokens({{Role::OPERATE, std::string(64, 'o')}}),
                         .find_socket = of_another_user});
    EXPECT_EQ(status_of(get("/api/x")), "HTTP/1.1 200 OK");
    EXPECT_EQ(status_of(get("/api/x", "Authorization: Bearer " + std::string(64, 'o') + "\r\n")),
              "HTTP/1.1 200 OK");
    ASSERT_EQ(echo.asked.size(), 2U);
    EXPECT_EQ(echo.asked[0].role, Role::STATUS);
    EXPECT_EQ(echo.asked[1].role, Role::OPERATE);
    Peer screen(server->port()), browser(server->port());
    ask(screen, upgrade(), "\r\n\r\n");
    ASSERT_TRUE(areOpened(1));
    EXPECT_EQ(echo.rights[0].role, Role::STATUS);
    const std::string body = R"({"token":")" + std::string(64, 'o') + R"("})";
    const std::string answer = ask(browser,
                                   "POST /api/login HTTP/1.1\r\n" + host() +
                                       "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body,
                                   "\r\n\r\n");
    const std::size_t cookie = answer.find("millwright_token_");
    ASSERT_NE(cookie, std::string::npos) << answer;
    EXPECT_TRUE(run_until([&] { return !echo.ended.empty(); })) << "it connects again, with the cookie";
    Peer again(server->port());
    ask(again,
        upgrade("/api/socket",
                "Cookie: " + answer.substr(cookie, answer.find(';', cookie) - cookie) + "\r\n"),
        "\r\n\r\n");
    ASSERT_TRUE(areOpened(2));
    EXPECT_EQ(echo.rights[1].role, Role::OPERATE);
}

TEST_F(ServerTest, NobodyHasMoreThanStatusWhereTheKernelDoesNotTellTheUser) {
    std::vector<std::string> reported;
    listen(ServerOptions{.port = 0,
                         .find_socket = [](const Endpoint &, const Endpoint &) -> Result<SocketFacts> {
                             return fail("no netlink");
                         },
                         .report = [&](const std::string &why) { reported.push_back(why); }});
    EXPECT_EQ(status_of(get("/api/x")), "HTTP/1.1 200 OK");
    EXPECT_EQ(status_of(get("/api/x")), "HTTP/1.1 200 OK");
    ASSERT_EQ(echo.asked.size(), 2U);
    EXPECT_EQ(echo.asked[1].role, Role::STATUS);
    EXPECT_EQ(reported, std::vector<std::string>{"no netlink"});
}

TEST_F(ServerTest, OtherUsersLeaveConnectionsToTheUserOfTheServer) {
    bool foreign = true;
    listen(ServerOptions{.port = 0,
                         .limits = {.connections = 4, .foreign_connections = 2},
                         .find_socket = [&](const Endpoint &from, const Endpoint &to) {
                             return foreign ? of_another_user(from, to) : SocketFinder()(from, to);
                         }});
    std::vector<std::unique_ptr<Peer>> peers;
    for (int i = 0; i < 5; ++i) {
        peers.push_back(std::make_unique<Peer>(server->port()));
    }
    EXPECT_TRUE(run_until([&] {
        return std::ranges::count_if(peers, [](const auto &peer) {
                   peer->read();
                   return peer->isClosed;
               }) == 3;
    }));
    foreign = false;
    EXPECT_EQ(status_of(get("/api/x")), "HTTP/1.1 200 OK");
    EXPECT_EQ(echo.asked.back().role, Role::CONFIGURE);
}

TEST_F(ServerTest, RejectsHeadersOfAccessThatAreSetTwice) {
    listen();
    const std::string bad = "HTTP/1.1 400 Bad Request";
    for (const std::string more : {"evil.example", "", "127.0.0.1:1"}) {
        EXPECT_EQ(status_of(get("/x", "Host: " + more + "\r\n")), bad) << more;
    }
    EXPECT_EQ(status_of(get("/x", host())), bad);
    EXPECT_EQ(status_of(upgrade("/api/socket", host())), bad);
    for (const std::string name : {"Origin", "Sec-Fetch-Site", "Authorization", "Cookie"}) {
        EXPECT_EQ(status_of(get("/x", name + ": \r\n" + name + ": a\r\n")), bad) << name;
    }
    EXPECT_TRUE(echo.asked.empty());
    EXPECT_TRUE(echo.open.empty());
}

TEST_F(ServerTest, WhatIsTooLargeOrNoRequestIsRefused) {
    listen();
    EXPECT_EQ(status_of(get("/x", "X: " + std::string(20000, 'x') + "\r\n")),
              "HTTP/1.1 413 Payload Too Large");
    EXPECT_EQ(status_of("PUT /f HTTP/1.1\r\n" + host() + "Content-Length: 2000000\r\n\r\n" +
                        std::string(2000000, 'x')),
              "HTTP/1.1 413 Payload Too Large");
    EXPECT_EQ(status_of("nonsense\r\n\r\n"), "HTTP/1.1 400 Bad Request");
    EXPECT_EQ(status_of(get("/%zz")), "HTTP/1.1 400 Bad Request");
    EXPECT_EQ(status_of(get("/%0a")), "HTTP/1.1 400 Bad Request");
    EXPECT_EQ(status_of(get("*")), "HTTP/1.1 400 Bad Request");
    EXPECT_TRUE(echo.asked.empty());
    EXPECT_EQ(status_of("PUT /f HTTP/1.1\r\n" + host() +
                        "Connection: close\r\nContent-Length: 1048576\r\n\r\n" + std::string(1048576, 'x')),
              "HTTP/1.1 200 OK");
}

TEST_F(ServerTest, TooManyRequestsAreRefusedUntilLater) {
    ServerLimits limits;
    limits.requests_per_s = 0.001;
    limits.requests_at_once = 3;
    listen(limits);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(status_of(get("/x")), "HTTP/1.1 200 OK");
    }
    EXPECT_EQ(status_of(get("/x")), "HTTP/1.1 429 Too Many Requests");
}

TEST_F(ServerTest, ASocketCarriesTextsBothWays) {
    listen();
    Peer peer(server->port());
    const std::string head = ask(peer, upgrade(), "\r\n\r\n");
    EXPECT_TRUE(head.starts_with("HTTP/1.1 101")) << head;
    EXPECT_NE(head.find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos);  // example of RFC 6455
    ASSERT_TRUE(areOpened(1));
    EXPECT_EQ(ask(peer, frame("hello"), "hello"), "\x81\x05hello");
    EXPECT_EQ(ask(peer, frame("a", 0x01) + frame("bc", 0x80), "abc"), "\x81\x03"
                                                                      "abc");
    write(peer, frame(std::string(65536, 'x')));
    EXPECT_TRUE(run_until([&] { return echo.texts.size() == 3; }));
    EXPECT_TRUE(server->isIdle(echo.open[0]) || run_until([&] { return server->isIdle(echo.open[0]); }));
    peer.received.clear();
    server->send(echo.open[0], std::string(20000, 'y'));  // as one frame
    run_until([&] {
        peer.read();
        return peer.received.size() >= 65546 + 20004;
    });
    EXPECT_TRUE(peer.received.ends_with("\x81\x7e\x4e\x20" + std::string(20000, 'y')));
}

TEST_F(ServerTest, ASocketThatMisbehavesIsClosedAndTold) {
    listen();
    const std::vector<std::string> bad{frame(std::string(65537, 'x')), frame("x", 0x82), frame("\xff\xfe"),
                                       "\x81\x01x", frame("x", 0x83)};
    for (std::size_t i = 0; i < bad.size(); ++i) {
        {
            Peer peer(server->port());
            EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
            static_cast<void>(ask(peer, bad[i], ""));
            EXPECT_TRUE(peer.isClosed) << i;
        }
        EXPECT_TRUE(run_until([&] { return echo.ended.size() == i + 1; })) << i;
    }
    EXPECT_TRUE(echo.texts.empty());
}

TEST_F(ServerTest, AConnectionThatIsCutIsToldOnce) {
    listen();
    {
        Peer peer(server->port());
        EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    }
    EXPECT_TRUE(run_until([&] { return echo.ended.size() == 1; }));
    EXPECT_EQ(echo.ended, echo.open);
    Peer other(server->port());
    EXPECT_TRUE(ask(other, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    ASSERT_TRUE(areOpened(2));
    server->close(echo.open[1]);
    server->close(echo.open[1]);
    EXPECT_TRUE(run_until([&] {
        other.read();
        return other.isClosed && echo.ended.size() == 2;
    }));
    server->run_for(echo, milliseconds(20));
    EXPECT_EQ(echo.ended.size(), 2U);
}

TEST_F(ServerTest, AsManySocketsAsCanBe) {
    ServerLimits limits;
    limits.sessions = 1;
    listen(limits);
    Peer peer(server->port());
    EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    EXPECT_EQ(status_of(upgrade("/api/socket")).substr(0, 12), "HTTP/1.1 503");
    EXPECT_EQ(status_of(upgrade("/other")).substr(0, 12), "HTTP/1.1 404");
}

TEST_F(ServerTest, WhoDoesNotReadDoesNotFillTheMemory) {
    ServerLimits limits;
    limits.waiting_bytes = 1024 * 1024;
    listen(limits);
    Peer peer(server->port());
    EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    ASSERT_TRUE(areOpened(1));
    bool busy = false;
    for (int i = 0; i < 20000 && echo.ended.empty(); ++i) {
        server->send(echo.open[0], std::string(4096, 'x'));
        server->run_for(echo, std::chrono::microseconds(10));
        busy = busy || !server->isIdle(echo.open[0]);
    }
    EXPECT_TRUE(busy);
    EXPECT_TRUE(run_until([&] { return !echo.ended.empty(); }));
}

TEST_F(ServerTest, AnAnswerMayComeLaterFromAnotherThread) {
    listen();
    echo.is_later = true;
    Peer peer(server->port());
    write(peer, get("/x"));
    ASSERT_TRUE(run_until([&] { return echo.later != nullptr; }));
    std::thread other([&] { server->post([&] { echo.later({.body = "at last"}); }); });
    other.join();
    EXPECT_NE(ask(peer, "", "at last").find("at last"), std::string::npos);
}

TEST_F(ServerTest, ABodyComesInPiecesWhileItIsMade) {
    listen();
    echo.pieces = std::make_shared<PieceQueue>();
    std::thread maker([pieces = echo.pieces] {
        for (int i = 0; i < 300; ++i) {
            ASSERT_TRUE(pieces->push(std::string(100000, static_cast<char>('a' + i % 26))));
        }
        pieces->end();
    });
    Peer peer(server->port());
    const std::string answer = ask(peer, get("/x"), "");
    maker.join();
    EXPECT_NE(answer.find("Transfer-Encoding: chunked"), std::string::npos);
    EXPECT_GT(answer.size(), 30000000U);
    EXPECT_TRUE(answer.ends_with("0\r\n\r\n"));
}

TEST_F(ServerTest, WhoeverMakesPiecesEndsWhenNobodyReads) {
    listen();
    echo.pieces = std::make_shared<PieceQueue>();
    std::thread maker([pieces = echo.pieces] {
        while (pieces->push(std::string(100000, 'x'))) {
        }
        pieces->end();
    });
    {
        Peer peer(server->port());
        static_cast<void>(ask(peer, get("/x"), "\r\n\r\n"));
    }
    EXPECT_TRUE(run_until([&] { return echo.pieces->isCancelled(); }));
    maker.join();
}

TEST_F(ServerTest, ItListensToThisComputerAlone) {
    listen();
    Peer ours(server->port()), other(server->port(), INADDR_LOOPBACK + 1);
    EXPECT_NE(ask(ours, get("/x"), "\r\n\r\n"), "");
    EXPECT_TRUE(run_until([&] {
        other.read();
        return other.isClosed;
    }));
    EXPECT_EQ(other.received, "");
}

/// Descriptors of the process that are bound to a port and remain open in a started program.
int count_inherited(int port) {
    int found = 0;
    for (int fd = 0; fd < 1024; ++fd) {
        sockaddr_in place{};
        socklen_t size = sizeof place;
        const bool is_socket = ::getsockname(fd, reinterpret_cast<sockaddr *>(&place), &size) == 0;
        const bool of_server = is_socket && place.sin_family == AF_INET &&
                               place.sin_port == htons(static_cast<std::uint16_t>(port));
        found += of_server && (::fcntl(fd, F_GETFD) & FD_CLOEXEC) == 0 ? 1 : 0;
    }
    return found;
}

TEST_F(ServerTest, ABrowserThatItStartsDoesNotKeepItsPort) {
    listen();
    Peer peer(server->port());
    EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    EXPECT_EQ(count_inherited(server->port()), 0);
}

TEST_F(ServerTest, WhoNeverEndsHisRequestIsCutOff) {
    ServerLimits limits;
    limits.request_time = milliseconds(300);
    limits.connections = 2;
    listen(limits);
    Peer slow(server->port());
    write(slow, "GET /x HTTP/1.1\r\nHost: ");
    EXPECT_EQ(status_of(get("/x")), "HTTP/1.1 200 OK");  // nobody waits for the answer
    EXPECT_TRUE(run_until([&] {
        slow.read();
        return slow.isClosed;
    }));
}

TEST_F(ServerTest, WhoGoesOnAfterHisRefusalIsCutOff) {
    ServerLimits limits;
    limits.request_time = milliseconds(300);
    listen(limits);
    Peer peer(server->port());
    write(peer, "PUT /f HTTP/1.1\r\n" + host() + "Content-Length: 2000000\r\n\r\n");
    EXPECT_TRUE(run_until([&] {  // byte by byte
        std::string more = "x";
        return !peer.write(more);
    }));
}

TEST_F(ServerTest, ConnectionsBeyondTheMostAreClosed) {
    ServerLimits limits;
    limits.connections = 2;
    listen(limits);
    {
        Peer first(server->port()), second(server->port());
        server->run_for(echo, milliseconds(20));
        EXPECT_EQ(status_of(get("/x")), "");
    }
    EXPECT_TRUE(run_until([&] { return status_of(get("/x")) == "HTTP/1.1 200 OK"; }));
}

TEST_F(ServerTest, WhoDoesNotReadDelaysNobody) {
    listen();
    Peer slow(server->port()), other(server->port());
    EXPECT_TRUE(ask(slow, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    EXPECT_TRUE(ask(other, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    ASSERT_TRUE(areOpened(2));
    for (int i = 0; i < 1000; ++i) {
        server->send(echo.open[0], std::string(4096, 'x'));
        server->run_for(echo, std::chrono::microseconds(10));
    }
    ASSERT_FALSE(server->isIdle(echo.open[0]));
    EXPECT_EQ(ask(other, frame("stop"), "stop"), "\x81\x04stop");
    EXPECT_TRUE(echo.ended.empty());
}

TEST_F(ServerTest, ABrokenFrameEndsThoughThePeerStays) {
    listen();
    Peer peer(server->port());
    EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    write(peer, "\x81\x01x");
    EXPECT_TRUE(run_until([&] { return echo.ended.size() == 1; }));
}

/// Data with a valid beginning and an invalid rest.
TEST_F(ServerTest, AnythingMayComeOverAConnection) {
    listen();
    std::mt19937_64 random(17);
    const auto pick = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
    for (int i = 0; i < 400; ++i) {
        std::string bytes = get("/x", "Origin: http://127.0.0.1:" + std::to_string(server->port()) + "\r\n");
        const bool is_socket = pick(2) == 0;
        Peer peer(server->port());
        if (is_socket) {
            ASSERT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101")) << i;
            bytes.clear();
            for (std::size_t n = pick(4) + 1; n > 0; --n) {
                bytes += frame(std::string(pick(300), static_cast<char>(random())),
                               static_cast<unsigned char>(random()));
            }
        }
        for (std::size_t n = pick(6); n > 0; --n) {
            bytes[pick(bytes.size())] = static_cast<char>(random());
        }
        bytes.resize(pick(bytes.size()) + 1);
        write(peer, bytes);
        server->run_for(echo, milliseconds(1));
    }
    EXPECT_TRUE(run_until([&] { return echo.ended.size() == echo.open.size(); }));
    echo.texts.clear();
    Peer peer(server->port());
    EXPECT_TRUE(ask(peer, upgrade(), "\r\n\r\n").starts_with("HTTP/1.1 101"));
    EXPECT_EQ(ask(peer, frame("hello"), "hello"), "\x81\x05hello");
}

TEST_F(ServerTest, APortThatIsTakenIsToldWithWhatToDo) {
    listen();
    const auto second = Server::listen({.port = server->port(), .limits = {}});
    ASSERT_FALSE(second.has_value());
    EXPECT_NE(second.error().str().find("--port"), std::string::npos);
}

}  // namespace
}  // namespace mw::screen::test
