// SPDX-License-Identifier: GPL-2.0-or-later
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include <gtest/gtest.h>

#include "drivers/mesa/lbp16/udp_transport.hh"

namespace mw::mesa::lbp16 {
namespace {

/// A UDP socket on a free port of the loopback interface, instead of a board.
struct Peer {
    int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};

    Peer() {
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr *>(&address), sizeof address), 0);
        socklen_t size = sizeof address;
        EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr *>(&address), &size), 0);
    }
    ~Peer() { ::close(socket); }
    std::uint16_t port() const { return ntohs(address.sin_port); }
};

TEST(UdpTransport, SendsAndReceivesWithoutWaiting) {
    Peer peer;
    auto opened = UdpTransport::open("127.0.0.1", peer.port());
    ASSERT_TRUE(opened.has_value()) << opened.error().str();
    UdpTransport &transport = **opened;
    std::array<std::byte, 16> answer{};
    EXPECT_EQ(transport.receive(answer).error, EAGAIN);
    const std::array<std::byte, 3> request{std::byte{1}, std::byte{2}, std::byte{3}};
    const TransportResult sent = transport.send(request);
    EXPECT_TRUE(sent.isDone());
    EXPECT_EQ(sent.bytes, 3U);
    sockaddr_in host{};
    socklen_t size = sizeof host;
    std::array<std::byte, 16> seen{};
    ASSERT_EQ(
        ::recvfrom(peer.socket, seen.data(), seen.size(), 0, reinterpret_cast<sockaddr *>(&host), &size), 3);
    ASSERT_EQ(::sendto(peer.socket, seen.data(), 2, 0, reinterpret_cast<sockaddr *>(&host), size), 2);
    transport.wait_until(transport.now_ns() + 5'000'000'000);
    const TransportResult received = transport.receive(answer);
    EXPECT_TRUE(received.isDone());
    EXPECT_EQ(received.bytes, 2U);
    EXPECT_EQ(answer[1], std::byte{2});
}

TEST(UdpTransport, ABoardThatIsAwayIsAnErrorAndNoWait) {
    std::uint16_t port = 0;
    {
        const Peer peer;
        port = peer.port();
    }
    auto opened = UdpTransport::open("127.0.0.1", port);
    ASSERT_TRUE(opened.has_value());
    const std::array<std::byte, 1> request{};
    EXPECT_TRUE((*opened)->send(request).isDone());
    (*opened)->wait_until((*opened)->now_ns() + 5'000'000'000);
    std::array<std::byte, 16> answer{};
    EXPECT_EQ((*opened)->receive(answer).error, ECONNREFUSED);
}

TEST(UdpTransport, AnAddressThatIsNoneIsNamed) {
    const auto opened = UdpTransport::open("192.168.1");
    ASSERT_FALSE(opened.has_value());
    EXPECT_NE(opened.error().str().find("'192.168.1'"), std::string::npos);
}

}  // namespace
}  // namespace mw::mesa::lbp16
