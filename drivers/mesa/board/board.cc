// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/board.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::mesa::board {

namespace {

using lbp16::Command;
using lbp16::Space;

constexpr std::uint16_t KEY_BASE = 0x5A00;
constexpr std::size_t MAX_ANSWER_BYTES = lbp16::MAX_PACKET_BYTES;
constexpr std::int64_t NS_IN_US = 1000;
constexpr std::uint32_t TIME_STAMP = 0, WAIT_US = 2;

std::size_t index_of(Space space) {
    return static_cast<std::size_t>(space);
}

std::size_t index_of(ControlAddress address) {
    return static_cast<std::size_t>(address);
}

/// The unsigned number in these bytes.
std::uint64_t number_of(std::span<const std::byte> bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    }
    return value;
}

}  // namespace

std::string log_line(const ExecutedCommand &executed) {
    const Command &command = executed.command;
    std::string line =
        fmt::format("{} {}{}{} 0x{:04X} {}x{}{}", executed.time_ns, command.writes ? 'W' : 'R',
                    index_of(command.space), command.information ? "i" : "", command.address, command.units,
                    8 * lbp16::bytes_of(command.unit), command.incrementing ? "" : " fixed");
    const std::size_t size = lbp16::bytes_of(command.unit);
    for (std::size_t at = 0; at + size <= executed.data.size(); at += size) {
        line += fmt::format(" {:0{}X}", number_of(executed.data.subspan(at, size)), 2 * size);
    }
    return line;
}

Board::Board(const Model &model, PhysicsPlan physics)
    : model_(model), physics_(std::move(physics)), flash_(model.flash_id) {
    for (std::size_t i = 0; i < SPACES; ++i) {
        facts_[i] = facts_of(static_cast<Space>(i), model.flash_id);
    }
    memories_[index_of(Space::EEPROM)] = factory_eeprom(model);
    restart(0, 0);
}

void Board::restart(std::int64_t time_ns, std::int64_t off_ns) {
    if (firmware_ != nullptr) {
        firmware_->advance(time_ns);
        time_ns = std::max(time_ns, firmware_->now_ns());
    }
    firmware_ = std::make_unique<Firmware>(model_.idrom, physics_, time_ns);
    power_on_ns_ = time_ns + off_ns;
    pointers_.fill(0);
    memories_[index_of(Space::ETHERNET_CHIP)].assign(0x100, {});
    memories_[index_of(Space::TIMERS)].assign(0x20, {});
    memories_[index_of(Space::CONTROL)].assign(0x20, {});
    memories_[index_of(Space::BOARD)] = board_information(model_);
}

void Board::advance(std::int64_t time_ns) {
    firmware_->advance(time_ns);
}

std::vector<std::byte> &Board::memory_of(Space space) {
    return memories_[index_of(space)];
}

std::uint16_t Board::control(ControlAddress address) const {
    return word_at(memories_[index_of(Space::CONTROL)], index_of(address));
}

void Board::count(ControlAddress counter) {
    set_word(memory_of(Space::CONTROL), index_of(counter), static_cast<std::uint16_t>(control(counter) + 1));
}

void Board::count_error(ErrorBit bit, ControlAddress counter) {
    count(counter);
    const unsigned errors = control(ControlAddress::ERRORS) | static_cast<unsigned>(bit);
    set_word(memory_of(Space::CONTROL), index_of(ControlAddress::ERRORS), static_cast<std::uint16_t>(errors));
}

std::optional<Reply> Board::execute(std::span<const std::byte> packet, std::int64_t time_ns) {
    advance(time_ns);
    if (time_ns < power_on_ns_) {
        return {};
    }
    wait_ns_ = 0;
    restarts_ = false;
    count(ControlAddress::RECEIVED_PACKETS);
    count(ControlAddress::RECEIVED_UDP);
    Reply reply;
    lbp16::PacketReader reader(packet);
    while (!reader.isAtEnd() && !restarts_) {
        const auto received = reader.next();
        if (!received.has_value()) {
            count_error(ErrorBit::PARSE, ControlAddress::PARSE_ERRORS);
            break;
        }
        if (!execute_one(*received, reply)) {
            break;
        }
    }
    reply.time_ns = time_ns + wait_ns_;
    if (restarts_) {
        restart(now_ns(), 0);
    }
    if (reply.bytes.empty()) {
        return {};
    }
    count(ControlAddress::SENT_PACKETS);
    count(ControlAddress::SENT_UDP);
    return reply;
}

bool Board::execute_one(const lbp16::ReceivedCommand &received, Reply &reply) {
    const Command &command = received.command;
    const SpaceFacts &facts = facts_[index_of(command.space)];
    if (!command.writes && reply.bytes.size() + command.data_bytes() > MAX_ANSWER_BYTES) {
        count_error(ErrorBit::SENT_BAD, ControlAddress::SENT_BAD);
        return false;
    }
    if (command.information && !command.writes) {
        return read_information(command, reply);
    }
    if (command.information || (command.writes && !facts.isWritable())) {
        count_error(ErrorBit::WRITE, ControlAddress::WRITE_ERRORS);
        return false;
    }
    if (facts.cookie == 0 || !facts.permits(command.unit)) {
        count_error(ErrorBit::MEMORY, ControlAddress::MEMORY_ERRORS);
        return false;
    }
    return execute_units(received, reply);
}

