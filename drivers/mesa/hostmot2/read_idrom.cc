// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/read_idrom.hh"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

constexpr std::uint32_t MIN_CLOCK_HZ = 1'000'000;
constexpr int HEADER_WORDS = 16, MODULE_WORDS = 3, NAME_WORDS = 2;
constexpr std::string_view EXPECTED_NAME = "HOSTMOT2";

std::uint8_t byte_of(std::uint32_t word, int number) noexcept {
    return static_cast<std::uint8_t>(word >> (8U * static_cast<unsigned>(number)));
}

/// Eight characters of two words; what cannot be printed is '?'.
std::string name_of(std::span<const std::uint32_t> words) {
    std::string name;
    for (const std::uint32_t word : words.first(NAME_WORDS)) {
        for (int i = 0; i < 4; ++i) {
            const char c = static_cast<char>(byte_of(word, i));
            name += c >= ' ' && c <= '~' ? c : '?';
        }
    }
    return name;
}

Result<> check_cookie(RegisterBus &bus) {
    const auto cookie = bus.read_now({COOKIE_ADDRESS, 1});
    if (!cookie) {
        return std::unexpected(cookie.error());
    }
    if (cookie->front() != COOKIE) {
        return fail(fmt::format("invalid cookie, got 0x{:08X}, expected 0x{:08X}\n"
                                "FPGA failed to initialize, or unexpected firmware?",
                                cookie->front(), COOKIE));
    }
    const auto words = bus.read_now({CONFIG_NAME_ADDRESS, NAME_WORDS});
    if (!words) {
        return std::unexpected(words.error());
    }
    if (const std::string name = name_of(*words); name != EXPECTED_NAME) {
        return fail(fmt::format("invalid config name, got '{}', expected '{}'", name, EXPECTED_NAME));
    }
    return {};
}

IdromHeader header_of(std::span<const std::uint32_t> words) {
    IdromHeader header;
    header.type = words[0];
    header.modules_offset = words[1];
    header.pins_offset = words[2];
    header.board_name = name_of(words.subspan(3));
    header.fpga_size = words[5];
    header.fpga_pins = words[6];
    header.io_ports = words[7];
    header.io_width = words[8];
    header.port_width = words[9];
    header.clock_low_hz = words[10];
    header.clock_high_hz = words[11];
    std::copy_n(words.begin() + 12, 2, header.instance_strides);
    std::copy_n(words.begin() + 14, 2, header.register_strides);
    return header;
}

/// The firmware has to have the ports of the card, with as many pins.
Result<> check_ports(const IdromHeader &header, const RegisterBus &bus) {
    const auto ports = static_cast<std::uint32_t>(bus.connectors().size());
    const auto width = static_cast<std::uint32_t>(bus.port_width());
    constexpr std::uint32_t MOST_WIDTH = 32;
    if ((width != 0 && header.port_width != width) || header.port_width == 0 ||
        header.port_width > MOST_WIDTH) {
        return fail(
            fmt::format("invalid IDROM PortWidth {}, this board has {} pins per connector, aborting load",
                        header.port_width, width));
    }
    if ((ports != 0 && header.io_ports != ports) || header.io_ports == 0) {
        return fail(
            fmt::format("IDROM IOPorts is {} but llio num_ioport_connectors is {}, driver and firmware are "
                        "inconsistent, aborting driver load",
                        header.io_ports, ports));
    }
    const bool isWidthWrong =
        header.io_ports > MAX_PINS || header.io_width != header.io_ports * header.port_width;
    if (isWidthWrong || header.io_width > MAX_PINS) {
        return fail(fmt::format("IDROM IOWidth is {}, but IDROM IOPorts is {} and IDROM PortWidth is {} "
                                "(inconsistent firmware), aborting driver load",
                                header.io_width, header.io_ports, header.port_width));
    }
    return {};
}

Result<> check_header(const IdromHeader &header, const RegisterBus &bus) {
    if (header.type != 2 && header.type != 3) {
        return fail(fmt::format("invalid IDROM type {}, expected 2 or 3, aborting load", header.type));
    }
    if (auto ports = check_ports(header, bus); !ports) {
        return ports;
    }
    for (const auto &[name, hz] :
         {std::pair{"ClockLow", header.clock_low_hz}, {"ClockHigh", header.clock_high_hz}}) {
        if (hz < MIN_CLOCK_HZ) {
            return fail(fmt::format("IDROM {} is {}, that's too low, aborting driver load", name, hz));
        }
    }
    return {};
}

