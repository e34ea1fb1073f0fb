// SPDX-License-Identifier: GPL-2.0-or-later
// An SPI bus with one board.
#pragma once

#include <cstdint>
#include <span>

namespace mw::mesa::spi {

/// Selects the clock of a transfer.
enum class Direction : std::uint8_t { READS, WRITES };

class Device {
  public:
    virtual ~Device() = default;
    /// Sends the words and replaces them by the received words; returns 0, or the errno.
    virtual int transfer(std::span<std::uint32_t> words, Direction direction) noexcept = 0;
};

}  // namespace mw::mesa::spi
