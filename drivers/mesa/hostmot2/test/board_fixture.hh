// SPDX-License-Identifier: GPL-2.0-or-later
// A board in memory with its pins in a map, for tests of modules.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/test/firmware.hh"
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
    void read() { board->read(PERIOD_NS, now_ns); }
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
