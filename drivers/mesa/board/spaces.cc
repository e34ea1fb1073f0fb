// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/spaces.hh"

#include <algorithm>
#include <span>

namespace mw::mesa::board {

namespace {

constexpr std::uint16_t COOKIE_BASE = 0x5A00;
constexpr std::uint32_t SECTOR_BYTES = 0x10000;
constexpr std::size_t NAME_BYTES = 16;

/// 8 Mbit has 2^20 bytes.
unsigned flash_exponent(std::uint8_t flash_id) {
    return 20U + (flash_id - 0x13U);
}

void set_name(std::vector<std::byte> &memory, std::size_t address, const std::string &name) {
    for (std::size_t i = 0; i < std::min(name.size(), NAME_BYTES); ++i) {
        memory[address + i] = static_cast<std::byte>(name[i]);
    }
}

}  // namespace

SpaceFacts facts_of(lbp16::Space space, std::uint8_t flash_id) {
    using lbp16::Space;
    const auto cookie = static_cast<std::uint16_t>(COOKIE_BASE + static_cast<unsigned>(space));
    switch (space) {
    case Space::HOSTMOT2: return {cookie, 0x8104, 0x0010, "HostMot2", 0x10000};
    case Space::ETHERNET_CHIP: return {cookie, 0x8102, 0x0008, "KSZ8851", 0x100};
    case Space::EEPROM: return {cookie, 0x8E02, 0x0007, "EtherEEP", 0x80};
    case Space::FLASH:
        return {cookie, 0x8F04, static_cast<std::uint16_t>(0x8200 + flash_exponent(flash_id)), "FPGAFlsh",
                0x10};
    case Space::TIMERS: return {cookie, 0x8202, 0x0004, "Timers", 0x20};
    case Space::CONTROL: return {cookie, 0x8202, 0x0004, "LBP16RW", 0x20};
    case Space::BOARD: return {cookie, 0x0202, 0x0004, "LBP16RO", 0x20};
    case Space::UNUSED: break;
    }
    return {};
}

std::vector<std::byte> information_of(const SpaceFacts &facts, std::uint16_t pointer) {
    std::vector<std::byte> bytes(16);
    set_word(bytes, 0, facts.cookie);
    set_word(bytes, 2, facts.size_word);
    set_word(bytes, 4, facts.ranges_word);
    set_word(bytes, 6, facts.cookie == 0 ? 0 : pointer);
    for (std::size_t i = 0; i < facts.name.size(); ++i) {
        bytes[8 + i] = static_cast<std::byte>(facts.name[i]);
    }
    return bytes;
}

std::uint16_t word_at(const std::vector<std::byte> &memory, std::size_t address) {
    return lbp16::number_at<std::uint16_t>(std::span(memory).subspan(address, 2));
}

void set_word(std::vector<std::byte> &memory, std::size_t address, std::uint16_t value) {
    memory[address] = static_cast<std::byte>(value & 0xFFU);
    memory[address + 1] = static_cast<std::byte>(value >> 8U);
}

std::vector<std::byte> factory_eeprom(const Model &model) {
    std::vector<std::byte> memory(0x80);
    // 00:60:1B is the range of Mesa.
    set_word(memory, 2, 0x0001);
    set_word(memory, 4, 0x1B16);
    set_word(memory, 6, 0x0060);
    set_name(memory, 0x10, model.card_name);
    set_word(memory, 0x20, 0x0179);
    set_word(memory, 0x22, 0xC0A8);
    return memory;
}

std::vector<std::byte> board_information(const Model &model) {
    std::vector<std::byte> memory(0x20);
    set_name(memory, 0, model.card_name);
    set_word(memory, 0x10, model.lbp_version);
    set_word(memory, 0x12, model.firmware_version);
    set_word(memory, 0x14, 1);
    return memory;
}

Flash::Flash(std::uint8_t id) : id_(id), memory_(std::size_t{1} << flash_exponent(id), std::byte{0xFF}) {}

std::uint32_t Flash::read(std::uint16_t address) {
    switch (address) {
    case 0: return address_;
    case 4: {
        const auto at = address_ % memory_.size() & ~std::size_t{3};
        address_ += 4;
        return lbp16::number_at<std::uint32_t>(std::span(memory_).subspan(at, 4));
    }
    case 8: return id_;
    default: return 0;
    }
}

void Flash::write(std::uint16_t address, std::uint32_t value) {
    if (address == 0) {
        address_ = value;
    } else if (address == 4) {
        const auto bytes = lbp16::bytes_of_number(value);
        const auto at = address_ % memory_.size() & ~std::size_t{3};
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            memory_[at + i] &= bytes[i];
        }
        address_ += 4;
    } else if (address == 0xC) {
        const auto sector = address_ % memory_.size() / SECTOR_BYTES * SECTOR_BYTES;
        std::fill_n(memory_.begin() + static_cast<std::ptrdiff_t>(sector), SECTOR_BYTES, std::byte{0xFF});
    }
}

}  // namespace mw::mesa::board
