// SPDX-License-Identifier: GPL-2.0-or-later
// Tests memory of the server for large answers to slow and closed clients.
#include <gtest/gtest.h>

#include "clients/screen/test/server_peer.hh"

namespace mw::screen::test {
namespace {

using AnswersTest = ServerTest;

TEST_F(AnswersTest, ReadsALargeBodyOnlyAsFastAsItsClientTakesIt) {
    listen();
    std::uint64_t count = 0;
    constexpr std::uint64_t SIZE = 276UL * 1000 * 1000, MOST = 16UL * 1024 * 1024;
    echo.make_source = [&] { return std::make_shared<LargeFile>(SIZE, count); };
    std::vector<std::unique_ptr<Peer>> peers;
    for (int i = 0; i < 14; ++i) {  // clients that never read
        peers.push_back(std::make_unique<Peer>(server->port()));
        write(*peers.back(), "GET /large HTTP/1.1\r\n" + host() + "\r\n");
    }
    ASSERT_TRUE(run_until([&] { return echo.asked.size() == 14; }));
    for (std::uint64_t before = 1; before != count;) {
        before = count;
        server->run_for(echo, milliseconds(50));
    }
    EXPECT_LT(count, 14 * MOST) << "what the kernel takes, and a piece of each";
}

TEST_F(AnswersTest, ABodyThatIsReadWhileItIsSentComesWhole) {
    listen();
    std::uint64_t count = 0;
    constexpr std::uint64_t SIZE = 3 * BodySource::PIECE + 17;
    echo.make_source = [&] { return std::make_shared<LargeFile>(SIZE, count); };
    Peer peer(server->port());
    const std::string answer = ask(peer, get("/x"), "");
    EXPECT_NE(answer.find("Content-Length: " + std::to_string(SIZE) + "\r\n"), std::string::npos);
    EXPECT_TRUE(answer.ends_with("\r\n\r\n" + std::string(SIZE, 'x')));
}

TEST_F(AnswersTest, DisconnectsAClientThatDoesNotTakeAPiece) {
    listen({.request_time = milliseconds(100)});
    std::uint64_t count = 0;
    echo.make_source = [&] { return std::make_shared<LargeFile>(std::uint64_t{1} << 40, count); };
    std::weak_ptr<BodySource> kept;
    echo.make_source = [&, make = echo.make_source] {
        auto made = make();
        kept = made;
        return made;
    };
    const Peer peer(server->port());
    std::string request = "GET /large HTTP/1.1\r\n" + host() + "\r\n";
    ASSERT_TRUE(run_until([&] { return peer.write(request) && request.empty(); }));
    ASSERT_TRUE(run_until([&] { return !echo.asked.empty(); }));
    EXPECT_TRUE(run_until([&] { return kept.expired(); }));
}

TEST_F(AnswersTest, DisconnectsASocketThatDoesNotTakeAText) {
    listen({.request_time = milliseconds(100)});
    Peer peer(server->port());
    ask(peer, upgrade(), "\r\n\r\n");
    ASSERT_TRUE(areOpened(1));
    for (int i = 0; i < 3; ++i) {  // more than the kernel accepts, but less than may wait
        server->send(echo.open[0], std::string(1UL << 20, 'x'));
    }
    EXPECT_TRUE(run_until([&] { return !echo.ended.empty(); }));
}

TEST_F(AnswersTest, KeepsABoundedSumOfAnswersInMemory) {
    listen({.answer_bytes = 24UL * 1024 * 1024});
    echo.body = std::string(16UL * 1024 * 1024, 'x');
    const Peer silent(server->port());
    std::string request = "GET /large HTTP/1.1\r\n" + host() + "\r\n";
    ASSERT_TRUE(run_until([&] { return silent.write(request) && request.empty(); }));
    ASSERT_TRUE(run_until([&] { return !echo.asked.empty(); }));
    EXPECT_EQ(status_of(get("/large")), "HTTP/1.1 503 Service Unavailable");
    echo.body = "small";
    EXPECT_EQ(status_of(get("/small")), "HTTP/1.1 200 OK") << "small answers are sent in any case";
}

TEST_F(AnswersTest, CancelsAnAnswerInPiecesWhenItsClientHangsUp) {
    listen({.check_time = milliseconds(5)});
    echo.pieces = std::make_shared<PieceQueue>();
    auto peer = std::make_unique<Peer>(server->port());
    write(*peer, "GET /api/times HTTP/1.1\r\n" + host() + "\r\n");
    ASSERT_TRUE(run_until([&] { return !echo.asked.empty(); }));
    EXPECT_FALSE(echo.pieces->isCancelled());
    peer.reset();
    EXPECT_TRUE(run_until([&] { return echo.pieces->isCancelled(); })) << "though nothing was to be sent";
}

}  // namespace
}  // namespace mw::screen::test
