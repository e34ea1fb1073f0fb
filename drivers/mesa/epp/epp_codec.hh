// SPDX-License-Identifier: GPL-2.0-or-later
// The access to the registers of a board over a parallel port in EPP mode. Sources: shared/hardware.md, part
// C1; the bytes are those that LinuxCNC's hm2_7i90 and hm2_7i43 send.
#pragma once

#include <array>
#include <cstdint>

namespace mw::mesa::epp {

/// Offsets from the address of the port.
enum class Register : std::uint8_t { DATA = 0, STATUS = 1, CONTROL = 2, EPP_ADDRESS = 3, EPP_DATA = 4 };

/// Bit of the status register: the board has not answered an EPP access in time.
constexpr std::uint8_t TIMEOUT = 1;
/// The control register: all lines inactive, data are outputs.
constexpr std::uint8_t CONTROL_IDLE = 4;
/// The ECP control register (offset 2 from its base): EPP mode, no interrupts and no DMA.
constexpr std::uint8_t ECR_EPP = 0x94;
/// The high byte of an address with this bit: the board increments the address with each byte.
constexpr std::uint8_t AUTO_INCREMENT = 0x80;

/// The two address bytes, in their order. A data access ends an address, so the next address byte is a low
/// byte.
constexpr std::array<std::uint8_t, 2> address_bytes(std::uint16_t address) noexcept {
    return {static_cast<std::uint8_t>(address & 0xFFU),
            static_cast<std::uint8_t>((address >> 8U) | AUTO_INCREMENT)};
}

/// The data bytes of a register, in their order.
constexpr std::array<std::uint8_t, 4> data_bytes(std::uint32_t value) noexcept {
    return {static_cast<std::uint8_t>(value & 0xFFU), static_cast<std::uint8_t>((value >> 8U) & 0xFFU),
            static_cast<std::uint8_t>((value >> 16U) & 0xFFU), static_cast<std::uint8_t>(value >> 24U)};
}

constexpr std::uint32_t word_of(const std::array<std::uint8_t, 4> &bytes) noexcept {
    return bytes[0] | (std::uint32_t{bytes[1]} << 8U) | (std::uint32_t{bytes[2]} << 16U) |
           (std::uint32_t{bytes[3]} << 24U);
}

}  // namespace mw::mesa::epp
