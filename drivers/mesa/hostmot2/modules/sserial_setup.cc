// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_setup.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

constexpr std::uint32_t RESET = 0x4000, READ_LOCAL = 0x2000, STOP = 0x800, START_NORMAL = 0x900,
                        START_SETUP = 0xF00, DO_IT = 0x1000, READ_CARD_BYTE = 0x4C000000;
/// Bit 31 of the command register has another use.
constexpr std::uint32_t COMMAND_MASK = 0x7FFFFFFF, CHANNEL_MASK = 0xFF;
constexpr int MOST_LOOKS = 5000, OLDEST_MINOR = 43;
enum LocalAddress : std::uint16_t { MAJOR = 2, MINOR = 3, CHANNELS = 7 };

}  // namespace

Result<std::uint32_t> SserialSetup::read(std::uint16_t address) {
    const auto words = bus_.read_now({address, 1});
    if (!words) {
        return std::unexpected(words.error());
    }
    return words->front();
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

Result<std::uint32_t> SserialSetup::start_setup(std::uint32_t mask) {
    if (auto stopped = stop(CHANNEL_MASK); !stopped) {
        return std::unexpected(stopped.error());
    }
    for (int channel = 0; channel < MAX_CHANNELS; ++channel) {
        const bool isWanted = ((mask >> static_cast<unsigned>(channel)) & 1U) != 0;
        if (!isWanted) {
            continue;
        }
        if (auto written = write(status_address(channel), 0); !written) {
            return std::unexpected(written.error());
        }
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
        const bool isCapital = c >= 'A' && c <= 'Z';
        card.name += isCapital ? static_cast<char>(c - 'A' + 'a') : c;
    }
    card.ptoc = static_cast<std::uint16_t>(words[2]);
    card.gtoc = static_cast<std::uint16_t>(words[2] >> 16U);
    return card;
}

Result<std::uint8_t> SserialSetup::read_card_byte(int channel, std::uint16_t address) {
    constexpr std::uint32_t FAULTS = 0xFF00;
    if (auto written = write(status_address(channel), READ_CARD_BYTE | address); !written) {
        return std::unexpected(written.error());
    }
    if (auto done = command(DO_IT | (1U << static_cast<unsigned>(channel))); !done) {
        return std::unexpected(done.error());
    }
    const auto status = read(status_address(channel));
    if (!status) {
        return std::unexpected(status.error());
    }
    if ((*status & FAULTS) != 0) {
        return fail(
            fmt::format("The card of smart serial channel {}.{} does not answer (status 0x{:08X}). Check its "
                        "cable and supply.",
                        instance_, channel, *status));
    }
    const auto byte = read(user_address(0, channel));
    if (!byte) {
        return std::unexpected(byte.error());
    }
    return static_cast<std::uint8_t>(*byte);
}

Result<std::uint32_t> SserialSetup::start_normal(std::uint32_t mask, std::span<const std::uint8_t> modes) {
    constexpr unsigned MODE_SHIFT = 24;
    if (auto stopped = stop(CHANNEL_MASK); !stopped) {
        return std::unexpected(stopped.error());
    }
    int channel = 0;
    for (const std::uint8_t mode : modes) {
        if (auto written = write(status_address(channel++), std::uint32_t{mode} << MODE_SHIFT); !written) {
            return std::unexpected(written.error());
        }
    }
    return start(START_NORMAL, mask);
}

}  // namespace mw::mesa
