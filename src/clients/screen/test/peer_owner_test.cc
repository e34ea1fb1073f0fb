// SPDX-License-Identifier: GPL-2.0-or-later
// Tests which user has opened a connection on this computer (issue 37).
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "clients/screen/access/peer_owner.hh"

namespace mw::screen {
namespace {

constexpr std::uint32_t HERE = INADDR_LOOPBACK, USER = 1000;
constexpr Endpoint CLIENT{HERE, 40000}, SERVER{HERE, 8850};
constexpr SocketFacts OWN{CLIENT, SERVER, TCP_ESTABLISHED, 7, USER};

PeerOwner owner(const SocketFacts &socket, std::uint32_t server_uid = USER) {
    return owner_of(socket, CLIENT, SERVER, server_uid);
}

TEST(PeerOwner, IsTheServersUserOrRootAndNobodyElse) {
    EXPECT_EQ(owner(OWN), PeerOwner::SERVER_USER);
    SocketFacts socket = OWN;
    socket.uid = 0;
    EXPECT_EQ(owner(socket), PeerOwner::SERVER_USER) << "root may do everything anyway";
    for (const std::uint32_t uid : {1U, 999U, 1001U, OVERFLOW_UID, ~0U}) {
        socket.uid = uid;
        EXPECT_EQ(owner(socket), PeerOwner::OTHER) << uid;
        EXPECT_EQ(owner(socket, 0), PeerOwner::OTHER) << uid << " at a server of root";
    }
    socket.uid = OVERFLOW_UID;
    EXPECT_EQ(owner(socket, OVERFLOW_UID), PeerOwner::OTHER) << "a user that this namespace does not have";
}

TEST(PeerOwner, NeedsAnOpenEstablishedSocketOfThisConnection) {
    for (const std::uint32_t uid : {0U, USER}) {
        for (std::uint8_t state = 0; state <= TCP_CLOSING; ++state) {
            SocketFacts socket = OWN;
            socket.uid = uid;
            socket.state = state;
            EXPECT_EQ(owner(socket) == PeerOwner::SERVER_USER, state == TCP_ESTABLISHED) << int{state};
        }
        SocketFacts socket = OWN;
        socket.uid = uid;
        socket.inode = 0;
        EXPECT_EQ(owner(socket), PeerOwner::OTHER)
            << "the kernel reports user 0 for sockets that no process has open";
        for (Endpoint SocketFacts::*const end : {&SocketFacts::own, &SocketFacts::peer}) {
            socket = OWN;
            socket.uid = uid;
            ++(socket.*end).port;
            EXPECT_EQ(owner(socket), PeerOwner::OTHER);
            socket = OWN;
            socket.uid = uid;
            ++(socket.*end).address;
            EXPECT_EQ(owner(socket), PeerOwner::OTHER);
        }
    }
}

/// A listening socket of the loopback and a client of it.
class PeerOwnerOfASocket : public testing::Test {
  protected:
    static Endpoint end_of(int fd, bool is_own) {
        sockaddr_in place{};
        socklen_t size = sizeof place;
        auto *const bytes = reinterpret_cast<sockaddr *>(&place);
        EXPECT_EQ(is_own ? ::getsockname(fd, bytes, &size) : ::getpeername(fd, bytes, &size), 0);
        return {ntohl(place.sin_addr.s_addr), ntohs(place.sin_port)};
    }
    PeerOwnerOfASocket() {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(listener, reinterpret_cast<sockaddr *>(&place), sizeof place), 0);
        EXPECT_EQ(::listen(listener, 4), 0);
    }
    ~PeerOwnerOfASocket() override { ::close(listener); }
    /// Connects; -1 on failure.
    int connect() const {
        const Endpoint server = end_of(listener, true);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(server.address);
        place.sin_port = htons(server.port);
        const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        return ::connect(fd, reinterpret_cast<sockaddr *>(&place), sizeof place) == 0 ? fd : -1;
    }
    int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    SocketFinder find_socket;
};

TEST_F(PeerOwnerOfASocket, IsFoundByTheKernelWhileItIsOpen) {
    const int client = connect();
    const int accepted = ::accept(listener, nullptr, nullptr);
    const Endpoint own = end_of(accepted, false), server = end_of(accepted, true);
    auto found = find_socket(own, server);
    ASSERT_TRUE(found.has_value()) << found.error().str();
    EXPECT_EQ(found->uid, ::geteuid());
    EXPECT_EQ(owner_of(*found, own, server, ::geteuid()), PeerOwner::SERVER_USER);
    ::shutdown(client, SHUT_WR);
    found = find_socket(own, server);
    EXPECT_TRUE(!found.has_value() || owner_of(*found, own, server, ::geteuid()) == PeerOwner::OTHER);
    ::close(client);
    found = find_socket(own, server);
    EXPECT_TRUE(!found.has_value() || owner_of(*found, own, server, ::geteuid()) == PeerOwner::OTHER);
    EXPECT_FALSE(find_socket({HERE, 1}, {HERE, 2}).has_value());
    ::close(accepted);
}

TEST_F(PeerOwnerOfASocket, IsFoundWithoutAFreeDescriptor) {
    const int client = connect();
    const int accepted = ::accept(listener, nullptr, nullptr);
    const Endpoint own = end_of(accepted, false), server = end_of(accepted, true);
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &old), 0);
    const rlimit none{3, old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const auto found = find_socket(own, server);
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &old), 0);
    ASSERT_TRUE(found.has_value()) << found.error().str();
    EXPECT_EQ(owner_of(*found, own, server, ::geteuid()), PeerOwner::SERVER_USER);
    ::close(client);
    ::close(accepted);
}

TEST_F(PeerOwnerOfASocket, OfAnotherUserIsNotTheServersUser) {
    if (::geteuid() != 0) {
        GTEST_SKIP() << "only root may act as another user";
    }
    constexpr uid_t NOBODY = 65534;
    const pid_t child = ::fork();
    if (child == 0) {
        const bool other = ::setgid(NOBODY) == 0 && ::setuid(NOBODY) == 0;
        const int fd = other ? connect() : -1;
        char byte = 0;
        ::_exit(fd >= 0 && ::read(fd, &byte, 1) == 1 ? 0 : 1);
    }
    const int accepted = ::accept(listener, nullptr, nullptr);
    const Endpoint own = end_of(accepted, false), server = end_of(accepted, true);
    const auto found = find_socket(own, server);
    EXPECT_EQ(::write(accepted, "x", 1), 1);
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    ASSERT_TRUE(found.has_value()) << found.error().str();
    EXPECT_EQ(found->uid, NOBODY);
    EXPECT_EQ(owner_of(*found, own, server, ::geteuid()), PeerOwner::OTHER);
    ::close(accepted);
}

}  // namespace
}  // namespace mw::screen
