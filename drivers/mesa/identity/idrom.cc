// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/identity/idrom.hh"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::mesa {

namespace {

constexpr int HEADER_WORDS = 16, MODULE_WORDS = 3, NAME_SIZE = 8;
constexpr int MODULE_BYTES = 4 * MODULE_WORDS, PIN_BYTES = 4;
/// The registers occupy 64 KiB.
constexpr std::uint32_t SPACE_BYTES = 0x10000;
/// The maximum number of registers of one call of the reader, which every bus can read at once.
constexpr int MOST_AT_ONCE = 32;
constexpr std::string_view CONFIG_NAME = "HOSTMOT2";
constexpr std::uint32_t LOWEST_CLOCK_HZ = 1'000'000;
constexpr std::array<std::uint32_t, 8> PORT_WIDTHS{17, 19, 21, 24, 27, 29, 30, 32};
constexpr std::uint32_t CLOCK_LOW_CODE = 1, CLOCK_HIGH_CODE = 2;

using Words = std::vector<std::uint32_t>;

std::uint8_t byte_of(std::uint32_t word, unsigned index) {
    return static_cast<std::uint8_t>((word >> (8 * index)) & 0xFFU);
}

std::uint32_t word_of(unsigned byte0, unsigned byte1, unsigned byte2, unsigned byte3) {
    return byte0 | (byte1 << 8U) | (byte2 << 16U) | (byte3 << 24U);
}

/// The 8 characters of two words.
std::string text_of(std::uint32_t low, std::uint32_t high) {
    std::string text;
    for (unsigned i = 0; i < NAME_SIZE; ++i) {
        text += static_cast<char>(byte_of(i < 4 ? low : high, i % 4));
    }
    return text;
}

/// One of the two words of a name of 8 characters, which is padded with zeros.
std::uint32_t word_of_text(const std::string &text, unsigned index) {
    std::string padded = text;
    padded.resize(NAME_SIZE, '\0');
    const auto at = [&](unsigned i) { return static_cast<unsigned char>(padded[4 * index + i]); };
    return word_of(at(0), at(1), at(2), at(3));
}

Result<Words> read_all(const RegisterReader &read, std::uint32_t address, int count) {
    if (address % 4 != 0 || address + 4U * static_cast<std::uint32_t>(count) > SPACE_BYTES) {
        return fail(fmt::format("IDROM refers to {} registers at 0x{:04X}, outside of the register space",
                                count, address));
    }
    Words all;
    while (static_cast<int>(all.size()) < count) {
        const int wanted = std::min(MOST_AT_ONCE, count - static_cast<int>(all.size()));
        const auto from = static_cast<std::uint16_t>(address + 4 * all.size());
        const auto some = read(from, wanted);
        if (!some.has_value()) {
            return std::unexpected(some.error());
        }
        if (static_cast<int>(some->size()) != wanted) {
            return fail(fmt::format("{} of {} registers were read at 0x{:04X}", some->size(), wanted, from));
        }
        all.insert(all.end(), some->begin(), some->end());
    }
    return all;
}

/// The address of the IDROM.
Result<std::uint32_t> find_idrom(const RegisterReader &read) {
    const auto words = read_all(read, COOKIE_ADDRESS, 4);
    if (!words.has_value()) {
        return std::unexpected(words.error());
    }
    if ((*words)[0] != COOKIE) {
        return fail(fmt::format("invalid cookie, got 0x{:08X}, expected 0x{:08X}", (*words)[0], COOKIE), {},
                    "FPGA failed to initialize, or unexpected firmware?");
    }
    const std::string name = text_of((*words)[1], (*words)[2]);
    if (name != CONFIG_NAME) {
        const bool shown = std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
        return fail(fmt::format("invalid config name, got '{}', expected '{}'",
                                shown ? name : std::string(NAME_SIZE, '?'), CONFIG_NAME));
    }
    return (*words)[3];
}

IdromHeader header_of(const Words &words) {
    IdromHeader header;
    header.type = words[0];
    header.modules_offset = words[1];
    header.pins_offset = words[2];
    header.board_name = text_of(words[3], words[4]);
    header.fpga_size = words[5];
    header.fpga_pins = words[6];
    header.io_ports = words[7];
    header.io_width = words[8];
    header.port_width = words[9];
    header.clock_low_hz = words[10];
    header.clock_high_hz = words[11];
    for (std::size_t i = 0; i < 2; ++i) {
        header.instance_strides[i] = words[12 + i];
        header.register_strides[i] = words[14 + i];
    }
    return header;
}

Result<> check_ports(const IdromHeader &header, const CardShape &card) {
    if (card.port_width != 0 && header.port_width != card.port_width) {
        return fail(
            fmt::format("invalid IDROM PortWidth {}, this board has {} pins per connector, aborting load",
                        header.port_width, card.port_width));
    }
    if (std::ranges::find(PORT_WIDTHS, header.port_width) == PORT_WIDTHS.end()) {
        return fail(fmt::format("invalid IDROM PortWidth {}, expected one of {}, aborting load",
                                header.port_width, fmt::join(PORT_WIDTHS, ", ")));
    }
    if (card.ports != 0 && header.io_ports != card.ports) {
        return fail(fmt::format("IDROM IOPorts is {} but llio num_ioport_connectors is {}, driver and "
                                "firmware are inconsistent, aborting driver load",
                                header.io_ports, card.ports));
    }
    if (header.io_ports == 0) {
        return fail("IDROM IOPorts is 0, expected at least 1, aborting driver load");
    }
    if (header.io_width != std::uint64_t{header.io_ports} * header.port_width) {
        return fail(fmt::format("IDROM IOWidth is {}, but IDROM IOPorts is {} and IDROM PortWidth is {} "
                                "(inconsistent firmware), aborting driver load",
                                header.io_width, header.io_ports, header.port_width));
    }
    if (header.io_width > static_cast<std::uint32_t>(MAX_PINS)) {
        return fail(fmt::format("IDROM IOWidth is {}, at most {} pins are possible, aborting driver load",
                                header.io_width, MAX_PINS));
    }
    return {};
}

Result<> check_header(const IdromHeader &header, const CardShape &card) {
    if (header.type != 2 && header.type != 3) {
        return fail(fmt::format("invalid IDROM type {}, expected 2 or 3, aborting load", header.type));
    }
    if (auto ports = check_ports(header, card); !ports.has_value()) {
        return ports;
    }
    const auto low = [](std::string_view name, std::uint32_t clock_hz) {
        return fail(fmt::format("IDROM {} is {}, that's too low, aborting driver load", name, clock_hz));
    };
    if (header.clock_low_hz < LOWEST_CLOCK_HZ) {
        return low("ClockLow", header.clock_low_hz);
    }
    if (header.clock_high_hz < LOWEST_CLOCK_HZ) {
        return low("ClockHigh", header.clock_high_hz);
    }
    return {};
}

/// `index` counts the descriptors from 0.
Result<ModuleDescriptor> module_of(const Words &words, int index, const IdromHeader &header) {
    ModuleDescriptor module;
    module.gtag = static_cast<Gtag>(byte_of(words[0], 0));
    module.version = byte_of(words[0], 1);
    module.instances = byte_of(words[0], 3);
    module.base_address = static_cast<std::uint16_t>(words[1] & 0xFFFFU);
    module.registers = byte_of(words[1], 2);
    module.register_stride = byte_of(words[1], 3) & 0xFU;
    module.instance_stride = static_cast<std::uint8_t>(byte_of(words[1], 3) >> 4U);
    module.per_instance = words[2];
    const auto failed = [&](const std::string &what) {
        return fail(fmt::format("module descriptor {} (gtag {} at 0x{:04X}) {}, aborting driver load", index,
                                static_cast<unsigned>(module.gtag), module.base_address, what));
    };
    const std::uint32_t clock = byte_of(words[0], 2);
    if (clock != CLOCK_LOW_CODE && clock != CLOCK_HIGH_CODE) {
        return failed(fmt::format("has clock {}, expected 1 (ClockLow) or 2 (ClockHigh)", clock));
    }
    module.fast_clock = clock == CLOCK_HIGH_CODE;
    if (module.register_stride > 1 || module.instance_stride > 1) {
        return failed(fmt::format("uses register stride {} and instance stride {}, expected 0 or 1",
                                  module.register_stride, module.instance_stride));
    }
    const auto steps = [](unsigned count) { return std::uint64_t{count > 0 ? count - 1U : 0U}; };
    const std::uint64_t last = module.base_address +
                               steps(module.registers) * header.register_strides[module.register_stride] +
                               steps(module.instances) * header.instance_strides[module.instance_stride];
    if (last + 4 > SPACE_BYTES) {
        return failed(fmt::format("has its last register at 0x{:X}, outside of the register space", last));
    }
    return module;
}

Result<std::vector<ModuleDescriptor>> read_modules(const RegisterReader &read, std::uint64_t address,
                                                   const IdromHeader &header) {
    std::vector<ModuleDescriptor> modules;
    for (int index = 0; index <= MAX_MODULES; ++index) {
        const auto at = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(address + static_cast<std::uint64_t>(index) * MODULE_BYTES, SPACE_BYTES));
        const auto words = read_all(read, at, MODULE_WORDS);
        if (!words.has_value()) {
            return std::unexpected(words.error());
        }
        if (byte_of((*words)[0], 0) == 0) {
            return modules;
        }
        if (index == MAX_MODULES) {
            break;
        }
        const auto module = module_of(*words, index, header);
        if (!module.has_value()) {
            return std::unexpected(module.error());
        }
        modules.push_back(*module);
    }
    return fail(fmt::format("IDROM lists more than {} modules, aborting driver load", MAX_MODULES));
}

