// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include "drivers/mesa/hostmot2/modules/pwm.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

class PwmOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(firmware());
        cycle();
    }
    const std::string name = "pwmgen.01.";
};

TEST(PwmRates, HaveTheLargestResolutionThatReachesTheFrequency) {
    for (std::uint32_t hz = 10; hz < 2'000'000; hz = hz * 5 / 4) {
        int bits = 12;
        while (bits > 9 && hz * 65536.0 * std::pow(2.0, bits) / CLOCK_HIGH > 65535.0) {
            --bits;
        }
        const double exact = std::min(hz * 65536.0 * std::pow(2.0, bits) / CLOCK_HIGH, 65535.0);
        const PwmRate rate = pwm_rate(hz, CLOCK_HIGH);
        EXPECT_EQ(rate.bits, bits) << hz;
        EXPECT_NEAR(rate.rate, exact, 0.51) << hz;
    }
    EXPECT_LT(pwm_rate(5'000'000, CLOCK_HIGH).frequency_hz, 391'000U) << "limited to 2^9 clocks";
}

TEST_F(PwmOfBoard, IsOffUntilItIsEnabled) {
    pins.set(name + "value", 1.0);
    cycle();
    EXPECT_EQ(bus.registers[0x4004], 0U);
    EXPECT_EQ(bus.registers[0x4400], 0U);
    pins.set(name + "enable", 1);
    cycle();
    EXPECT_EQ(bus.registers[0x4004], 4095U << 16U);
    EXPECT_EQ(bus.registers[0x4400], 2U);
}

TEST_F(PwmOfBoard, ValueIsScaledAndLimited) {
    pins.set(name + "enable", 1);
    pins.set(name + "scale", 10);
    for (double value = -15; value < 15; value += 0.37) {
        pins.set(name + "value", value);
        cycle();
        const double duty = std::min(std::abs(value / 10), 1.0);
        EXPECT_EQ((bus.registers[0x4004] >> 16U) & 0x7FFFU,
                  static_cast<std::uint32_t>(std::floor(duty * 4095)));
        EXPECT_EQ(bus.registers[0x4004] >> 31U, value < 0 ? 1U : 0U);
    }
    pins.set(name + "value", std::numeric_limits<double>::infinity());
    cycle();
    EXPECT_EQ(bus.registers[0x4004], 0U);
}

TEST_F(PwmOfBoard, OffsetModeHasHalfAtZero) {
    pins.set(name + "enable", 1);
    pins.set(name + "offset-mode", 1);
    for (const double value : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        pins.set(name + "value", value);
        cycle();
        EXPECT_NEAR(bus.registers[0x4004] >> 16U, (0.5 + value / 2) * 4095, 1.0) << value;
    }
}

TEST_F(PwmOfBoard, ModesAndFrequencies) {
    EXPECT_EQ(bus.registers[0x4104], 3U | (1U << 5U));
    EXPECT_EQ(bus.registers[0x4200],
              static_cast<std::uint32_t>(std::round(20'000 * 65536.0 * 4096 / CLOCK_HIGH)));
    EXPECT_EQ(bus.registers[0x4300], 7U) << "20 kHz";
    const std::uint32_t outputs[] = {0, 2, 3, 1};
    for (int type = 1; type <= 4; ++type) {
        pins.set(name + "output-type", type);
        cycle();
        EXPECT_EQ((bus.registers[0x4104] >> 3U) & 3U, outputs[type - 1]) << type;
    }
    pins.set("pwmgen.pwm_frequency", 1e9);
    cycle();
    EXPECT_EQ(bus.registers[0x4200], 0xFFFFU);
    EXPECT_NEAR(pins.get("pwmgen.pwm_frequency"), CLOCK_HIGH / 512.0 * 65535 / 65536, 1.0);
}

}  // namespace
}  // namespace mw::mesa::test
