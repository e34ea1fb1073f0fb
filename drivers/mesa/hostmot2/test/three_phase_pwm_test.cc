// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>
#include <random>

#include "drivers/mesa/hostmot2/modules/three_phase_pwm.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

/// Simulates the board: a fault clears the enable bit and sets the fault bit until the enable bit is written.
class ThreePhaseOfBoard : public BoardTest {
  protected:
    static constexpr std::uint16_t VALUE = 0x4600, ENABLE = 0x4700, SETUP = 0x4800, RATE = 0x4900;

    void SetUp() override {
        ModuleDescriptor module = module_of(Gtag::THREE_PHASE_PWM, 1, VALUE);
        module.fast_clock = true;
        load(with_module(module, {0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x08}));
        bus.on_write = [&](RegisterWrite write) {
            if (write.address == ENABLE) {
                enable_writes += write.value;
                bus.registers[ENABLE] = has_fault_input && write.value == 1 ? 2U : write.value;
            }
        };
        cycle();
    }
    void fault() {
        bus.registers[ENABLE] = 2;
        has_fault_input = true;
    }
    bool isEnabled() { return (bus.registers[ENABLE] & 1U) != 0; }

    const std::string name = "3pwmgen.00.";
    bool has_fault_input = false;
    std::uint32_t enable_writes = 0;
};

/// The words that LinuxCNC's driver writes with the same values and a clock of 200 MHz.
TEST_F(ThreePhaseOfBoard, HasTheRegistersOfLinuxCnc) {
    EXPECT_EQ(bus.registers[VALUE], 0x20080200U);
    EXPECT_EQ(bus.registers[RATE], 0x346DU);
    EXPECT_EQ(bus.registers[SETUP] >> 16U, 0x1FFU);
    pins.set(name + "A-value", 0.5);
    pins.set(name + "B-value", -0.5);
    pins.set(name + "C-value", 0.25);
    pins.set(name + "fault-invert", 1);
    pins.set(name + "sample-time", 1);
    cycle();
    EXPECT_EQ(bus.registers[VALUE], 0x27F402FFU);
    EXPECT_EQ(bus.registers[SETUP] & 0xFFFF8000U, 0x03FF8000U);
    EXPECT_TRUE(pins.aliases.contains("3pwmgen.00.phase-A-inverted.invert_output"));
}

TEST_F(ThreePhaseOfBoard, IsOffUntilItIsEnabledAndOffAtOnceWhenDisabled) {
    EXPECT_EQ(enable_writes, 0U);
    pins.set(name + "enable", 1);
    cycle();
    EXPECT_TRUE(isEnabled());
    cycle(3);
    pins.set(name + "enable", 0);
    cycle();
    EXPECT_FALSE(isEnabled());
    pins.set(name + "enable", 1);
    cycle(2);
    EXPECT_TRUE(isEnabled());
    pins.set(name + "enable", 0);
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_FALSE(isEnabled()) << "without a reading, too";
}

TEST_F(ThreePhaseOfBoard, StaysOffAfterAFaultUntilTheNextEdge) {
    pins.set(name + "enable", 1);
    cycle(3);
    ASSERT_TRUE(isEnabled());
    fault();
    cycle();
    EXPECT_EQ(pins.get(name + "fault"), 1.0);
    has_fault_input = false;
    enable_writes = 0;
    for (int i = 0; i < 20; ++i) {
        bus.next_write_lost = i % 3 == 0;  // the next write contains all registers
        bus.next_read = i % 5 == 4 ? CycleRead::FAILED : CycleRead::DONE;
        cycle();
    }
    EXPECT_EQ(enable_writes, 0U);
    EXPECT_EQ(pins.get(name + "fault"), 1.0);
    pins.set(name + "enable", 0);
    cycle();
    pins.set(name + "enable", 1);
    cycle(2);
    EXPECT_TRUE(isEnabled());
    EXPECT_EQ(pins.get(name + "fault"), 0.0);
}

TEST_F(ThreePhaseOfBoard, RepeatsAnEnableThatWasLost) {
    pins.set(name + "enable", 1);
    bus.next_write_lost = true;
    cycle();
    EXPECT_FALSE(isEnabled());
    cycle();
    EXPECT_TRUE(isEnabled());
}

TEST_F(ThreePhaseOfBoard, NeverEnablesAfterTheBoardWasReset) {
    pins.set(name + "enable", 1);
    cycle(3);
    bus.registers[ENABLE] = 0;  // power cycle
    enable_writes = 0;
    cycle(5);
    EXPECT_EQ(enable_writes, 0U);
    EXPECT_EQ(pins.get(name + "fault"), 1.0);
}

TEST(ThreePhaseFigures, HoldTheirLimits) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    for (int i = 0; i < 2000; ++i) {
        ThreePhasePins pins;
        pins.a_value = any(random);
        pins.b_value = any(random);
        pins.c_value = i % 10 == 0 ? std::numeric_limits<double>::quiet_NaN() : any(random);
        pins.scale = 1.5;
        const std::uint32_t word = three_phase_values(pins);
        const auto expected = [&](double v) {
            return std::isfinite(v) ? 512 + 511 * std::clamp(v / 1.5, -1.0, 1.0) : 512.0;
        };
        EXPECT_NEAR(word & 0x3FFU, expected(pins.a_value), 1.0);
        EXPECT_NEAR((word >> 10U) & 0x3FFU, expected(pins.b_value), 1.0);
        EXPECT_NEAR((word >> 20U) & 0x3FFU, expected(pins.c_value), 1.0);
        EXPECT_EQ(word >> 30U, 0U);
    }
}

TEST(ThreePhaseFigures, DeadTimeIsNeverShorterThanRequired) {
    for (std::uint32_t hz = 1000; hz < 97'000; hz += 1777) {
        const ThreePhaseRate rate = three_phase_rate(hz, CLOCK_HIGH);
        EXPECT_NEAR(rate.pwm_clock_hz / 2048, hz, 2.0);
        for (double ns = 0; ns < 20'000; ns += 111) {
            ThreePhasePins pins;
            pins.deadtime = ns;
            const double units = three_phase_setup(pins, rate.pwm_clock_hz) & 0x1FFU;
            const double made_ns = units * 2e9 / rate.pwm_clock_hz;
            EXPECT_GE(made_ns + 1e-6, std::min(ns, pins.deadtime)) << hz;
            EXPECT_LT(made_ns, ns + 2e9 / rate.pwm_clock_hz + 1e-6) << hz;
        }
    }
    ThreePhasePins pins;
    pins.deadtime = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(three_phase_setup(pins, 40e6) & 0x1FFU, 511U);
}

TEST(ThreePhaseFigures, FrequencyIsLimited) {
    EXPECT_EQ(three_phase_rate(1, CLOCK_HIGH).frequency_hz, 1000U);
    const ThreePhaseRate fast = three_phase_rate(1'000'000, CLOCK_HIGH);
    EXPECT_EQ(fast.rate, 0xFFFFU);
    EXPECT_NEAR(fast.frequency_hz, CLOCK_HIGH / 2048.0, 3.0);
}

}  // namespace
}  // namespace mw::mesa::test