Result<std::vector<PinDescriptor>> read_pins(const RegisterReader &read, std::uint64_t address, int count) {
    const auto words =
        read_all(read, static_cast<std::uint32_t>(std::min<std::uint64_t>(address, SPACE_BYTES)), count);
    if (!words.has_value()) {
        return std::unexpected(words.error());
    }
    std::vector<PinDescriptor> pins;
    for (const std::uint32_t word : *words) {
        if (byte_of(word, 3) == 0) {
            return fail(fmt::format("pin {} primary tag is 0 (end-of-list sentinel), expected {} pins!",
                                    pins.size(), count));
        }
        if (byte_of(word, 3) != static_cast<std::uint8_t>(Gtag::IO_PORT)) {
            return fail(
                fmt::format("pin {} primary tag is {}, but only {} (IOPort) is possible, aborting load",
                            pins.size(), byte_of(word, 3), static_cast<unsigned>(Gtag::IO_PORT)));
        }
        pins.push_back({.secondary_pin = byte_of(word, 0),
                        .secondary = static_cast<Gtag>(byte_of(word, 1)),
                        .unit = byte_of(word, 2),
                        .primary = static_cast<Gtag>(byte_of(word, 3))});
    }
    return pins;
}

/// Checks that each pin has an IO port, whose registers set its direction and source.
Result<> check_io_ports(const Idrom &idrom) {
    std::size_t covered = 0;
    for (const ModuleDescriptor &module : idrom.modules) {
        if (module.gtag == Gtag::IO_PORT) {
            covered += std::size_t{module.instances} * idrom.header.port_width;
        }
    }
    // These pins have no IO port. LinuxCNC's driver reports two errors for each of them.
    std::string lines;
    for (std::size_t pin = covered; pin < idrom.pins.size(); ++pin) {
        lines += fmt::format("{0}hm2_set_pin_source: invalid pin number {1}\n"
                             "hm2_set_pin_direction_immediate: invalid pin number {1}",
                             lines.empty() ? "" : "\n", pin);
    }
    if (!lines.empty()) {
        return fail(lines);
    }
    return {};
}

}  // namespace

