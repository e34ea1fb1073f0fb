// SPDX-License-Identifier: GPL-2.0-or-later
// A board in memory with its pins in a map, for tests of modules.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/test/memory_bus.hh"

namespace mw::mesa::test {

/// Pins in memory.
class PinMap final : public PinSpace {
  public:
    struct Pin {
        PinType type = PinType::BIT;
        Access access = Access::IN;
        union {
            bool bit;
            double real;
            std::int32_t s32;
            std::uint32_t u32;
            std::uint64_t all = 0;
        };
        void *slot = nullptr;
    };
    void *const volatile *make(const std::string &name, PinType type, Access access) override {
        EXPECT_FALSE(pins.contains(name)) << name << " exists";
        Pin &pin = pins[name];
        pin.type = type;
        pin.access = access;
        pin.slot = &pin.all;
        return &pin.slot;
    }
    void alias_param(const std::string &name, const std::string &alias) override { aliases[alias] = name; }

    double get(const std::string &name) const {
        const auto found = pins.find(name);
        if (found == pins.end()) {
            ADD_FAILURE() << "no pin " << name;
            return 0.0;
        }
        const Pin &pin = found->second;
        switch (pin.type) {
        case PinType::BIT: return pin.bit ? 1.0 : 0.0;
        case PinType::FLOAT: return pin.real;
        case PinType::S32: return pin.s32;
        case PinType::U32: break;
        }
        return pin.u32;
    }
    void set(const std::string &name, double value) {
        const auto found = pins.find(name);
        if (found == pins.end()) {
            ADD_FAILURE() << "no pin " << name;
            return;
        }
        Pin &pin = found->second;
        switch (pin.type) {
        case PinType::BIT: pin.bit = value != 0.0; return;
        case PinType::FLOAT: pin.real = value; return;
        case PinType::S32: pin.s32 = static_cast<std::int32_t>(value); return;
        case PinType::U32: pin.u32 = static_cast<std::uint32_t>(value); return;
        }
    }

    std::map<std::string, Pin> pins;
    std::map<std::string, std::string> aliases;
};

constexpr std::uint32_t CLOCK_LOW = 100'000'000, CLOCK_HIGH = 200'000'000;

/// The firmware of a 7I76E: 17 pins with five step generators, an encoder and smart serial, 34 general pins.
inline Idrom firmware() {
    Idrom idrom;
    idrom.header.type = 3;
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
    add(Gtag::LED, 0, 4, 0x0200, 1);
    for (int i = 0; i < 51; ++i) {
        idrom.pins.push_back({});
    }
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

constexpr long PERIOD_NS = 1'000'000;
constexpr double PERIOD_S = 1e-3;

/// A board whose watchdog works: status 1 until it is cleared.
class BoardTest : public ::testing::Test {
  protected:
    void load(const Idrom &idrom, const std::string &config = "") {
        bus.registers[0x0D00] = 1;
        const auto parsed = parse_config(config);
        ASSERT_TRUE(parsed.has_value()) << parsed.error().str();
        auto made = Board::make(bus, idrom, *parsed);
        ASSERT_TRUE(made.has_value()) << made.error().str();
        board = std::move(*made);
        board->declare(pins);
    }
    void read() { board->read(PERIOD_NS); }
    void write() {
        now_ns += PERIOD_NS;
        board->write(PERIOD_NS, now_ns);
    }
    void cycle(int count = 1) {
        for (int i = 0; i < count; ++i) {
            read();
            write();
        }
    }

    MemoryBus bus;
    PinMap pins;
    std::unique_ptr<Board> board;
    std::int64_t now_ns = 0;
};

}  // namespace mw::mesa::test
