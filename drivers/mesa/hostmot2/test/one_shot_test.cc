// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include "drivers/mesa/hostmot2/modules/one_shot.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t WIDTH_1 = 0xB100, WIDTH_2 = 0xB200, FILTER_1 = 0xB300, RATE = 0xB500,
                        CONTROL = 0xB600;

class OneShotOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(with_module(module_of(Gtag::ONE_SHOT, 1, WIDTH_1), {1, 2, 0x81, 0x82}));
        cycle();
    }
    const std::string name = "oneshot.00.";
};

/// The words that LinuxCNC's driver writes with the same pins and a clock of 100 MHz.
TEST_F(OneShotOfBoard, HasTheRegistersOfLinuxCnc) {
    EXPECT_EQ(bus.registers[WIDTH_1], 0x186A0U);
    EXPECT_EQ(bus.registers[WIDTH_2], 0x186A0U);
    EXPECT_EQ(bus.registers[FILTER_1], 0x2710U);
    EXPECT_EQ(bus.registers[RATE], 0xA7C5U);
    std::uint32_t expected = 0;
    for (const auto &[pin, bits] : {std::pair{"enable1", 0x40U},
                                    {"enable2", 0x400000U},
                                    {"reset1", 0x80U},
                                    {"reset2", 0x800000U},
                                    {"retriggerable1", 0x20U},
                                    {"retriggerable2", 0x200000U},
                                    {"swtrigger1", 0x400U},
                                    {"swtrigger2", 0x4000000U},
                                    {"trigger_on_fall1", 0x10U},
                                    {"trigger_on_fall2", 0x100000U},
                                    {"trigger_on_rise1", 0x8U},
                                    {"trigger_on_rise2", 0x80000U}}) {
        pins.set(name + pin, 1);
        cycle();
        expected |= bits;
        EXPECT_EQ(bus.registers[CONTROL], expected) << pin;
    }
    pins.set(name + "trigger_select1", 1);
    pins.set(name + "trigger_select2", 5);
    cycle();
    EXPECT_EQ(bus.registers[CONTROL], expected | 1U | (5U << 16U));
    pins.set(name + "dpll_timer_number", 1);
    cycle();
    EXPECT_EQ(bus.registers[CONTROL], expected | 0x1001U | (5U << 16U));
    pins.set(name + "dpll_timer_number", 0);
    pins.set(name + "trigger_select2", 9);
    cycle();
    EXPECT_EQ(bus.registers[CONTROL], expected | 1U) << "no such source";
}

TEST_F(OneShotOfBoard, ShowsItsOutputsAndInputs) {
    for (const auto &[bits, pin] : {std::pair{0x100U, "out1"},
                                    {0x200U, "exttrigger1"},
                                    {0x1000000U, "out2"},
                                    {0x2000000U, "exttrigger2"}}) {
        bus.registers[CONTROL] = bits;
        read();
        for (const char *other : {"out1", "exttrigger1", "out2", "exttrigger2"}) {
            EXPECT_EQ(pins.get(name + other), std::string(other) == pin) << pin;
        }
    }
    bus.registers[CONTROL] = 0;
    bus.next_read = CycleRead::FAILED;
    read();
    EXPECT_EQ(pins.get(name + "exttrigger2"), 1.0);
}

TEST_F(OneShotOfBoard, DisablesInTheSameCycle) {
    pins.set(name + "enable1", 1);
    cycle();
    pins.set(name + "enable1", 0);
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_EQ(bus.registers[CONTROL] & 0x40U, 0U);
}

TEST(OneShotFigures, HoldTheirLimits) {
    for (const double bad : {-1.0, 0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(one_shot_width(bad, CLOCK_LOW), 0U) << bad;
    }
    EXPECT_EQ(one_shot_width(1e9, CLOCK_LOW), 0x7FFFFFFFU);
    EXPECT_EQ(one_shot_filter(1e9, CLOCK_LOW), 0xFFFFFFU);
    EXPECT_EQ(one_shot_rate(1e12, CLOCK_LOW), 0xFFFFFFFFU);
    EXPECT_EQ(one_shot_rate(-5, CLOCK_LOW), 0U);
    for (double ms = 0.001; ms < 1000; ms *= 1.7) {
        EXPECT_NEAR(one_shot_width(ms, CLOCK_LOW) * 1e3 / CLOCK_LOW, ms, 1e-5);
    }
}

}  // namespace
}  // namespace mw::mesa::test
