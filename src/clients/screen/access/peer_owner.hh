// SPDX-License-Identifier: GPL-2.0-or-later
// Finds out which user of this computer has opened a connection, from the kernel's data about the other end.
#pragma once

#include <cstdint>
#include <memory>

#include "base/result.hh"

namespace mw::screen {

/// IPv4 address and port, in host byte order.
struct Endpoint {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    bool operator==(const Endpoint &) const = default;
};

/// A TCP socket as the kernel reports it.
struct SocketFacts {
    Endpoint own, peer;
    std::uint8_t state = 0;   ///< TCP_ESTABLISHED and others of netinet/tcp.h
    std::uint32_t inode = 0;  ///< 0: no process has it open; `uid` is then without meaning
    std::uint32_t uid = 0;    ///< id of the user that created it
};

enum class PeerOwner : std::uint8_t {
    SERVER_USER,  ///< the user of the server, or root
    OTHER
};

/// Asks the kernel through NETLINK_SOCK_DIAG. Opens its descriptor only once, so a process without a free
/// descriptor can ask, too. All calls come from one thread.
class SocketFinder {
  public:
    SocketFinder();
    /// The socket at `client` of a connection to `server`. An error states why the kernel does not report it,
    /// or that there is no such socket in this network namespace.
    Result<SocketFacts> operator()(const Endpoint &client, const Endpoint &server);

  private:
    class Netlink;
    std::shared_ptr<const Netlink> netlink_;
    std::uint32_t requests_ = 0;
};

/// SERVER_USER only for an established socket with these ends that a process of `server_uid` or root has
/// open. The kernel reports user 0 for sockets that no process has open, and OVERFLOW_UID for users that this
/// user namespace does not have.
PeerOwner owner_of(const SocketFacts &socket, const Endpoint &client, const Endpoint &server,
                   std::uint32_t server_uid);

inline constexpr std::uint32_t OVERFLOW_UID = 65534;

}  // namespace mw::screen
