// SPDX-License-Identifier: GPL-2.0-or-later
// Index and probe latches and tables of step generators.
#include <cmath>
#include <random>

#include "drivers/mesa/hostmot2/modules/stepgen.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t ACCUMULATOR = 0x2100, MODE = 0x2200, TABLE = 0x2700, LENGTH = 0x2800;
constexpr std::uint32_t INDEX = 0x10, PROBE = 0x40;

/// Simulates the latches of the board: the position at an event is in the high 24 bits of the mode register.
class LatchOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        ModuleDescriptor module = module_of(Gtag::STEPGEN, 1, 0x2000);
        module.version = 0xC2;
        load(with_module(module, {0x81, 0x82, 0x83, 0x84, 1, 2}), "stepgen_width=4");
        bus.on_write = [&](RegisterWrite write) {
            if (write.address == MODE) {
                bus.registers[MODE] = (bus.registers[MODE] & 0xFFFFFF00U) | (write.value & 0xFFU);
                ++mode_writes;
            } else if (write.address == TABLE) {
                table.push_back(write.value);
            }
        };
        bus.registers[ACCUMULATOR] = 0;
        cycle();
    }
    /// An event at a position [steps].
    void event(std::uint32_t bit, double at) {
        if ((bus.registers[MODE] & bit) != 0) {
            const auto latched = static_cast<std::uint32_t>(static_cast<std::int64_t>(at * 65536.0));
            bus.registers[MODE] = (latched & 0xFFFFFF00U) | (bus.registers[MODE] & 0xFFU & ~bit);
            ++events;
        }
    }
    void stand_at(double steps) {
        bus.registers[ACCUMULATOR] = static_cast<std::uint32_t>(static_cast<std::int64_t>(steps * 65536.0));
    }

    const std::string name = "stepgen.00.";
    int mode_writes = 0, events = 0;
    std::vector<std::uint32_t> table;
};

TEST_F(LatchOfBoard, IndexMakesItsPositionTheZero) {
    stand_at(100);
    pins.set(name + "position-scale", 10);
    pins.set(name + "index-enable", 1);
    cycle(3);
    EXPECT_EQ(pins.get(name + "index-enable"), 1.0);
    EXPECT_EQ(bus.registers[MODE] & INDEX, INDEX);
    event(INDEX, 103.5);
    stand_at(105);
    cycle();
    EXPECT_EQ(pins.get(name + "index-enable"), 0.0);
    EXPECT_NEAR(pins.get(name + "position-fb"), 0.15, 1e-6);
    EXPECT_EQ(pins.get(name + "counts"), 1.0);
    cycle();
    EXPECT_EQ(bus.registers[MODE] & INDEX, 0U);
}

TEST_F(LatchOfBoard, ProbeLatchesWithoutMovingTheZero) {
    stand_at(-50);
    pins.set(name + "probe-enable", 1);
    pins.set(name + "probe-invert", 1);
    cycle(2);
    EXPECT_EQ(bus.registers[MODE] & 0xF0U, PROBE | 0x80U);
    event(PROBE, -51.25);
    stand_at(-60);
    cycle();
    EXPECT_EQ(pins.get(name + "probe-enable"), 0.0);
    EXPECT_EQ(pins.get(name + "position-latch"), -51.25);
    EXPECT_EQ(pins.get(name + "position-fb"), -60.0);
}

TEST_F(LatchOfBoard, AnArmIsRemovedWhenTheRequestEnds) {
    pins.set(name + "index-enable", 1);
    cycle(2);
    pins.set(name + "index-enable", 0);
    cycle();
    EXPECT_EQ(bus.registers[MODE] & INDEX, 0U);
}

TEST_F(LatchOfBoard, NeitherLosesNorRepeatsAnEventWhenPacketsAreLost) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> speed(0.1, 40.0);
    double position = 0.0;
    constexpr double REV = 200.0;
    // Two consecutive events are not at the same 1/256 of a step; only then the loss of the answer after the
    // arm could hide an event.
    for (int round = 0; round < 3000; ++round) {
        const double velocity = speed(random) * (random() % 2 == 0 ? 1 : -1);
        pins.set(name + "index-enable", 1);
        const int before = events;
        double at = 0.0;
        for (int i = 0; pins.get(name + "index-enable") != 0.0; ++i) {
            ASSERT_LT(i, 20'000) << "lost in round " << round;
            bus.next_write_lost = random() % 7 == 0;
            bus.next_read = random() % 5 == 0 ? CycleRead::FAILED : CycleRead::DONE;
            const double next = position + velocity;
            const double mark = velocity > 0 ? std::floor(next / REV) * REV : std::ceil(next / REV) * REV;
            const bool passed = velocity > 0 ? mark > position : mark < position;
            if (passed && events == before) {
                at = mark + (round % 50) / 256.0;
                event(INDEX, at);
            }
            position = next;
            stand_at(position);
            cycle();
        }
        ASSERT_EQ(events, before + 1) << round;
        ASSERT_NEAR(pins.get(name + "position-fb"), position - at, 0.01) << round;
        // The arm of a past event is removed before the next request.
        for (int i = 0; i < 3; ++i) {
            cycle();
        }
        ASSERT_EQ(bus.registers[MODE] & INDEX, 0U) << round;
    }
}

TEST_F(LatchOfBoard, TablesAreWrittenFromTheLastStepOn) {
    EXPECT_TRUE(table.empty());
    pins.set(name + "table-data-0", 0x04030201);
    pins.set(name + "table-data-1", 0x08070605);
    pins.set(name + "step_type", 6);
    cycle();
    EXPECT_EQ(table, (std::vector<std::uint32_t>{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(bus.registers[LENGTH], 5U);
    EXPECT_EQ(bus.registers[MODE] & 7U, 3U);
    table.clear();
    pins.set(name + "step_type", 4);
    bus.next_write_lost = true;
    cycle(3);
    EXPECT_EQ(table, (std::vector<std::uint32_t>{4, 3, 2, 1})) << "whole again after a lost packet";
    pins.set(name + "step_type", 99);
    cycle();
    EXPECT_EQ(pins.get(name + "step_type"), 16.0);
    EXPECT_EQ(bus.registers[LENGTH], 15U);
}

TEST_F(LatchOfBoard, SwapsOutputs) {
    pins.set(name + "swap_step_dir", 1);
    cycle();
    EXPECT_EQ(bus.registers[MODE] & 7U, 4U);
}

TEST_F(LatchOfBoard, PinsOutsideTheWidthAreGeneral) {
    EXPECT_FALSE(pins.pins.contains("gpio.023.out")) << "the fourth output";
    EXPECT_TRUE(pins.aliases.contains("stepgen.00.table3.invert_output"));
    PinMap others;
    auto narrow = Board::make(bus, firmware(), *parse_config(""));
    ASSERT_TRUE(narrow.has_value());
    (*narrow)->declare(others);
    EXPECT_TRUE(others.pins.contains(name + "table-data-0")) << "as with LinuxCNC";
    EXPECT_FALSE(others.aliases.contains("stepgen.00.table3.invert_output"));
    EXPECT_FALSE(others.pins.contains(name + "index-enable"));
}

}  // namespace
}  // namespace mw::mesa::test
