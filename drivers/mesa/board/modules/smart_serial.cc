// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/smart_serial.hh"

#include <utility>

namespace mw::mesa::board {

namespace {

using Channel = SerialPort::Channel;
enum : unsigned { COMMAND, DATA, CS, USER0 };

/// Run times of the processor: a local command, and one exchange with the channels at 2.5 Mbaud.
constexpr std::int64_t LOCAL_NS = 5'000, EXCHANGE_NS = 100'000, RESET_NS = 2'000'000;
constexpr std::uint32_t MASK = 0xFF, LOCAL_ADDRESS = 0xFFF;
constexpr std::uint32_t RESET = 0x4000, WRITE_LOCAL = 0xA000, READ_LOCAL = 0x2000, DO_IT = 0x1000;
constexpr std::uint32_t STOP = 0x800, START_NORMAL = 0x900, START_SET_UP = 0xF00;
/// CS: communication error, because of the time limit.
constexpr std::uint32_t NO_ANSWER = (1U << 13U) | (1U << 3U);

/// The first bytes of the processor's memory: type, width, version 0.43, first channel, stride, processor.
constexpr std::uint8_t LOCAL_BYTES[] = {0x12, 0x20, 0, 43, 0x40, 0x40, 1};
constexpr std::uint32_t CHANNEL_COUNT = 7, CHANNEL_START = 4, CHANNEL_STRIDE = 5, BAUD_OFFSET = 42,
                        CLOCK = 0x230;
constexpr std::uint32_t CLOCK_HZ = 100'000'000;

/// The command that a remote executes in set-up mode.
struct RemoteCommand {
    static constexpr std::uint32_t GROUP = 0xC0, DATA_GROUP = 0x40, WRITES = 0x20, SIZE = 3;
    static constexpr std::uint32_t OPEN_NON_VOLATILE = 0xEC, READ_NON_VOLATILE_FLAG = 0xCC;
};

}  // namespace

SmartSerialModule::SmartSerialModule(unsigned ports, unsigned channels, std::vector<ConnectedRemote> remotes)
    : ports_(ports), channels_(channels), remotes_(std::move(remotes)) {}

Remote *SmartSerialModule::remote(unsigned port, unsigned channel) {
    for (ConnectedRemote &one : remotes_) {
        if (one.port == port && one.channel == channel) {
            return &one.remote;
        }
    }
    return nullptr;
}

std::uint8_t SmartSerialModule::local_byte(const SerialPort &port, std::uint32_t address) const {
    const auto byte_of = [](std::uint32_t value, std::uint32_t index) {
        return static_cast<std::uint8_t>((value >> (8 * index)) & 0xFFU);
    };
    if (address < std::size(LOCAL_BYTES)) {
        return LOCAL_BYTES[address];
    }
    if (address == CHANNEL_COUNT) {
        return static_cast<std::uint8_t>(channels_);
    }
    if (address >= CLOCK && address < CLOCK + 4) {
        return byte_of(CLOCK_HZ, address - CLOCK);
    }
    for (unsigned i = 0; i < channels_; ++i) {
        const std::uint32_t baud = LOCAL_BYTES[CHANNEL_START] + i * LOCAL_BYTES[CHANNEL_STRIDE] + BAUD_OFFSET;
        if (address >= baud && address < baud + 4) {
            return byte_of(port.channels[i].baudrate, address - baud);
        }
    }
    return 0;
}

void SmartSerialModule::set_local_byte(SerialPort &port, std::uint32_t address, std::uint8_t value) const {
    for (unsigned i = 0; i < channels_; ++i) {
        const std::uint32_t baud = LOCAL_BYTES[CHANNEL_START] + i * LOCAL_BYTES[CHANNEL_STRIDE] + BAUD_OFFSET;
        if (address >= baud && address < baud + 4) {
            const unsigned shift = 8 * (address - baud);
            std::uint32_t &rate = port.channels[i].baudrate;
            rate = (rate & ~(0xFFU << shift)) | (std::uint32_t{value} << shift);
        }
    }
}

std::uint32_t SmartSerialModule::read(RegisterPlace place) {
    const SerialPort &port = ports_[place.instance];
    switch (place.reg) {
    case COMMAND: return time_ns_ < port.done_ns ? port.command : 0;
    case DATA: return port.data_out;
    case CS: return port.channels[place.word].cs_out;
    default: return port.channels[place.word].user_out[place.reg - USER0];
    }
}

void SmartSerialModule::write(RegisterPlace place, std::uint32_t value) {
    SerialPort &port = ports_[place.instance];
    switch (place.reg) {
    case COMMAND: execute(place.instance, value); break;
    case DATA: port.data_in = value; break;
    case CS: port.channels[place.word].cs_in = value; break;
    default: port.channels[place.word].user_in[place.reg - USER0] = value; break;
    }
}

bool SmartSerialModule::start(unsigned port, unsigned channel, bool set_up) {
    Channel &one = ports_[port].channels[channel];
    // All cards have one baud rate.
    const bool isHeard = channel < channels_ && one.baudrate == BAUDRATE;
    Remote *card = isHeard ? remote(port, channel) : nullptr;
    one.cs_out = card == nullptr ? NO_ANSWER : 0;
    one.state = card == nullptr ? Channel::State::STOPPED
                                : (set_up ? Channel::State::SET_UP : Channel::State::RUNNING);
    if (card == nullptr) {
        return false;
    }
    card->set_mode(static_cast<std::uint8_t>(one.cs_in >> 24U));
    if (set_up) {
        one.user_out = card->identity();
    }
    return true;
}

bool SmartSerialModule::access_memory(Channel &channel, Remote &remote) {
    const std::uint32_t command = channel.cs_in >> 24U;
    const auto address = static_cast<std::uint16_t>(channel.cs_in & 0xFFFFU);
    if (command == RemoteCommand::OPEN_NON_VOLATILE || command == RemoteCommand::READ_NON_VOLATILE_FLAG) {
        channel.user_out[0] = channel.user_in[0] & 1U;
        return true;
    }
    if ((command & RemoteCommand::GROUP) != RemoteCommand::DATA_GROUP) {
        return true;
    }
    const unsigned bytes = 1U << (command & RemoteCommand::SIZE);
    const bool is_write = (command & RemoteCommand::WRITES) != 0;
    if (!is_write) {
        channel.user_out[0] = channel.user_out[1] = 0;
    }
    for (unsigned i = 0; i < bytes; ++i) {
        const auto at = static_cast<std::uint16_t>(address + i);
        const unsigned shift = 8 * (i % 4);
        if (is_write) {
            remote.write_byte(at, static_cast<std::uint8_t>((channel.user_in[i / 4] >> shift) & 0xFFU));
        } else {
            channel.user_out[i / 4] |= std::uint32_t{remote.read_byte(at)} << shift;
        }
    }
    return true;
}

bool SmartSerialModule::exchange(unsigned port, unsigned channel) {
    Channel &one = ports_[port].channels[channel];
    Remote *card = remote(port, channel);
    if (card == nullptr || one.state == Channel::State::STOPPED) {
        one.cs_out = NO_ANSWER;
        return false;
    }
    one.cs_out = 0;
    if (one.state == Channel::State::SET_UP) {
        return access_memory(one, *card);
    }
    if (field_inputs_) {
        field_inputs_(port, channel, *card);
    }
    one.user_out = card->exchange(one.user_in);
    return true;
}

void SmartSerialModule::execute(unsigned number, std::uint32_t command) {
    SerialPort &port = ports_[number];
    port.command = command;
    port.done_ns = time_ns_ + (command == 0 ? 0 : LOCAL_NS);
    const auto for_channels = [&](auto action) {
        // Without a channel nothing is done, and the result of the last command remains.
        std::uint32_t failed = (command & MASK) == 0 ? port.data_out : 0U;
        for (unsigned i = 0; i < SERIAL_CHANNELS; ++i) {
            const bool wanted = ((command >> i) & 1U) != 0;
            failed |= wanted && !action(i) ? 1U << i : 0U;
        }
        port.data_out = failed;
    };
    if ((command & RESET) != 0) {
        port.channels.assign(SERIAL_CHANNELS, {});
        port.done_ns = time_ns_ + RESET_NS;
    } else if ((command & WRITE_LOCAL) == WRITE_LOCAL) {
        set_local_byte(port, command & LOCAL_ADDRESS, static_cast<std::uint8_t>(port.data_in & 0xFFU));
    } else if ((command & READ_LOCAL) != 0) {
        port.data_out = local_byte(port, command & LOCAL_ADDRESS);
    } else if ((command & DO_IT) != 0) {
        for_channels([&](unsigned i) { return exchange(number, i); });
        port.done_ns = time_ns_ + EXCHANGE_NS;
    } else if ((command & ~MASK) == START_SET_UP || (command & ~MASK) == START_NORMAL) {
        const bool set_up = (command & ~MASK) == START_SET_UP;
        for_channels([&](unsigned i) { return start(number, i, set_up); });
    } else if ((command & ~MASK) == STOP) {
        for_channels([&](unsigned i) {
            port.channels[i].state = Channel::State::STOPPED;
            return true;
        });
    }
}

}  // namespace mw::mesa::board
