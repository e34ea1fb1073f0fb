// SPDX-License-Identifier: GPL-2.0-or-later
// Registers of serial absolute encoders: SSI, BISS and Fanuc. Registers: shared/hardware.md, part B10, and
// Mesa's register map.
#pragma once

#include <cstdint>

namespace mw::mesa {

/// The clocks of a firmware [Hz].
struct Clocks {
    std::uint32_t low_hz = 0, high_hz = 0;
};

/// Source that starts a transfer: a timer of the phase-locked loop (1 to 4), or with 0 the function
/// trigger-encoders.
std::uint32_t transfer_start(std::uint32_t timer) noexcept;

/// The control register of an SSI channel.
std::uint32_t ssi_control(double khz, int bits, std::uint32_t timer, const Clocks &clocks) noexcept;
/// The first control register of a BISS channel: rate, filter of a quarter of a bit, bits.
std::uint32_t biss_control(double khz, int bits, const Clocks &clocks) noexcept;
/// The second control register of a Fanuc channel: rate and filter (1 to 15 clocks).
std::uint32_t fanuc_control(double khz, std::uint32_t filter, const Clocks &clocks) noexcept;
/// The setup in the third data register of a Fanuc channel: bits, and a request of 8 us.
std::uint32_t fanuc_bits(int bits, const Clocks &clocks) noexcept;

}  // namespace mw::mesa
