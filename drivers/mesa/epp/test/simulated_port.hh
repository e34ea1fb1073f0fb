// SPDX-License-Identifier: GPL-2.0-or-later
// A parallel port in EPP mode with a simulated board. It decodes the bytes that reach the board.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "drivers/mesa/direct/test/rig.hh"
#include "drivers/mesa/epp/epp_port.hh"

namespace mw::mesa::test {

class SimulatedPort final : public epp::Port {
  public:
    explicit SimulatedPort(Wire &wire, std::vector<std::string> *log = nullptr) : wire_(wire), log_(log) {}

    std::uint8_t read(epp::Register reg) noexcept override {
        if (reg == epp::Register::STATUS) {
            return static_cast<std::uint8_t>(0x86U | (timed_out_ ? epp::TIMEOUT : 0U));
        }
        if (reg != epp::Register::EPP_DATA) {
            return 0;
        }
        note("in8");
        return read_byte();
    }
    void write(epp::Register reg, std::uint8_t value) noexcept override {
        switch (reg) {
        case epp::Register::STATUS: timed_out_ = timed_out_ && (value & epp::TIMEOUT) == 0; break;
        case epp::Register::EPP_ADDRESS:
            note("address", value);
            write_address(value);
            break;
        case epp::Register::EPP_DATA:
            note("out8", value);
            write_byte(value);
            break;
        default: break;
        }
    }
    std::uint32_t read_wide() noexcept override {
        note("in32");
        std::array<std::uint8_t, 4> bytes{};
        for (std::uint8_t &byte : bytes) {
            byte = read_byte();
        }
        return epp::word_of(bytes);
    }
    void write_wide(std::uint32_t value) noexcept override {
        note("out32", value);
        for (const std::uint8_t byte : epp::data_bytes(value)) {
            write_byte(byte);
        }
    }

  private:
    void note(const char *what, std::uint32_t value = 0) {
        if (log_ != nullptr) {
            char text[32];
            std::snprintf(text, sizeof text, "%s %x", what, value);
            log_->emplace_back(text);
        }
    }
    bool isAnswered() noexcept {
        timed_out_ = timed_out_ || wire_.is_cut;
        return !wire_.is_cut;
    }
    void write_address(std::uint8_t value) noexcept {
        if (!isAnswered()) {
            return;
        }
        address_ = high_next_ ? static_cast<std::uint16_t>((address_ & 0xFFU) | (value << 8U)) : value;
        high_next_ = !high_next_;
    }
    /// The board increments the address if bit 15 is set.
    void step() noexcept {
        high_next_ = false;
        if ((address_ & 0x8000U) != 0) {
            address_ = static_cast<std::uint16_t>(0x8000U | ((address_ + 1U) & 0x7FFFU));
        }
    }
    std::uint8_t read_byte() noexcept {
        if (!isAnswered()) {
            return 0xFF;
        }
        const unsigned at = address_ & 3U;
        if (at == 0) {
            latched_ = wire_.board.firmware().read(static_cast<std::uint16_t>(address_ & 0x7FFCU));
        }
        const auto byte = static_cast<std::uint8_t>((latched_ >> (8 * at)) & 0xFFU);
        step();
        return byte;
    }
    void write_byte(std::uint8_t value) noexcept {
        if (!isAnswered()) {
            return;
        }
        const unsigned at = address_ & 3U;
        bytes_[at] = value;
        if (at == 3) {
            wire_.board.firmware().write(static_cast<std::uint16_t>(address_ & 0x7FFCU),
                                         epp::word_of(bytes_));
        }
        step();
    }

    Wire &wire_;
    std::vector<std::string> *log_;
    std::uint16_t address_ = 0;
    bool high_next_ = true;  ///< another program has sent one byte of an address
    bool timed_out_ = false;
    std::uint32_t latched_ = 0;
    std::array<std::uint8_t, 4> bytes_{};
};

}  // namespace mw::mesa::test