Result<Idrom> decode_idrom(const RegisterReader &read, const CardShape &card) {
    const auto base = find_idrom(read);
    if (!base.has_value()) {
        return std::unexpected(base.error());
    }
    const auto words = read_all(read, std::min(*base, SPACE_BYTES), HEADER_WORDS);
    if (!words.has_value()) {
        return std::unexpected(words.error());
    }
    Idrom idrom{.header = header_of(*words), .modules = {}, .pins = {}};
    if (auto header = check_header(idrom.header, card); !header.has_value()) {
        return std::unexpected(header.error());
    }
    // LinuxCNC's driver reads the pins first, so of two errors the same one is reported.
    auto pins = read_pins(read, std::uint64_t{*base} + idrom.header.pins_offset,
                          static_cast<int>(idrom.header.io_width));
    if (!pins.has_value()) {
        return std::unexpected(pins.error());
    }
    auto modules = read_modules(read, std::uint64_t{*base} + idrom.header.modules_offset, idrom.header);
    if (!modules.has_value()) {
        return std::unexpected(modules.error());
    }
    idrom.pins = std::move(*pins);
    idrom.modules = std::move(*modules);
    if (auto ports = check_io_ports(idrom); !ports.has_value()) {
        return std::unexpected(ports.error());
    }
    return idrom;
}

