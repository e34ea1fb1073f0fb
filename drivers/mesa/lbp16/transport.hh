// SPDX-License-Identifier: GPL-2.0-or-later
// Transfer of packets to the board: UDP, a board in memory, or a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mw::mesa::lbp16 {

/// Result of one attempt to send or receive.
struct TransportResult {
    std::size_t bytes = 0;     ///< bytes sent or received; 0 with `error`
    int error = 0;             ///< errno; EAGAIN: nothing has arrived yet
    std::int64_t time_ns = 0;  ///< monotonic time of the operation

    bool isDone() const noexcept { return error == 0; }
};

/// Sends and receives whole packets and never waits. [servo thread; no allocation, no lock]
class Transport {
  public:
    virtual ~Transport() = default;

    virtual TransportResult send(std::span<const std::byte> packet) noexcept = 0;
    /// The next packet that has arrived, cut to the size of `packet`; EAGAIN if there is none.
    virtual TransportResult receive(std::span<std::byte> packet) noexcept = 0;
    /// Sleeps until a packet may have arrived, or until `deadline_ns` (monotonic). It may
    /// return early. In virtual time it returns at once.
    virtual void wait_until(std::int64_t deadline_ns) noexcept = 0;
    /// Monotonic time, real or virtual [ns].
    virtual std::int64_t now_ns() const noexcept = 0;
};

}  // namespace mw::mesa::lbp16
