// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/epp/epp_registers.hh"

#include <cerrno>

namespace mw::mesa::epp {

void EppRegisters::begin() noexcept {
    port_->write(Register::CONTROL, CONTROL_IDLE);
    // Clears a time-out of an earlier program.
    (void)finish();
    // After this data access the next address byte is a low byte.
    port_->write(Register::EPP_ADDRESS, 0);
    (void)port_->read(Register::EPP_DATA);
    (void)finish();
    last_error_ = 0;
}

void EppRegisters::send_address(std::uint16_t address) noexcept {
    for (const std::uint8_t byte : address_bytes(address)) {
        port_->write(Register::EPP_ADDRESS, byte);
    }
}

bool EppRegisters::finish() noexcept {
    const std::uint8_t status = port_->read(Register::STATUS);
    if ((status & TIMEOUT) == 0) {
        return true;
    }
    last_error_ = ETIMEDOUT;
    // Some chips clear the bit with a 1, others with a 0.
    port_->write(Register::STATUS, static_cast<std::uint8_t>(status | TIMEOUT));
    port_->write(Register::STATUS, static_cast<std::uint8_t>(status & ~TIMEOUT));
    return false;
}

bool EppRegisters::read(std::uint16_t address, std::span<std::uint32_t> values) noexcept {
    send_address(address);
    for (std::uint32_t &value : values) {
        if (width_ == Width::WIDE) {
            value = port_->read_wide();
            continue;
        }
        std::array<std::uint8_t, 4> bytes{};
        for (std::uint8_t &byte : bytes) {
            byte = port_->read(Register::EPP_DATA);
        }
        value = word_of(bytes);
    }
    return finish();
}

bool EppRegisters::write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept {
    send_address(address);
    for (const std::uint32_t value : values) {
        if (width_ == Width::WIDE) {
            port_->write_wide(value);
            continue;
        }
        for (const std::uint8_t byte : data_bytes(value)) {
            port_->write(Register::EPP_DATA, byte);
        }
    }
    return finish();
}

}  // namespace mw::mesa::epp
