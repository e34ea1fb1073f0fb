// SPDX-License-Identifier: GPL-2.0-or-later
// Sockets whose every wait has an end.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/result.hh"
#include "clients/nml/buffer/shared_lock.hh"
#include "clients/nml/net/protocol.hh"

namespace mw::nml {

/// Owns a descriptor. Non-blocking inside.
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
    /// Wakes a thread that waits for it.
    void shut_down() const;

    Result<> send(std::string_view bytes, const Deadline &deadline) const;
    /// Exactly `size` bytes. False: the other side has closed it before the first of them.
    Result<bool> receive(char *bytes, std::size_t size, const Deadline &deadline) const;
    /// The bytes of one datagram, 0 when the time is over.
    Result<std::size_t> receive_datagram(char *bytes, std::size_t size, const Deadline &deadline) const;
    /// The other side is gone.
    bool isHungUp() const;

    Result<> send_packet(const Packet &packet, const Deadline &deadline) const;
    /// False: the other side has closed it. The first byte is waited for until `idle` ends, the others until
    /// `deadline` seconds after it; a packet has at most `longest` bytes.
    Result<bool> receive_packet(Packet &packet, const Deadline &idle, Timeout within,
                                std::size_t longest) const;

  private:
    int fd_ = -1;
};

enum class Transport : std::uint8_t { TCP, UDP };

/// A host by name or address. Errors name it.
Result<Socket> connect_to(const std::string &host, int port, Transport transport, const Deadline &deadline);
/// Only this address of this computer is listened at. Port 0: any; `port` becomes the one that was given.
Result<Socket> listen_at(const std::string &host, int &port, Transport transport);

}  // namespace mw::nml
