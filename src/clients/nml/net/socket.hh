// SPDX-License-Identifier: GPL-2.0-or-later
// Sockets on which every wait has a time limit.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/result.hh"
#include "clients/nml/buffer/shared_lock.hh"
#include "clients/nml/net/protocol.hh"

namespace mw::nml {

/// Owns a descriptor, which is non-blocking.
class Socket {
  public:
    Socket() = default;
    explicit Socket(int fd) : fd_(fd) {}
    Socket(Socket &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Socket &operator=(Socket &&other) noexcept;
    ~Socket() { close(); }

    int fd() const { return fd_; }
    bool isOpen() const { return fd_ >= 0; }
    void close();
    /// Wakes a thread that waits on the socket.
    void shut_down() const;

    Result<> send(std::string_view bytes, const Deadline &deadline) const;
    /// Receives exactly `size` bytes. False: the peer has closed the connection before the first byte.
    Result<bool> receive(char *bytes, std::size_t size, const Deadline &deadline) const;
    /// Size of one datagram; 0 after the timeout.
    Result<std::size_t> receive_datagram(char *bytes, std::size_t size, const Deadline &deadline) const;
    /// True if the peer has disconnected.
    bool isHungUp() const;

    Result<> send_packet(const Packet &packet, const Deadline &deadline) const;
    /// False: the peer has closed the connection. Waits for the first byte until `idle` ends, for the others
    /// until `deadline` seconds after it; a packet has at most `longest` bytes.
    Result<bool> receive_packet(Packet &packet, const Deadline &idle, Timeout within,
                                std::size_t longest) const;

  private:
    int fd_ = -1;
};

enum class Transport : std::uint8_t { TCP, UDP };

/// Connects to a host by name or address. Errors contain the host.
Result<Socket> connect_to(const std::string &host, int port, Transport transport, const Deadline &deadline);
/// Listens only at this address of this computer. Port 0: any port; `port` becomes the assigned port.
Result<Socket> listen_at(const std::string &host, int &port, Transport transport);

}  // namespace mw::nml
