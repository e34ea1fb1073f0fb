// SPDX-License-Identifier: GPL-2.0-or-later
// The memory spaces of LBP16 other than the HostMot2 registers: plain memory with an information area.
// Source: shared/hardware.md, part A1.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa::board {

/// The information area of a space, and the size of the space.
struct SpaceFacts {
    std::uint16_t cookie = 0;  ///< 0: the space does not exist
    std::uint16_t size_word = 0, ranges_word = 0;
    std::string_view name;
    std::uint32_t bytes = 0;

    bool isWritable() const { return (size_word & 0x8000U) != 0; }
    /// True if the space can be read in units of that size.
    bool permits(lbp16::Unit unit) const { return (size_word & lbp16::bytes_of(unit)) != 0; }
};

SpaceFacts facts_of(lbp16::Space space, std::uint8_t flash_id);
/// The 16 bytes of the information area.
std::vector<std::byte> information_of(const SpaceFacts &facts, std::uint16_t pointer);

/// The addresses of space 6.
enum class ControlAddress : std::uint8_t {
    ERRORS = 0,
    PARSE_ERRORS = 2,
    MEMORY_ERRORS = 4,
    WRITE_ERRORS = 6,
    RECEIVED_PACKETS = 8,
    RECEIVED_UDP = 0xA,
    RECEIVED_BAD = 0xC,
    SENT_PACKETS = 0xE,
    SENT_UDP = 0x10,
    SENT_BAD = 0x12,
    WRITE_KEY = 0x1A,
    RESET = 0x1C,
    RELOAD = 0x1E,
};

/// The error bits of space 6.
enum class ErrorBit : std::uint8_t { PARSE = 1, MEMORY = 2, WRITE = 4, RECEIVED_BAD = 8, SENT_BAD = 0x10 };

/// A number of 16 bits in a memory; `address` is even.
std::uint16_t word_at(const std::vector<std::byte> &memory, std::size_t address);
void set_word(std::vector<std::byte> &memory, std::size_t address, std::uint16_t value);

/// The EEPROM as delivered: MAC address, name of the card, IP address 192.168.1.121.
std::vector<std::byte> factory_eeprom(const Model &model);
/// Space 7: name of the card, versions, jumpers (1: IP address from the EEPROM).
std::vector<std::byte> board_information(const Model &model);

/// The flash memory of the FPGA with its address register. Registers: 0 address, 4 data, 8 id, 0xC erase.
class Flash {
  public:
    explicit Flash(std::uint8_t id);
    /// Reading data increments the address by 4.
    std::uint32_t read(std::uint16_t address);
    /// All except the address register is protected.
    static bool isProtected(std::uint16_t address) { return address != 0; }
    /// Writing data clears bits, as flash does.
    void write(std::uint16_t address, std::uint32_t value);

  private:
    std::uint8_t id_;
    std::uint32_t address_ = 0;
    std::vector<std::byte> memory_;
};

}  // namespace mw::mesa::board
