// SPDX-License-Identifier: GPL-2.0-or-later
// Connects a host in the same process to a simulated board, in virtual time.
#pragma once

#include "drivers/mesa/board/link.hh"
#include "drivers/mesa/lbp16/transport.hh"

namespace mw::mesa::board {

/// The time advances only by wait_until() and sleep_until(). For tests: it allocates, so it does not fit a
/// realtime thread. [one thread]
class BoardTransport final : public lbp16::Transport {
  public:
    /// `link` must outlive the transport.
    explicit BoardTransport(Link &link) : link_(link) {}

    lbp16::TransportResult send(std::span<const std::byte> packet) noexcept override;
    lbp16::TransportResult receive(std::span<std::byte> packet) noexcept override;
    /// Advances to the next arrival of a packet or other event, at most to the deadline.
    void wait_until(std::int64_t deadline_ns) noexcept override;
    std::int64_t now_ns() const noexcept override { return now_ns_; }

    /// Advances to `time_ns`, such as the beginning of the next cycle.
    void sleep_until(std::int64_t time_ns);

  private:
    Link &link_;
    std::int64_t now_ns_ = 0;
};

}  // namespace mw::mesa::board