namespace {

/// Appends `words`, beginning with `address`.
void put(std::vector<RegisterValue> &registers, std::uint64_t address, std::span<const std::uint32_t> words) {
    for (const std::uint32_t word : words) {
        registers.push_back({static_cast<std::uint16_t>(address), word});
        address += 4;
    }
}

Words words_of(const IdromHeader &header) {
    return {header.type,
            header.modules_offset,
            header.pins_offset,
            word_of_text(header.board_name, 0),
            word_of_text(header.board_name, 1),
            header.fpga_size,
            header.fpga_pins,
            header.io_ports,
            header.io_width,
            header.port_width,
            header.clock_low_hz,
            header.clock_high_hz,
            header.instance_strides[0],
            header.instance_strides[1],
            header.register_strides[0],
            header.register_strides[1]};
}

Words words_of(const ModuleDescriptor &module) {
    const std::uint32_t strides = (module.register_stride & 0xFU) | ((module.instance_stride & 0xFU) << 4U);
    return {word_of(static_cast<unsigned>(module.gtag), module.version,
                    module.fast_clock ? CLOCK_HIGH_CODE : CLOCK_LOW_CODE, module.instances),
            module.base_address | (std::uint32_t{module.registers} << 16U) | (strides << 24U),
            module.per_instance};
}

std::uint32_t word_of(const PinDescriptor &pin) {
    return word_of(pin.secondary_pin, static_cast<unsigned>(pin.secondary), pin.unit,
                   static_cast<unsigned>(pin.primary));
}

/// Checks that the parts of the description are in this order and do not overlap.
Result<> check_layout(const Idrom &idrom, std::uint64_t offset) {
    const std::uint64_t modules = offset + idrom.header.modules_offset;
    const std::uint64_t pins = offset + idrom.header.pins_offset;
    const std::uint64_t modules_end = modules + MODULE_BYTES * (idrom.modules.size() + 1);
    const std::uint64_t pins_end = pins + PIN_BYTES * idrom.pins.size();
    if (modules < offset + 4ULL * HEADER_WORDS) {
        return fail(fmt::format("The modules at offset 0x{:X} overlap the header of the IDROM.",
                                idrom.header.modules_offset));
    }
    if (pins < modules_end) {
        return fail(fmt::format("The pins at offset 0x{:X} overlap {} modules at offset 0x{:X}.",
                                idrom.header.pins_offset, idrom.modules.size(), idrom.header.modules_offset));
    }
    if (pins_end > SPACE_BYTES) {
        return fail(fmt::format("The description ends at 0x{:X}, outside of the register space.", pins_end));
    }
    return {};
}

}  // namespace

Result<std::vector<RegisterValue>> encode_idrom(const Idrom &idrom, std::uint16_t offset) {
    if (auto layout = check_layout(idrom, offset); !layout.has_value()) {
        return std::unexpected(layout.error());
    }
    const std::string name(CONFIG_NAME);
    std::vector<RegisterValue> registers;
    put(registers, COOKIE_ADDRESS, Words{COOKIE, word_of_text(name, 0), word_of_text(name, 1), offset});
    put(registers, offset, words_of(idrom.header));
    std::uint64_t at = std::uint64_t{offset} + idrom.header.modules_offset;
    for (const ModuleDescriptor &module : idrom.modules) {
        put(registers, at, words_of(module));
        at += MODULE_BYTES;
    }
    put(registers, at, Words{0, 0, 0});
    at = std::uint64_t{offset} + idrom.header.pins_offset;
    for (const PinDescriptor &pin : idrom.pins) {
        put(registers, at, Words{word_of(pin)});
        at += PIN_BYTES;
    }
    return registers;
}

}  // namespace mw::mesa
