// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_setup.hh"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

constexpr std::uint32_t RESET = 0x4000, READ_LOCAL = 0x2000, WRITE_LOCAL = 0xA000, STOP = 0x800,
                        START_NORMAL = 0x900, START_SETUP = 0xF00, DO_IT = 0x1000,
                        READ_CARD_BYTE = 0x4C000000, READ_NONVOLATILE = 0x44000000,
                        OPEN_NONVOLATILE = 0xEC000000;
constexpr unsigned SIZE_SHIFT = 24, MODE_SHIFT = 24;
/// Bit 31 of the command register has another use.
constexpr std::uint32_t COMMAND_MASK = 0x7FFFFFFF, CHANNEL_MASK = 0xFF;
constexpr int MOST_LOOKS = 5000, OLDEST_MINOR = 43, MOST_REPEATS = 4;
enum LocalAddress : std::uint16_t {
    MAJOR = 2,
    MINOR = 3,
    FIRST_CHANNEL = 4,
    CHANNEL_STRIDE = 5,
    CHANNELS = 7
};
/// Offset of the baud rate in the data of a channel: 4 bytes, the lowest first.
constexpr int BAUDRATE_OFFSET = 42;

}  // namespace

// The discovery of a card takes thousands of packets, so more consecutive losses are accepted than elsewhere.
Result<std::uint32_t> SserialSetup::read(std::uint16_t address) {
    auto words = bus_.read_now({address, 1});
    for (int again = 0; !words && again < MOST_REPEATS; ++again) {
        words = bus_.read_now({address, 1});
    }
    if (!words) {
        return std::unexpected(words.error());
    }
    return words->front();
}

Result<> SserialSetup::write(std::uint16_t address, std::uint32_t value) {
    auto written = bus_.write_now(address, {&value, 1});
    for (int again = 0; !written && again < MOST_REPEATS; ++again) {
        written = bus_.write_now(address, {&value, 1});
    }
    return written;
}

Result<> SserialSetup::wait() {
    for (int look = 0; look < MOST_LOOKS; ++look) {
        const auto state = read(command_address());
        if (!state) {
            return std::unexpected(state.error());
        }
        if ((*state & COMMAND_MASK) == 0) {
            return {};
        }
        pause_();
    }
    return fail(
        fmt::format("Smart serial port {} does not answer. Check the firmware of the board.", instance_));
}

Result<> SserialSetup::command(std::uint32_t value) {
    if (auto written = write(command_address(), value); !written) {
        return written;
    }
    return wait();
}

Result<std::uint8_t> SserialSetup::read_local(std::uint16_t address) {
    if (auto done = command(READ_LOCAL | address); !done) {
        return std::unexpected(done.error());
    }
    const auto data = read(data_address());
    if (!data) {
        return std::unexpected(data.error());
    }
    return static_cast<std::uint8_t>(*data);
}

Result<> SserialSetup::write_local(std::uint16_t address, std::uint8_t value) {
    if (auto written = write(data_address(), value); !written) {
        return written;
    }
    return command(WRITE_LOCAL | address);
}

Result<> SserialSetup::set_baudrate(int channels, std::uint32_t baudrate) {
    const auto first = read_local(FIRST_CHANNEL);
    const auto stride = first ? read_local(CHANNEL_STRIDE) : first;
    if (!stride) {
        return std::unexpected(stride.error());
    }
    for (int channel = 0; channel < channels; ++channel) {
        const int address = *first + *stride * channel + BAUDRATE_OFFSET;
        for (int byte = 0; byte < 4; ++byte) {
            const auto value = static_cast<std::uint8_t>(baudrate >> (8U * static_cast<unsigned>(byte)));
            if (auto written = write_local(static_cast<std::uint16_t>(address + byte), value); !written) {
                return written;
            }
        }
    }
    return {};
}

Result<SserialPort> SserialSetup::reset() {
    if (auto written = write(command_address(), RESET); !written) {
        return std::unexpected(written.error());
    }
    if (auto done = command(0); !done) {
        return std::unexpected(done.error());
    }
    SserialPort port;
    for (const auto &[address, value] :
         {std::pair{MAJOR, &port.major}, {MINOR, &port.minor}, {CHANNELS, &port.channels}}) {
        const auto byte = read_local(address);
        if (!byte) {
            return std::unexpected(byte.error());
        }
        *value = *byte;
    }
    constexpr int MOST_CHANNELS = 8;
    if (port.minor < OLDEST_MINOR || port.channels > MOST_CHANNELS) {
        return fail(
            fmt::format("Smart serial port {} has firmware {}.{} with {} channels; version {} or later with "
                        "at most {} channels is required.",
                        instance_, port.major, port.minor, port.channels, OLDEST_MINOR, MOST_CHANNELS));
    }
    return port;
}

Result<> SserialSetup::stop(std::uint32_t mask) {
    return command(STOP | (mask & CHANNEL_MASK));
}

/// The data register then has a bit for each channel that failed.
Result<std::uint32_t> SserialSetup::start(std::uint32_t command_bits, std::uint32_t mask) {
    if (auto done = command(command_bits | (mask & CHANNEL_MASK)); !done) {
        return std::unexpected(done.error());
    }
    const auto failed = read(data_address());
    if (!failed) {
        return std::unexpected(failed.error());
    }
    return mask & ~*failed & CHANNEL_MASK;
}

