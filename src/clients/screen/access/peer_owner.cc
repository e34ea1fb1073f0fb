// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/access/peer_owner.hh"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace mw::screen {
namespace {

struct Query {
    nlmsghdr head{};
    inet_diag_req_v2 asked{};
};

std::unexpected<Error> failed(const char *what, int error) {
    return fail(std::string(what) + ": " + std::strerror(error));
}

Query query_of(const Endpoint &client, const Endpoint &server, std::uint32_t number) {
    Query query;
    query.head.nlmsg_len = sizeof query;
    query.head.nlmsg_type = SOCK_DIAG_BY_FAMILY;
    query.head.nlmsg_flags = NLM_F_REQUEST;
    query.head.nlmsg_seq = number;
    query.asked.sdiag_family = AF_INET;
    query.asked.sdiag_protocol = IPPROTO_TCP;
    query.asked.idiag_states = ~0U;
    query.asked.id.idiag_sport = htons(client.port);
    query.asked.id.idiag_dport = htons(server.port);
    query.asked.id.idiag_src[0] = htonl(client.address);
    query.asked.id.idiag_dst[0] = htonl(server.address);
    query.asked.id.idiag_cookie[0] = INET_DIAG_NOCOOKIE;
    query.asked.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
    return query;
}

/// An IPv4 address is the last word of an IPv6 socket's address (::ffff:127.0.0.1).
std::uint32_t address_of(const std::uint8_t family, const std::uint32_t (&words)[4]) {
    return ntohl(family == AF_INET ? words[0] : words[3]);
}

Result<SocketFacts> facts_of(const nlmsghdr &head) {
    if (head.nlmsg_type == NLMSG_ERROR && head.nlmsg_len >= NLMSG_LENGTH(sizeof(nlmsgerr))) {
        return failed("the kernel does not find the socket of the client",
                      -static_cast<const nlmsgerr *>(NLMSG_DATA(&head))->error);
    }
    if (head.nlmsg_type != SOCK_DIAG_BY_FAMILY || head.nlmsg_len < NLMSG_LENGTH(sizeof(inet_diag_msg))) {
        return fail("the answer of NETLINK_SOCK_DIAG is none of a socket");
    }
    const auto *const found = static_cast<const inet_diag_msg *>(NLMSG_DATA(&head));
    return SocketFacts{{address_of(found->idiag_family, found->id.idiag_src), ntohs(found->id.idiag_sport)},
                       {address_of(found->idiag_family, found->id.idiag_dst), ntohs(found->id.idiag_dport)},
                       found->idiag_state,
                       found->idiag_inode,
                       found->idiag_uid};
}

}  // namespace

/// A netlink socket that is closed by its destructor.
class SocketFinder::Netlink {
  public:
    Netlink()
        : fd_(::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC, NETLINK_SOCK_DIAG)),
          error_(fd_ < 0 ? errno : 0) {}
    ~Netlink() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }
    Netlink(const Netlink &) = delete;
    Netlink &operator=(const Netlink &) = delete;
    int fd() const { return fd_; }
    int error() const { return error_; }

  private:
    int fd_, error_;
};

SocketFinder::SocketFinder() : netlink_(std::make_shared<const Netlink>()) {}

Result<SocketFacts> SocketFinder::operator()(const Endpoint &client, const Endpoint &server) {
    const int fd = netlink_->fd();
    if (fd < 0) {
        return failed("no socket of NETLINK_SOCK_DIAG", netlink_->error());
    }
    const Query query = query_of(client, server, ++requests_);
    sockaddr_nl kernel{};
    kernel.nl_family = AF_NETLINK;
    if (::sendto(fd, &query, sizeof query, 0, reinterpret_cast<const sockaddr *>(&kernel), sizeof kernel) !=
        static_cast<ssize_t>(sizeof query)) {
        return failed("the kernel does not take a request of NETLINK_SOCK_DIAG", errno);
    }
    alignas(nlmsghdr) std::array<char, 4096> bytes{};
    const auto *const head = reinterpret_cast<const nlmsghdr *>(bytes.data());
    sockaddr_nl sender{};
    socklen_t size = sizeof sender;
    // The kernel answers within the call of sendto(), so there is no wait.
    const ssize_t got = ::recvfrom(fd, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr *>(&sender), &size);
    if (got < 0) {
        return failed("the kernel does not answer NETLINK_SOCK_DIAG", errno);
    }
    if (sender.nl_pid != 0 || !NLMSG_OK(head, static_cast<std::size_t>(got)) ||
        head->nlmsg_seq != requests_) {
        return fail("the answer of NETLINK_SOCK_DIAG is none of the kernel");
    }
    return facts_of(*head);
}

PeerOwner owner_of(const SocketFacts &socket, const Endpoint &client, const Endpoint &server,
                   std::uint32_t server_uid) {
    const bool its_socket =
        socket.own == client && socket.peer == server && socket.state == TCP_ESTABLISHED && socket.inode != 0;
    const bool trusted = socket.uid == 0 || (socket.uid == server_uid && socket.uid != OVERFLOW_UID);
    return its_socket && trusted ? PeerOwner::SERVER_USER : PeerOwner::OTHER;
}

}  // namespace mw::screen
