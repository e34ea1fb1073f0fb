// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/lbp16/packet.hh"

#include <algorithm>

namespace mw::mesa::lbp16 {

namespace {

constexpr unsigned WRITES = 1U << 15U, ADDRESSED = 1U << 14U, INFORMATION = 1U << 13U,
                   INCREMENTING = 1U << 7U;
constexpr unsigned SPACE_SHIFT = 10, UNIT_SHIFT = 8;

constexpr unsigned when(bool condition, unsigned bits) noexcept {
    return condition ? bits : 0U;
}

}  // namespace

std::uint16_t command_word(const Command &command) noexcept {
    return static_cast<std::uint16_t>(
        when(command.writes, WRITES) | when(command.addressed, ADDRESSED) |
        when(command.information, INFORMATION) | when(command.incrementing, INCREMENTING) |
        (static_cast<unsigned>(command.space) << SPACE_SHIFT) |
        (static_cast<unsigned>(command.unit) << UNIT_SHIFT) | (command.units & 0x7FU));
}

Command command_of(std::uint16_t word) noexcept {
    return {.writes = (word & WRITES) != 0,
            .addressed = (word & ADDRESSED) != 0,
            .information = (word & INFORMATION) != 0,
            .incrementing = (word & INCREMENTING) != 0,
            .space = static_cast<Space>((word >> SPACE_SHIFT) & 7U),
            .unit = static_cast<Unit>((word >> UNIT_SHIFT) & 3U),
            .units = static_cast<std::uint8_t>(word & 0x7FU)};
}

PacketWriter::PacketWriter(std::size_t limit) noexcept : limit_(std::min(limit, MAX_PACKET_BYTES)) {}

bool PacketWriter::read(const Command &command) noexcept {
    const bool fits = answer_bytes_ + command.data_bytes() <= limit_;
    if (!fits || command.units == 0 || command.writes || !append(command, {})) {
        full_ = true;
        return false;
    }
    answer_bytes_ += command.data_bytes();
    return true;
}

bool PacketWriter::write(const Command &command, std::span<const std::byte> data) noexcept {
    const bool valid = command.writes && command.units > 0 && data.size() == command.data_bytes();
    if (!valid || !append(command, data)) {
        full_ = true;
        return false;
    }
    return true;
}

bool PacketWriter::write_register(std::uint16_t address, std::uint32_t value) noexcept {
    return write({.writes = true, .address = address}, bytes_of_number(value));
}

bool PacketWriter::read_registers(std::uint16_t address, int count) noexcept {
    const bool valid = count >= 1 && count <= MAX_UNITS;
    return read({.units = static_cast<std::uint8_t>(valid ? count : 0), .address = address});
}

void PacketWriter::clear() noexcept {
    size_ = 0;
    answer_bytes_ = 0;
    full_ = false;
}

void PacketWriter::replace(std::size_t offset, std::span<const std::byte> data) noexcept {
    if (offset <= size_ && data.size() <= size_ - offset) {
        std::ranges::copy(data, bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    }
}

bool PacketWriter::append(const Command &command, std::span<const std::byte> data) noexcept {
    const std::size_t head = command.addressed ? 4 : 2;
    if (full_ || size_ + head + data.size() > limit_) {
        return false;
    }
    const auto put = [this](std::span<const std::byte> bytes) {
        std::ranges::copy(bytes, bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
        size_ += bytes.size();
    };
    put(bytes_of_number(command_word(command)));
    if (command.addressed) {
        put(bytes_of_number(command.address));
    }
    put(data);
    return true;
}

std::expected<ReceivedCommand, PacketError> PacketReader::next() noexcept {
    const auto failed = [this](PacketError error) {
        rest_ = {};
        return std::unexpected(error);
    };
    if (rest_.size() < 2) {
        return failed(PacketError::CUT_COMMAND);
    }
    ReceivedCommand received{.command = command_of(number_at<std::uint16_t>(rest_)), .data = {}};
    Command &command = received.command;
    rest_ = rest_.subspan(2);
    if (command.addressed) {
        if (rest_.size() < 2) {
            return failed(PacketError::CUT_COMMAND);
        }
        command.address = number_at<std::uint16_t>(rest_);
        rest_ = rest_.subspan(2);
    }
    if (command.units == 0) {
        return failed(PacketError::NO_UNITS);
    }
    if (command.writes) {
        if (rest_.size() < command.data_bytes()) {
            return failed(PacketError::CUT_DATA);
        }
        received.data = rest_.first(command.data_bytes());
        rest_ = rest_.subspan(command.data_bytes());
    }
    return received;
}

}  // namespace mw::mesa::lbp16
