// SPDX-License-Identifier: GPL-2.0-or-later
// UARTs of a board. A component sends and receives bytes; the driver moves them with the packets of its
// cycle: it reads the number of received bytes, and in the next cycle this number of bytes. No packet is
// added. Registers: Mesa's register map. Only the thread of the board may call the functions, except setup().
#pragma once

#include <cstdint>
#include <span>

#include "drivers/mesa/hostmot2/modules/byte_queue.hh"

namespace mw::mesa {

constexpr std::size_t UART_TX_WORDS = 16, UART_RX_SLOTS = 4;

/// The bit rate register with `bits` bits for `bitrate` [bit/s], limited to its range.
std::uint32_t uart_rate(std::uint32_t bitrate, std::uint32_t clock_hz, int bits) noexcept;

class Uart {
  public:
    /// Register values requested by setup().
    struct Settings {
        std::uint32_t bitrate = 0;
        std::int32_t tx_mode = -1, rx_mode = -1;  ///< negative: unchanged
    };
    /// Applies settings with the next write. [any time]
    void setup(const Settings &settings) noexcept;
    /// Queues all bytes, or none when the queue is full. Returns the number of queued bytes.
    std::size_t send(std::span<const std::uint8_t> bytes) noexcept;
    /// Removes received bytes; returns their number.
    std::size_t receive(std::span<std::uint8_t> bytes) noexcept { return received_.pop(bytes); }

    /// --- for the module of the board
    bool take_settings(Settings &settings) noexcept;
    /// The next bytes to send, at most four.
    std::size_t next(std::span<std::uint8_t, 4> bytes) noexcept { return queued_.pop(bytes); }
    bool hasQueued() const noexcept { return queued_.size() > 0; }
    /// Number of bytes that may be read from the board in the next cycle, of the `available` ones.
    std::size_t wanted(std::size_t available) const noexcept;
    void take(std::span<const std::uint8_t> bytes) noexcept { (void)received_.push(bytes); }

  private:
    static constexpr std::size_t QUEUE_BYTES = 1024;

    Settings settings_;
    bool setup_due_ = false;
    ByteQueue<QUEUE_BYTES> queued_, received_;
};

}  // namespace mw::mesa
