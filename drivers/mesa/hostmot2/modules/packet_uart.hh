// SPDX-License-Identifier: GPL-2.0-or-later
// Packet UARTs of a board: frames of bytes with pauses between them, such as those of Modbus. The driver
// moves frames with the packets of its cycle, as with UARTs; a received frame takes three cycles and one for
// each 32 bytes. Registers: Mesa's register map. Only the thread of the board may call the functions, except
// setup().
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/mesa/hostmot2/modules/byte_queue.hh"

namespace mw::mesa {

constexpr std::size_t PACKET_RX_SLOTS = 8, PACKET_TX_WORDS = 16, MAX_FRAMES = 16, MAX_FRAME_BYTES = 1023;

/// Fields of the mode registers.
namespace packet_uart_bit {
constexpr std::uint32_t CLEAR = 0x80010000, HAS_DATA = 1U << 21U, FRAMES = 0x1FU << 16U;
}  // namespace packet_uart_bit

class PacketUart {
  public:
    /// Register values requested by setup().
    struct Settings {
        std::uint32_t bitrate = 0;
        std::int32_t tx_mode = -1, rx_mode = -1;  ///< negative: unchanged
        bool tx_cleared = false, rx_cleared = false;
    };
    void setup(const Settings &settings) noexcept;
    /// Queues a frame; false: it is empty or too long, or the queue is full.
    bool send(std::span<const std::uint8_t> frame) noexcept;

    /// The sizes of received frames, the oldest first.
    std::span<const std::uint16_t> frame_sizes() const noexcept { return {sizes_.data(), frames_}; }
    /// Removes bytes of received frames, at most up to the end of the oldest frame. The rest of a partly read
    /// frame remains.
    std::size_t receive(std::span<std::uint8_t> bytes) noexcept;

    /// The last read mode registers, with the frames stored in the driver.
    std::uint32_t rx_status() const noexcept;
    std::uint32_t tx_status() const noexcept { return tx_mode_; }
    /// Frames lost to failed packets and errors on the line.
    std::uint32_t failures() const noexcept { return failures_; }

    /// Empties all FIFOs and queues.
    void reset() noexcept;
    /// Clock of the bit rate from the firmware [Hz].
    std::uint32_t clock_hz() const noexcept { return clock_hz_; }
    int version() const noexcept { return version_; }

    /// --- for the module of the board
    void describe(std::uint32_t clock_hz, int version) noexcept {
        clock_hz_ = clock_hz;
        version_ = version;
    }
    bool take_reset() noexcept;
    bool take_settings(Settings &settings) noexcept;
    void show_modes(std::uint32_t tx_mode, std::uint32_t rx_mode) noexcept;
    /// The next frame to send; 0 bytes if there is none. It must fit.
    std::size_t next_frame(std::span<std::uint8_t> bytes) noexcept;
    bool hasSpace() const noexcept;
    void begin_frame(std::size_t size) noexcept;
    void take(std::span<const std::uint8_t> bytes) noexcept;
    std::size_t missing() const noexcept { return missing_; }
    /// Discards the frame that is being received.
    void drop_frame() noexcept;
    void count_failure() noexcept { ++failures_; }

  private:
    static constexpr std::size_t QUEUE_BYTES = 4096;

    Settings settings_;
    bool setup_due_ = false, reset_due_ = false;
    std::uint32_t clock_hz_ = 0;
    int version_ = 0;
    ByteQueue<QUEUE_BYTES> queued_, received_;
    std::array<std::uint8_t, MAX_FRAME_BYTES + 1> frame_{};  ///< being received
    std::size_t size_ = 0, missing_ = 0;
    std::array<std::uint16_t, MAX_FRAMES> sizes_{};
    std::size_t frames_ = 0;
    std::uint32_t tx_mode_ = 0, rx_mode_ = 0, failures_ = 0;
};

}  // namespace mw::mesa
