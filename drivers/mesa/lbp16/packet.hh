// SPDX-License-Identifier: GPL-2.0-or-later
// LBP16, the protocol of Mesa's Ethernet boards: one UDP packet contains a list of commands, which the board
// executes in order. The answer contains the data of all reads without gaps. All numbers are little-endian.
// Source: shared/hardware.md, part A1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>

namespace mw::mesa::lbp16 {

/// The UDP port of every board.
constexpr std::uint16_t BOARD_PORT = 27181;
/// The largest packet that a driver sends or a board answers [bytes]; it fits one Ethernet frame.
constexpr std::size_t MAX_PACKET_BYTES = 1400;
/// The maximum number of units of one command.
constexpr int MAX_UNITS = 127;

/// The memory spaces of a board.
enum class Space : std::uint8_t {
    HOSTMOT2 = 0,       ///< registers of the firmware, 32 bit
    ETHERNET_CHIP = 1,  ///< 16 bit
    EEPROM = 2,         ///< MAC address, name of the card, IP address; 16 bit
    FLASH = 3,          ///< 32 bit
    TIMERS = 4,         ///< time stamp and words that the host may use; 16 bit
    UNUSED = 5,
    CONTROL = 6,  ///< errors, counters, reset; 16 bit
    BOARD = 7,    ///< name of the card, versions, jumpers; 16 bit
};

/// The size of a unit, as a power of two of bytes: its code in the command word.
enum class Unit : std::uint8_t { BITS_8 = 0, BITS_16 = 1, BITS_32 = 2, BITS_64 = 3 };

constexpr std::size_t bytes_of(Unit unit) noexcept {
    return std::size_t{1} << static_cast<unsigned>(unit);
}

/// One command without its data.
struct Command {
    bool writes = false;       ///< false: the command reads
    bool addressed = true;     ///< false: begins at the stored pointer of the space
    bool information = false;  ///< accesses the information area of the space
    bool incrementing = true;  ///< the address increments after each unit
    Space space = Space::HOSTMOT2;
    Unit unit = Unit::BITS_32;
    std::uint8_t units = 1;     ///< 0 to 127; 0 is an error of the packet
    std::uint16_t address = 0;  ///< [bytes]; 0 without `addressed`

    std::size_t data_bytes() const noexcept { return units * bytes_of(unit); }
    bool operator==(const Command &) const = default;
};

std::uint16_t command_word(const Command &command) noexcept;
/// The command of a word; its address is 0.
Command command_of(std::uint16_t word) noexcept;

/// A packet that a host composes. A command that does not fit is omitted and makes the packet permanently
/// full, so the packet is always a prefix of the requested list. [any thread; no allocation]
class PacketWriter {
  public:
    /// `limit` [bytes], at most MAX_PACKET_BYTES.
    explicit PacketWriter(std::size_t limit = MAX_PACKET_BYTES) noexcept;

    /// Appends a read; false if it or its answer does not fit.
    bool read(const Command &command) noexcept;
    /// Appends a write of data.size() bytes, which is command.data_bytes(); false if it does not fit.
    bool write(const Command &command, std::span<const std::byte> data) noexcept;
    /// Appends the write of one register of 32 bits in the space HOSTMOT2.
    bool write_register(std::uint16_t address, std::uint32_t value) noexcept;
    /// Appends the read of `count` consecutive registers of 32 bits in the space HOSTMOT2.
    bool read_registers(std::uint16_t address, int count) noexcept;

    std::span<const std::byte> bytes() const noexcept { return std::span(bytes_).first(size_); }
    /// The size of the answer [bytes]; 0: the board sends no answer.
    std::size_t answer_bytes() const noexcept { return answer_bytes_; }
    bool isFull() const noexcept { return full_; }
    void clear() noexcept;
    /// Replaces bytes from `offset`, such as the data of a write; they must be within bytes().
    void replace(std::size_t offset, std::span<const std::byte> data) noexcept;

  private:
    bool append(const Command &command, std::span<const std::byte> data) noexcept;

    std::array<std::byte, MAX_PACKET_BYTES> bytes_{};
    std::size_t limit_;
    std::size_t size_ = 0;
    std::size_t answer_bytes_ = 0;
    bool full_ = false;
};

/// A command of a packet with the data that it writes.
struct ReceivedCommand {
    Command command;
    std::span<const std::byte> data;  ///< empty for a read
};

enum class PacketError : std::uint8_t {
    CUT_COMMAND,  ///< the packet ends inside a command word or an address
    CUT_DATA,     ///< the packet ends inside the data of a write
    NO_UNITS,     ///< a command of 0 units
};

/// Splits a packet into commands, as a board does. [any thread; no allocation]
class PacketReader {
  public:
    explicit PacketReader(std::span<const std::byte> bytes) noexcept : rest_(bytes) {}

    bool isAtEnd() const noexcept { return rest_.empty(); }
    /// The next command. After an error isAtEnd() is true: the rest of the packet cannot be read.
    std::expected<ReceivedCommand, PacketError> next() noexcept;

  private:
    std::span<const std::byte> rest_;
};

/// The number in the first sizeof(T) bytes of `bytes`, which must have at least this size.
template <class T>
constexpr T number_at(std::span<const std::byte> bytes) noexcept {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    }
    return static_cast<T>(value);
}

/// The bytes of `value`, lowest first.
template <class T>
constexpr std::array<std::byte, sizeof(T)> bytes_of_number(T value) noexcept {
    std::array<std::byte, sizeof(T)> bytes{};
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        bytes[i] = static_cast<std::byte>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFFU);
    }
    return bytes;
}

}  // namespace mw::mesa::lbp16