bool Board::read_information(const Command &command, Reply &reply) {
    const auto bytes = information_of(facts_[index_of(command.space)], pointers_[index_of(command.space)]);
    const std::size_t size = lbp16::bytes_of(command.unit);
    std::size_t at = command.address;
    const std::size_t before = reply.bytes.size();
    for (unsigned i = 0; i < command.units; ++i) {
        if (at + size > bytes.size()) {
            count_error(ErrorBit::MEMORY, ControlAddress::MEMORY_ERRORS);
            return false;
        }
        const auto unit = std::span(bytes).subspan(at, size);
        reply.bytes.insert(reply.bytes.end(), unit.begin(), unit.end());
        at += command.incrementing ? size : 0;
    }
    if (log_) {
        log_({now_ns(), command, std::span(reply.bytes).subspan(before)});
    }
    return true;
}

bool Board::execute_units(const lbp16::ReceivedCommand &received, Reply &reply) {
    const Command &command = received.command;
    const SpaceFacts &facts = facts_[index_of(command.space)];
    std::uint16_t &pointer = pointers_[index_of(command.space)];
    if (command.addressed) {
        pointer = command.address;
    }
    Command logged = command;
    logged.address = pointer;
    const auto size = static_cast<std::uint32_t>(lbp16::bytes_of(command.unit));
    const std::size_t before = reply.bytes.size();
    for (unsigned i = 0; i < command.units; ++i) {
        const std::uint32_t address = pointer;
        if (address % size != 0 || address + size > facts.bytes) {
            count_error(ErrorBit::MEMORY, ControlAddress::MEMORY_ERRORS);
            return false;
        }
        if (!command.writes) {
            const auto bytes = lbp16::bytes_of_number(read_unit(command, address));
            reply.bytes.insert(reply.bytes.end(), bytes.begin(), bytes.begin() + size);
        } else if (!write_unit(command, address,
                               number_of(received.data.subspan(std::size_t{i} * size, size)))) {
            count_error(ErrorBit::WRITE, ControlAddress::WRITE_ERRORS);
            return false;
        }
        pointer = static_cast<std::uint16_t>(pointer + (command.incrementing ? size : 0));
    }
    const bool is_protected = command.space == Space::EEPROM || command.space == Space::FLASH;
    if (command.writes && is_protected) {
        set_word(memory_of(Space::CONTROL), index_of(ControlAddress::WRITE_KEY), 0);
    }
    if (log_) {
        const auto data =
            command.writes ? received.data : std::span<const std::byte>(reply.bytes).subspan(before);
        log_({now_ns(), logged, data});
    }
    return true;
}

std::uint64_t Board::read_unit(const Command &command, std::uint32_t address) {
    const auto at = static_cast<std::uint16_t>(address);
    if (command.space == Space::HOSTMOT2) {
        return firmware_->read(at);
    }
    if (command.space == Space::FLASH) {
        return flash_.read(at);
    }
    if (command.space == Space::TIMERS && address == TIME_STAMP) {
        return static_cast<std::uint16_t>(now_ns() / NS_IN_US);
    }
    return word_at(memory_of(command.space), address);
}

bool Board::mayWrite(const Command &command, std::uint32_t address) const {
    const bool is_flash =
        command.space == Space::FLASH && Flash::isProtected(static_cast<std::uint16_t>(address));
    if (command.space != Space::EEPROM && !is_flash) {
        return true;
    }
    return control(ControlAddress::WRITE_KEY) == KEY_BASE + index_of(command.space);
}

bool Board::write_unit(const Command &command, std::uint32_t address, std::uint64_t value) {
    if (!mayWrite(command, address)) {
        return false;
    }
    const auto at = static_cast<std::uint16_t>(address);
    const auto word = static_cast<std::uint16_t>(value);
    switch (command.space) {
    case Space::HOSTMOT2: firmware_->write(at, static_cast<std::uint32_t>(value)); break;
    case Space::FLASH: flash_.write(at, static_cast<std::uint32_t>(value)); break;
    case Space::CONTROL: write_control(address, word); break;
    case Space::TIMERS:
        if (address == WAIT_US) {
            wait_ns_ += word * NS_IN_US;
            firmware_->advance(now_ns() + word * NS_IN_US);
        }
        set_word(memory_of(command.space), address, word);
        break;
    default: set_word(memory_of(command.space), address, word); break;
    }
    return true;
}

void Board::write_control(std::uint32_t address, std::uint16_t value) {
    const bool is_reset =
        address == index_of(ControlAddress::RESET) || address == index_of(ControlAddress::RELOAD);
    if (is_reset && value != 0) {
        restarts_ = true;
        return;
    }
    set_word(memory_of(Space::CONTROL), address, value);
}

}  // namespace mw::mesa::board
