// SPDX-License-Identifier: GPL-2.0-or-later
// The firmware of a 7I76E for tests, as a description and as registers of a board.
#pragma once

#include <algorithm>
#include <map>

#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::test {

constexpr std::uint32_t CLOCK_LOW = 100'000'000, CLOCK_HIGH = 200'000'000;

/// 17 pins with five step generators and an encoder, 34 general pins.
inline Idrom firmware() {
    Idrom idrom;
    idrom.header.type = 3;
    idrom.header.modules_offset = 0x40;
    idrom.header.pins_offset = 0x1C0;
    idrom.header.board_name = "MESA7I76";
    idrom.header.io_ports = 3;
    idrom.header.port_width = 17;
    idrom.header.io_width = 51;
    idrom.header.clock_low_hz = CLOCK_LOW;
    idrom.header.clock_high_hz = CLOCK_HIGH;
    idrom.header.instance_strides[0] = 4;
    idrom.header.instance_strides[1] = 0x40;
    idrom.header.register_strides[0] = idrom.header.register_strides[1] = 0x100;
    const auto add = [&](Gtag gtag, int version, int instances, int base, int registers) {
        ModuleDescriptor module;
        module.gtag = gtag;
        module.version = static_cast<std::uint8_t>(version);
        module.instances = static_cast<std::uint8_t>(instances);
        module.base_address = static_cast<std::uint16_t>(base);
        module.registers = static_cast<std::uint8_t>(registers);
        module.fast_clock = gtag == Gtag::PWM;
        idrom.modules.push_back(module);
    };
    add(Gtag::DPLL, 0, 1, 0x7000, 7);
    add(Gtag::WATCHDOG, 0, 1, 0x0C00, 3);
    add(Gtag::IO_PORT, 0, 3, 0x1000, 5);
    add(Gtag::STEPGEN, 2, 5, 0x2000, 10);
    add(Gtag::ENCODER, 2, 1, 0x3000, 5);
    add(Gtag::PWM, 0, 2, 0x4000, 5);
    add(Gtag::LED, 0, 1, 0x0200, 1);
    idrom.pins.resize(51);
    const auto use = [&](int pin, Gtag gtag, int unit, int function) {
        idrom.pins[static_cast<std::size_t>(pin)].secondary = gtag;
        idrom.pins[static_cast<std::size_t>(pin)].unit = static_cast<std::uint8_t>(unit);
        idrom.pins[static_cast<std::size_t>(pin)].secondary_pin = static_cast<std::uint8_t>(function);
    };
    for (int i = 0; i < 5; ++i) {
        use(2 * i, Gtag::STEPGEN, i, 0x82);
        use(2 * i + 1, Gtag::STEPGEN, i, 0x81);
    }
    for (int i = 0; i < 3; ++i) {
        use(14 + i, Gtag::ENCODER, 0, 3 - i);
    }
    return idrom;
}

/// The registers that describe a firmware.
inline std::map<std::uint16_t, std::uint32_t> image_of(const Idrom &idrom) {
    constexpr std::uint16_t START = 0x0400;
    std::map<std::uint16_t, std::uint32_t> image;
    const auto put = [&](std::uint32_t address, std::initializer_list<std::uint32_t> words) {
        for (const std::uint32_t word : words) {
            image[static_cast<std::uint16_t>(address)] = word;
            address += 4;
        }
    };
    const auto text = [&](std::uint32_t address, std::string name) {
        name.resize(8);
        for (std::size_t i = 0; i < name.size(); ++i) {
            image[static_cast<std::uint16_t>(address + (i & ~std::size_t{3}))] |=
                static_cast<std::uint32_t>(static_cast<unsigned char>(name[i])) << (8 * (i % 4));
        }
    };
    const IdromHeader &h = idrom.header;
    put(COOKIE_ADDRESS, {COOKIE});
    text(CONFIG_NAME_ADDRESS, "HOSTMOT2");
    put(IDROM_OFFSET_ADDRESS, {START});
    put(START, {h.type, h.modules_offset, h.pins_offset});
    text(START + 12, h.board_name);
    put(START + 20,
        {h.fpga_size, h.fpga_pins, h.io_ports, h.io_width, h.port_width, h.clock_low_hz, h.clock_high_hz,
         h.instance_strides[0], h.instance_strides[1], h.register_strides[0], h.register_strides[1]});
    std::uint32_t at = START + h.modules_offset;
    for (const ModuleDescriptor &m : idrom.modules) {
        put(at, {static_cast<std::uint32_t>(m.gtag) | (std::uint32_t{m.version} << 8U) |
                     ((m.fast_clock ? 2U : 1U) << 16U) | (std::uint32_t{m.instances} << 24U),
                 m.base_address | (std::uint32_t{m.registers} << 16U) |
                     (std::uint32_t{m.register_stride} << 24U) | (std::uint32_t{m.instance_stride} << 28U),
                 m.per_instance});
        at += 12;
    }
    at = START + h.pins_offset;
    for (const PinDescriptor &p : idrom.pins) {
        put(at, {p.secondary_pin | (static_cast<std::uint32_t>(p.secondary) << 8U) |
                 (std::uint32_t{p.unit} << 16U) | (static_cast<std::uint32_t>(p.primary) << 24U)});
        at += 4;
    }
    return image;
}

}  // namespace mw::mesa::test
