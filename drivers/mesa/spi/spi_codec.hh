// SPDX-License-Identifier: GPL-2.0-or-later
// The frames of Mesa boards on SPI: a command word and its data words, all 32 bits, the highest bit first.
// Several of them follow each other in one transfer. Sources: shared/hardware.md, part C1; the words are
// those that LinuxCNC's hm2_spi sends.
#pragma once

#include <cstdint>
#include <span>

namespace mw::mesa::spi {

enum class Access : std::uint8_t { READ = 0xA, WRITE = 0xB };

/// Data words of one command.
constexpr int MOST_IN_COMMAND = 127;
/// SPI mode 0; the clock is idle low and data are valid at its rising edge.
constexpr std::uint8_t SPI_MODE = 0;

/// The command for `count` (1 to MOST_IN_COMMAND) consecutive registers: bits 31 to 16 address, 15 to 12
/// access, 11 increment of the address, 10 to 4 count.
constexpr std::uint32_t command_word(Access access, std::uint16_t address, int count) noexcept {
    constexpr std::uint32_t COUNTS_ON = 1U << 11U;
    return (std::uint32_t{address} << 16U) | (static_cast<std::uint32_t>(access) << 12U) | COUNTS_ON |
           (static_cast<std::uint32_t>(count) << 4U);
}

/// The words of a transfer that reads or writes `registers` at consecutive addresses, with the commands.
constexpr std::size_t transfer_words(std::size_t registers) noexcept {
    return registers + (registers + MOST_IN_COMMAND - 1) / MOST_IN_COMMAND;
}

/// Converts words for a controller that transfers only bytes, highest byte first. The same for both
/// directions.
inline void swap_bytes(std::span<std::uint32_t> words) noexcept {
    for (std::uint32_t &word : words) {
        word = __builtin_bswap32(word);
    }
}

}  // namespace mw::mesa::spi
