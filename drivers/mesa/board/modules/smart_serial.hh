// SPDX-License-Identifier: GPL-2.0-or-later
// The smart serial processor with its channels. Source: shared/hardware.md, part B9.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"
#include "drivers/mesa/board/modules/remote.hh"

namespace mw::mesa::board {

constexpr unsigned SERIAL_CHANNELS = 8;
constexpr std::uint32_t BAUDRATE = 2'500'000;  ///< baud rate of all cards, and of a port after its reset
                                               ///< [bit/s]

/// One port. Its registers have separate values for reading and writing.
struct SerialPort {
    struct Channel {
        std::uint32_t cs_in = 0, cs_out = 0;  ///< value written by the host, value read by the host
        UserWords user_in{}, user_out{};
        std::uint32_t baudrate = BAUDRATE;
        enum class State : std::uint8_t { STOPPED, SET_UP, RUNNING } state = State::STOPPED;
    };
    std::uint32_t command = 0, data_in = 0, data_out = 0;
    std::int64_t done_ns = 0;  ///< until this time the command register reads the command
    std::vector<Channel> channels{SERIAL_CHANNELS};
};

/// A remote that is connected to a channel of a port.
struct ConnectedRemote {
    unsigned port = 0, channel = 0;
    Remote remote;
};

/// Registers: command, data, then CS and user registers of each channel.
class SmartSerialModule final : public Module {
  public:
    SmartSerialModule(unsigned ports, unsigned channels, std::vector<ConnectedRemote> remotes);
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    unsigned registers() const override { return 6; }
    unsigned words(unsigned reg) const override { return reg < 2 ? 1 : SERIAL_CHANNELS; }
    bool isInEachInstance(unsigned /*reg*/) const override { return true; }

    /// Sets the inputs of a card before each exchange.
    using FieldInputs = std::function<void(unsigned port, unsigned channel, Remote &remote)>;
    void connect(FieldInputs field_inputs) { field_inputs_ = std::move(field_inputs); }
    /// The remote of a channel; nullptr without one.
    Remote *remote(unsigned port, unsigned channel);

  private:
    void execute(unsigned port, std::uint32_t command);
    /// Executes a command with one channel; false: the channel failed.
    bool start(unsigned port, unsigned channel, bool set_up);
    bool exchange(unsigned port, unsigned channel);
    bool access_memory(SerialPort::Channel &channel, Remote &remote);
    std::uint8_t local_byte(const SerialPort &port, std::uint32_t address) const;
    void set_local_byte(SerialPort &port, std::uint32_t address, std::uint8_t value) const;

    std::vector<SerialPort> ports_;
    unsigned channels_;
    std::vector<ConnectedRemote> remotes_;
    FieldInputs field_inputs_;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board
