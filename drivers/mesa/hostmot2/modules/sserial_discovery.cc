// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_discovery.hh"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "drivers/mesa/hostmot2/modules/sserial_setup.hh"

namespace mw::mesa {

namespace {

constexpr int COMMAND_REGISTERS = 3, WORD_BITS = 32;
enum PortRegister { DIRECTION = 1, SOURCE = 2 };

bool isSerial(Gtag gtag) noexcept {
    return gtag == Gtag::SMART_SERIAL || gtag == Gtag::SMART_SERIAL_B;
}

/// Receive 1 to 8, transmit 0x81 to 0x88, enables 0x91 and 0xA1.
int channel_of(const UsedPin &pin) noexcept {
    constexpr unsigned NUMBER = 0x0F;
    return static_cast<int>(pin.function & NUMBER) - 1;
}

/// The channels of a port that the configuration uses and that have pins.
std::uint32_t wanted_channels(const Assignment &assignment, const Config &config, int port) {
    std::uint32_t mask = 0;
    const std::string &modes = config.sserial_modes[static_cast<std::size_t>(port)];
    for (const UsedPin &pin : assignment.pins) {
        const int channel = channel_of(pin);
        if (!isSerial(pin.module) || pin.instance != port || channel < 0 || channel >= MAX_CHANNELS) {
            continue;
        }
        const auto number = static_cast<std::size_t>(channel);
        const bool omitted = number < modes.size() && modes[number] == 'x';
        mask |= omitted ? 0U : 1U << number;
    }
    return mask;
}

std::array<std::uint8_t, MAX_CHANNELS> modes_of(const Config &config, int port) {
    std::array<std::uint8_t, MAX_CHANNELS> modes{};
    const std::string &text = config.sserial_modes[static_cast<std::size_t>(port)];
    for (std::size_t i = 0; i < std::min(text.size(), modes.size()); ++i) {
        modes[i] = text[i] == 'x' ? std::uint8_t{0} : static_cast<std::uint8_t>(text[i] - '0');
    }
    return modes;
}

/// Number of bytes in which a card stores a value.
int bytes_of(int bits) noexcept {
    constexpr int BITS = 8;
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>((std::max(bits, 1) + BITS - 1) / BITS)));
}

bool isNonVolatile(FieldType type) noexcept {
    return type == FieldType::NV_UNSIGNED || type == FieldType::NV_SIGNED || type == FieldType::NV_FLOAT;
}

class PortDiscovery {
  public:
    PortDiscovery(SserialSetup &setup, int port, int most_bits)
        : setup_(setup), port_(port), most_bits_(most_bits) {}

    /// `baudrate` [bit/s] of all channels; up to 0: that of the firmware.
    Result<FoundPort> find(std::uint32_t wanted, std::span<const std::uint8_t> modes, int baudrate) {
        FoundPort found;
        found.port = port_;
        auto processor = setup_.reset();
        if (!processor) {
            return std::unexpected(processor.error());
        }
        if (baudrate > 0) {
            if (auto set = setup_.set_baudrate(processor->channels, static_cast<std::uint32_t>(baudrate));
                !set) {
                return std::unexpected(set.error());
            }
        }
        const std::uint32_t channels = (1U << static_cast<unsigned>(processor->channels)) - 1U;
        const auto answering = setup_.start_setup(wanted & channels, modes);
        if (!answering) {
            return std::unexpected(answering.error());
        }
        for (int channel = 0; channel < MAX_CHANNELS; ++channel) {
            const auto number = static_cast<std::size_t>(channel);
            if (((*answering >> number) & 1U) == 0) {
                continue;
            }
            auto card = read_card(channel, modes[number]);
            if (card) {
                found.cards.push_back(std::move(*card));
            } else {
                warnings.push_back(fmt::format("Smart serial card at channel {}.{} is not used: {}", port_,
                                               channel, card.error().message));
            }
        }
        if (auto stopped = setup_.stop(channels); !stopped) {
            return std::unexpected(stopped.error());
        }
        return found;
    }
    std::vector<std::string> warnings;

