// SPDX-License-Identifier: GPL-2.0-or-later
// Packets by UDP to one board.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hh"
#include "drivers/mesa/lbp16/packet.hh"
#include "drivers/mesa/lbp16/transport.hh"

namespace mw::mesa::lbp16 {

/// A socket that is connected to one board, so that packets of other hosts are not received.
class UdpTransport final : public Transport {
  public:
    /// `address` in numbers, such as 192.168.1.121. An error names the address. [while loading]
    static Result<std::unique_ptr<UdpTransport>> open(const std::string &address,
                                                      std::uint16_t port = BOARD_PORT);
    ~UdpTransport() override;
    UdpTransport(const UdpTransport &) = delete;
    UdpTransport &operator=(const UdpTransport &) = delete;

    TransportResult send(std::span<const std::byte> packet) noexcept override;
    TransportResult receive(std::span<std::byte> packet) noexcept override;
    void wait_until(std::int64_t deadline_ns) noexcept override;
    std::int64_t now_ns() const noexcept override;

  private:
    explicit UdpTransport(int socket) noexcept : socket_(socket) {}

    int socket_;
};

}  // namespace mw::mesa::lbp16