Result<> SserialSetup::write_modes(std::uint32_t mask, std::span<const std::uint8_t> modes) {
    for (int channel = 0; channel < MAX_CHANNELS; ++channel) {
        const auto number = static_cast<std::size_t>(channel);
        const bool wanted = ((mask >> number) & 1U) != 0;
        const std::uint32_t mode = number < modes.size() ? modes[number] : 0U;
        if (!wanted) {
            continue;
        }
        if (auto written = write(status_address(channel), mode << MODE_SHIFT); !written) {
            return written;
        }
    }
    return {};
}

Result<std::uint32_t> SserialSetup::start_setup(std::uint32_t mask, std::span<const std::uint8_t> modes) {
    if (auto stopped = stop(CHANNEL_MASK); !stopped) {
        return std::unexpected(stopped.error());
    }
    if (auto written = write_modes(mask, modes); !written) {
        return std::unexpected(written.error());
    }
    return start(START_SETUP, mask);
}

Result<SserialCard> SserialSetup::card(int channel) {
    std::uint32_t words[3] = {};
    for (int i = 0; i < 3; ++i) {
        const auto word = read(user_address(i, channel));
        if (!word) {
            return std::unexpected(word.error());
        }
        words[i] = *word;
    }
    SserialCard card;
    card.serial_number = words[0];
    for (unsigned i = 0; i < 4; ++i) {
        const auto c = static_cast<char>((words[1] >> (8 * i)) & 0xFFU);
        const bool is_capital = c >= 'A' && c <= 'Z';
        card.name += is_capital ? static_cast<char>(c - 'A' + 'a') : c;
    }
    card.ptoc = static_cast<std::uint16_t>(words[2]);
    card.gtoc = static_cast<std::uint16_t>(words[2] >> 16U);
    return card;
}

/// Executes the command in the status register with a card in set-up.
Result<> SserialSetup::card_command(int channel, std::uint32_t status) {
    constexpr std::uint32_t FAULTS = 0xFF00;
    if (auto written = write(status_address(channel), status); !written) {
        return written;
    }
    if (auto done = command(DO_IT | (1U << static_cast<unsigned>(channel))); !done) {
        return done;
    }
    const auto result = read(status_address(channel));
    if (!result) {
        return std::unexpected(result.error());
    }
    if ((*result & FAULTS) != 0) {
        return fail(
            fmt::format("The card of smart serial channel {}.{} does not answer (status 0x{:08X}). Check its "
                        "cable and supply.",
                        instance_, channel, *result));
    }
    return {};
}

Result<std::uint8_t> SserialSetup::read_card_byte(int channel, std::uint16_t address) {
    if (auto done = card_command(channel, READ_CARD_BYTE | address); !done) {
        return std::unexpected(done.error());
    }
    const auto byte = read(user_address(0, channel));
    if (!byte) {
        return std::unexpected(byte.error());
    }
    return static_cast<std::uint8_t>(*byte);
}

Result<std::uint64_t> SserialSetup::read_card_value(int channel, std::uint16_t address, int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
        const auto byte = read_card_byte(channel, static_cast<std::uint16_t>(address + i));
        if (!byte) {
            return std::unexpected(byte.error());
        }
        value |= std::uint64_t{*byte} << static_cast<unsigned>(8 * i);
    }
    return value;
}

Result<std::uint64_t> SserialSetup::read_nonvolatile_value(int channel, std::uint16_t address, int bytes) {
    constexpr std::uint32_t OPEN = 1, CLOSED = 0;
    const auto set_access = [&](std::uint32_t access) -> Result<> {
        if (auto written = write(user_address(0, channel), access); !written) {
            return written;
        }
        return card_command(channel, OPEN_NONVOLATILE);
    };
    if (auto opened = set_access(OPEN); !opened) {
        return std::unexpected(opened.error());
    }
    const auto size = static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(bytes)));
    if (auto done = card_command(channel, READ_NONVOLATILE | (size << SIZE_SHIFT) | address); !done) {
        return std::unexpected(done.error());
    }
    const auto low = read(user_address(0, channel)), high = read(user_address(1, channel));
    if (auto closed = set_access(CLOSED); !closed) {
        return std::unexpected(closed.error());
    }
    if (!low || !high) {
        return std::unexpected(low ? high.error() : low.error());
    }
    constexpr int ALL_BYTES = 8;
    const std::uint64_t value = *low | (std::uint64_t{*high} << 32U);
    return bytes == ALL_BYTES ? value : value & ((std::uint64_t{1} << static_cast<unsigned>(8 * bytes)) - 1);
}

Result<std::uint32_t> SserialSetup::start_normal(std::uint32_t mask, std::span<const std::uint8_t> modes) {
    if (auto stopped = stop(CHANNEL_MASK); !stopped) {
        return std::unexpected(stopped.error());
    }
    if (auto written = write_modes(mask, modes); !written) {
        return std::unexpected(written.error());
    }
    return start(START_NORMAL, mask);
}

}  // namespace mw::mesa
