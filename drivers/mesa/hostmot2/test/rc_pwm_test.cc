// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include "drivers/mesa/hostmot2/modules/rc_pwm.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

class RcPwmOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(with_module(module_of(Gtag::RC_PWM, 2, 0x9D00), {0x81}));
        cycle();
    }
};

/// The words that LinuxCNC's driver writes with the same values and a clock of 100 MHz.
TEST_F(RcPwmOfBoard, HasTheRegistersOfLinuxCnc) {
    EXPECT_EQ(bus.registers[0x9D00], 0xFFFFFFFFU) << "no pulse";
    EXPECT_EQ(bus.registers[0x9E00], 0x001E847EU);
    pins.set("rcpwmgen.00.offset", 1.5);
    cycle();
    EXPECT_EQ(bus.registers[0x9D00], 0x249EU);
    pins.set("rcpwmgen.00.scale", 90);
    pins.set("rcpwmgen.00.width", 45);
    pins.set("rcpwmgen.rate", 1000);
    cycle();
    EXPECT_EQ(bus.registers[0x9D00], 0x30D3U);
    EXPECT_EQ(bus.registers[0x9E00], 0x1869EU);
    pins.set("rcpwmgen.00.width", 1e9);
    cycle();
    EXPECT_EQ(bus.registers[0x9D00], 0xFFFFU) << "limited";
    pins.set("rcpwmgen.00.width", -135);
    cycle();
    EXPECT_EQ(bus.registers[0x9D00], 0xFFFFFFFFU);
}

TEST_F(RcPwmOfBoard, WritesAgainAfterALostPacket) {
    pins.set("rcpwmgen.01.offset", 1.5);
    bus.next_write_lost = true;
    cycle();
    EXPECT_EQ(bus.registers[0x9D04], 0xFFFFFFFFU);
    cycle();
    EXPECT_EQ(bus.registers[0x9D04], 0x249EU);
}

TEST(RcPwmFigures, WidthIsExactToOneStep) {
    RcPwmPins pins;
    for (double ms = 0.001; ms < 10.0; ms += 0.0137) {
        pins.width = ms * 30;
        pins.scale = 30;
        const std::uint32_t word = rc_pwm_width(pins, CLOCK_LOW);
        ASSERT_LE(word, 0xFFFFU) << ms;
        EXPECT_NEAR((word + 1) * 16e3 / CLOCK_LOW, ms, 16e3 / CLOCK_LOW) << ms;
    }
    pins.width = std::numeric_limits<double>::infinity();
    EXPECT_EQ(rc_pwm_width(pins, CLOCK_LOW), 0xFFFFFFFFU);
}

TEST(RcPwmFigures, RateIsLimited) {
    EXPECT_EQ(rc_pwm_rate(1e6, CLOCK_LOW), rc_pwm_rate(1000.0, CLOCK_LOW));
    EXPECT_EQ(rc_pwm_rate(0.0, CLOCK_LOW), rc_pwm_rate(0.01, CLOCK_LOW));
    EXPECT_EQ(rc_pwm_rate(std::nan(""), CLOCK_LOW), rc_pwm_rate(0.01, CLOCK_LOW));
}

}  // namespace
}  // namespace mw::mesa::test
