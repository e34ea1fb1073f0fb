// SPDX-License-Identifier: GPL-2.0-or-later
// Smart serial while loading: starts the processor of a port, finds the cards of its channels and reads their
// memory. Source: shared/hardware.md, part B9 (one source, not compared with a real board).
#pragma once

#include <functional>

#include "drivers/mesa/hostmot2/assignment.hh"
#include "drivers/mesa/hostmot2/modules/sserial_records.hh"
#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

/// Data that a port reports.
struct SserialPort {
    int major = 0, minor = 0;
    int channels = 0;
};
/// The card of a channel.
struct SserialCard {
    std::uint32_t serial_number = 0;
    std::string name;  ///< 4 characters, in lower case: 7i76
    std::uint16_t ptoc = 0, gtoc = 0;
};

class SserialSetup {
  public:
    /// Waits between two reads of the command register.
    using Pause = std::function<void()>;
    /// The port `instance` of a module. The bus and the module must outlive it.
    SserialSetup(RegisterBus &bus, const UsedModule &module, int instance, Pause pause)
        : bus_(bus), module_(module), instance_(instance), pause_(std::move(pause)) {}

    /// Resets the processor of the port and reads its version.
    Result<SserialPort> reset();
    /// Sets the baud rate of the first `channels` channels [bit/s].
    Result<> set_baudrate(int channels, std::uint32_t baudrate);
    /// Starts the set-up of the channels in `mask`; returns the mask of channels with a card. The description
    /// of a card depends on its mode; `modes` has one for each channel, and missing modes are 0.
    Result<std::uint32_t> start_setup(std::uint32_t mask, std::span<const std::uint8_t> modes = {});
    /// The card of a channel in set-up.
    Result<SserialCard> card(int channel);
    /// A byte of the memory of a card in set-up.
    Result<std::uint8_t> read_card_byte(int channel, std::uint16_t address);
    /// Reads a value of 1, 2, 4 or 8 bytes, the lowest byte first. The record determines how it is read.
    Result<std::uint64_t> read_card_value(int channel, std::uint16_t address, int bytes);
    Result<std::uint64_t> read_nonvolatile_value(int channel, std::uint16_t address, int bytes);
    /// Starts the exchange of process data with a mode for each channel; returns the mask of channels that
    /// follow.
    Result<std::uint32_t> start_normal(std::uint32_t mask, std::span<const std::uint8_t> modes);
    Result<> stop(std::uint32_t mask);

    std::uint16_t command_address() const noexcept { return module_.address(0, instance_); }
    std::uint16_t data_address() const noexcept { return module_.address(1, instance_); }
    std::uint16_t status_address(int channel) const noexcept { return channel_address(2, channel); }
    std::uint16_t user_address(int number, int channel) const noexcept {
        return channel_address(3 + number, channel);
    }

  private:
    std::uint16_t channel_address(int reg, int channel) const noexcept {
        return static_cast<std::uint16_t>(module_.address(reg, instance_) + 4 * channel);
    }
    Result<std::uint32_t> read(std::uint16_t address);
    Result<> write(std::uint16_t address, std::uint32_t value);
    Result<> command(std::uint32_t value);
    Result<> wait();
    Result<std::uint8_t> read_local(std::uint16_t address);
    Result<> write_local(std::uint16_t address, std::uint8_t value);
    Result<std::uint32_t> start(std::uint32_t command_bits, std::uint32_t mask);
    Result<> write_modes(std::uint32_t mask, std::span<const std::uint8_t> modes);
    Result<> card_command(int channel, std::uint32_t status);

    RegisterBus &bus_;
    const UsedModule &module_;
    int instance_;
    Pause pause_;
};

}  // namespace mw::mesa