  private:
    Result<FoundCard> read_card(int channel, std::uint8_t mode) {
        const auto identity = setup_.card(channel);
        if (!identity) {
            return std::unexpected(identity.error());
        }
        const auto read = [&](std::uint16_t address) { return setup_.read_card_byte(channel, address); };
        auto records = read_card_records(read, identity->ptoc, identity->gtoc);
        if (!records) {
            return std::unexpected(records.error());
        }
        check_mode(*identity, channel, mode, records->modes);
        FoundCard card;
        card.channel = channel;
        card.mode = mode;
        card.name = identity->name;
        card.serial_number = identity->serial_number;
        auto layout = process_layout(records->process, most_bits_);
        if (!layout) {
            return std::unexpected(layout.error());
        }
        card.layout = std::move(*layout);
        card.process = std::move(records->process);
        for (DataRecord &record : records->parameters) {
            const int bytes = bytes_of(record.bits);
            const auto value = isNonVolatile(record.type)
                                   ? setup_.read_nonvolatile_value(channel, record.value_address, bytes)
                                   : setup_.read_card_value(channel, record.value_address, bytes);
            if (!value) {
                return std::unexpected(value.error());
            }
            card.parameters.push_back({std::move(record), *value});
        }
        return card;
    }
    void check_mode(const SserialCard &card, int channel, int mode, const std::vector<ModeRecord> &modes) {
        std::vector<std::string> software;
        bool has_mode = false;
        for (const ModeRecord &one : modes) {
            if (one.is_software) {
                software.push_back(fmt::format("{} ({})", one.index, one.name));
                has_mode = has_mode || one.index == mode;
            }
        }
        if (!software.empty() && !has_mode) {
            warnings.push_back(fmt::format("Smart serial card {}.{}.{} has no mode {}. It has {}. Change "
                                           "sserial_port_{} in config=.",
                                           card.name, port_, channel, mode, fmt::join(software, ", "),
                                           port_));
        }
    }

    SserialSetup &setup_;
    int port_, most_bits_;
};

/// While the cards are searched, the pins of smart serial belong to their module and all other pins are
/// inputs. `isOn` false: all pins are inputs.
enum class PinUse : std::uint8_t { NONE, SERIAL };
Result<> set_pins(RegisterBus &bus, const Idrom &idrom, const Assignment &assignment, PinUse use) {
    const auto ports = std::ranges::find(assignment.modules, Gtag::IO_PORT,
                                         [](const UsedModule &one) { return one.descriptor.gtag; });
    const auto width = static_cast<std::size_t>(idrom.header.port_width);
    if (ports == assignment.modules.end() || width == 0) {
        return {};
    }
    int port = 0;
    for (std::size_t first = 0; first < assignment.pins.size(); first += width, ++port) {
        std::uint32_t direction = 0, source = 0;
        for (std::size_t i = 0; i < width && first + i < assignment.pins.size(); ++i) {
            const UsedPin &pin = assignment.pins[first + i];
            const bool own = use == PinUse::SERIAL && isSerial(pin.module);
            source |= own ? 1U << i : 0U;
            direction |= own && pin.isOutputOfModule() ? 1U << i : 0U;
        }
        for (const auto &[reg, word] : {std::pair{DIRECTION, direction}, {SOURCE, source}}) {
            if (auto done = bus.write_now(ports->address(reg, port), {&word, 1}); !done) {
                return done;
            }
        }
    }
    return {};
}

bool hasCard(const std::vector<FoundPort> &ports, const UsedPin &pin) {
    return std::ranges::any_of(ports, [&](const FoundPort &port) {
        return port.port == pin.instance &&
               std::ranges::find(port.cards, channel_of(pin), &FoundCard::channel) != port.cards.end();
    });
}

}  // namespace

int user_registers(const UsedModule &module) noexcept {
    // The descriptor of version B has the number of user registers; the first version always has 3.
    return module.descriptor.gtag == Gtag::SMART_SERIAL_B
               ? std::max(module.descriptor.registers - COMMAND_REGISTERS, 3)
               : 3;
}

Result<> discover_sserial(RegisterBus &bus, const Idrom &idrom, const Config &config,
                          Assignment &assignment) {
    constexpr auto PAUSE = std::chrono::microseconds(50);
    const auto module = std::ranges::find_if(
        assignment.modules, [](const UsedModule &one) { return isSerial(one.descriptor.gtag); });
    if (module == assignment.modules.end()) {
        return {};
    }
    const int ports = std::min(module->instances, MAX_SMART_SERIAL_PORTS);
    bool any_wanted = false;
    for (int port = 0; port < ports; ++port) {
        any_wanted = any_wanted || wanted_channels(assignment, config, port) != 0;
    }
    if (any_wanted) {
        if (auto done = set_pins(bus, idrom, assignment, PinUse::SERIAL); !done) {
            return done;
        }
    }
    for (int port = 0; port < ports; ++port) {
        const std::uint32_t wanted = wanted_channels(assignment, config, port);
        if (wanted == 0) {
            continue;
        }
        SserialSetup setup(bus, *module, port, [&] { bus.pause_now(PAUSE); });
        PortDiscovery discovery(setup, port, user_registers(*module) * WORD_BITS);
        auto found = discovery.find(wanted, modes_of(config, port), config.sserial_baudrate);
        std::ranges::move(discovery.warnings, std::back_inserter(assignment.warnings));
        if (!found) {
            assignment.warnings.push_back(found.error().message);
        } else if (!found->cards.empty()) {
            assignment.serial_ports.push_back(std::move(*found));
        }
    }
    for (UsedPin &pin : assignment.pins) {
        if (isSerial(pin.module) && !hasCard(assignment.serial_ports, pin)) {
            pin.module = Gtag::NONE;
            pin.instance = 0;
            pin.function = 0;
        }
    }
    return any_wanted ? set_pins(bus, idrom, assignment, PinUse::NONE) : Result<>{};
}

}  // namespace mw::mesa
