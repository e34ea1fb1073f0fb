// SPDX-License-Identifier: GPL-2.0-or-later
// UARTs with FIFOs of bytes, and packet UARTs with FIFOs of frames. Sources: shared/hardware.md, part B10;
// the order of the registers is derived from LinuxCNC's mesa_uart and PktUART components. Parity and the idle
// times between frames have no effect.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"
#include "drivers/mesa/board/modules/serial_line.hh"

namespace mw::mesa::board {

/// The direction of a module: transmitter and receiver are two modules with one line for each instance.
enum class UartRole : std::uint8_t { TRANSMIT, RECEIVE };

/// Registers: data (four words: an access of word n has n + 1 bytes, the first one lowest), count in the FIFO
/// (a write empties it), bit rate, mode.
class UartModule final : public Module {
  public:
    UartModule(UartRole role, std::shared_ptr<SerialLines> lines, std::uint32_t clock_hz)
        : role_(role), lines_(std::move(lines)), ports_(lines_->size()), clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    unsigned registers() const override { return 4; }
    unsigned words(unsigned reg) const override { return reg == 0 ? 4 : 1; }

  private:
    struct Port {
        std::uint32_t rate = 0, mode = 0;
        std::deque<std::uint8_t> received;
    };
    /// Moves received bytes into the FIFO; bytes that do not fit are lost.
    void take(unsigned instance);

    UartRole role_;
    std::shared_ptr<SerialLines> lines_;
    std::vector<Port> ports_;
    std::uint32_t clock_hz_;
    std::int64_t time_ns_ = 0;
};

/// Registers: data (words of four bytes, the first one lowest), frame sizes (transmit: a write sends a frame
/// of this size; receive: a read returns the size of the next frame), bit rate, mode. Bits 20 to 16 of the
/// mode read the number of waiting frames; a write with bits 31 and 16 empties the FIFOs.
class PacketUartModule final : public Module {
  public:
    PacketUartModule(UartRole role, std::shared_ptr<SerialLines> lines, std::uint32_t clock_hz)
        : role_(role), lines_(std::move(lines)), ports_(lines_->size()), clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    unsigned registers() const override { return 4; }

  private:
    struct Port {
        std::uint32_t rate = 0, mode = 0;
        std::deque<std::uint32_t> words;  ///< written and not sent, or received and not read
        std::deque<std::uint32_t> sizes;  ///< sizes of the received frames
    };
    void take(unsigned instance);
    void send_frame(unsigned instance, std::uint32_t bytes);

    UartRole role_;
    std::shared_ptr<SerialLines> lines_;
    std::vector<Port> ports_;
    std::uint32_t clock_hz_;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board