ModuleDescriptor module_of(std::span<const std::uint32_t> words) {
    constexpr std::uint8_t HIGH_CLOCK = 2, LOW_NIBBLE = 0x0F;
    ModuleDescriptor module;
    module.gtag = static_cast<Gtag>(byte_of(words[0], 0));
    module.version = byte_of(words[0], 1);
    module.fast_clock = byte_of(words[0], 2) == HIGH_CLOCK;
    module.instances = byte_of(words[0], 3);
    module.base_address = static_cast<std::uint16_t>(words[1]);
    module.registers = byte_of(words[1], 2);
    module.register_stride = byte_of(words[1], 3) & LOW_NIBBLE;
    module.instance_stride = byte_of(words[1], 3) >> 4U;
    module.per_instance = words[2];
    return module;
}

Result<> read_modules(RegisterBus &bus, std::uint32_t address, Idrom &idrom) {
    for (int i = 0; i < MAX_MODULES; ++i) {
        const auto at = static_cast<std::uint16_t>(address + 4U * MODULE_WORDS * static_cast<unsigned>(i));
        const auto words = bus.read_now({at, MODULE_WORDS});
        if (!words) {
            return std::unexpected(words.error());
        }
        const ModuleDescriptor module = module_of(*words);
        if (module.gtag == Gtag::NONE) {
            break;
        }
        idrom.modules.push_back(module);
    }
    return {};
}

Result<> read_pins(RegisterBus &bus, std::uint32_t address, Idrom &idrom) {
    for (std::uint32_t i = 0; i < idrom.header.io_width; ++i) {
        const auto words = bus.read_now({static_cast<std::uint16_t>(address + 4U * i), 1});
        if (!words) {
            return std::unexpected(words.error());
        }
        PinDescriptor pin;
        pin.secondary_pin = byte_of(words->front(), 0);
        pin.secondary = static_cast<Gtag>(byte_of(words->front(), 1));
        pin.unit = byte_of(words->front(), 2);
        pin.primary = static_cast<Gtag>(byte_of(words->front(), 3));
        if (pin.primary == Gtag::NONE) {
            return fail(fmt::format("pin {} primary tag is 0 (end-of-list sentinel), expected {} pins!", i,
                                    idrom.header.io_width));
        }
        if (pin.primary != Gtag::IO_PORT) {
            return fail(
                fmt::format("pin {} primary tag is {}, but only {} (IOPort) is possible, aborting load", i,
                            static_cast<int>(pin.primary), static_cast<int>(Gtag::IO_PORT)));
        }
        idrom.pins.push_back(pin);
    }
    return {};
}

/// Without the module of the ports no pin can be read or written.
Result<> check_modules(const Idrom &idrom) {
    const bool hasPorts =
        std::ranges::find(idrom.modules, Gtag::IO_PORT, &ModuleDescriptor::gtag) != idrom.modules.end();
    if (!hasPorts) {
        return fail(
            fmt::format("firmware has {} pins but no IOPort module, aborting load", idrom.pins.size()));
    }
    return {};
}

}  // namespace

Result<Idrom> read_idrom(RegisterBus &bus) {
    if (auto cookie = check_cookie(bus); !cookie) {
        return std::unexpected(cookie.error());
    }
    const auto offset = bus.read_now({IDROM_OFFSET_ADDRESS, 1});
    if (!offset) {
        return std::unexpected(offset.error());
    }
    const std::uint32_t start = offset->front();
    const auto words = bus.read_now({static_cast<std::uint16_t>(start), HEADER_WORDS});
    if (!words) {
        return std::unexpected(words.error());
    }
    Idrom idrom;
    idrom.header = header_of(*words);
    if (auto header = check_header(idrom.header, bus); !header) {
        return std::unexpected(header.error());
    }
    if (auto modules = read_modules(bus, start + idrom.header.modules_offset, idrom); !modules) {
        return std::unexpected(modules.error());
    }
    if (auto pins = read_pins(bus, start + idrom.header.pins_offset, idrom); !pins) {
        return std::unexpected(pins.error());
    }
    if (auto modules = check_modules(idrom); !modules) {
        return std::unexpected(modules.error());
    }
    return idrom;
}

}  // namespace mw::mesa
