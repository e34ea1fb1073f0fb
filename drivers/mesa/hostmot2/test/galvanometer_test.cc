// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include "drivers/mesa/hostmot2/modules/galvanometer.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t ACC_X = 0x9200, VEL_X = 0x9400, POS_X = 0x9600, POS_Y = 0x9700, MODE = 0x9800,
                        COMMAND = 0x9900, STATUS = 0x9A00, READ_TIMER = 0x9B00, WRITE_TIMER = 0x9C00;

class GalvanometerOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(with_module(module_of(Gtag::XY2_100, 1, ACC_X), {0x81, 0x82, 0x83, 0x84, 5}));
        cycle();
    }
    const std::string name = "xy2mod.00.";
};

/// The words that LinuxCNC's driver writes with the same pins, a scale of 1 and a clock of 100 MHz.
TEST_F(GalvanometerOfBoard, HasTheRegistersOfLinuxCnc) {
    EXPECT_EQ(bus.registers[MODE], 0x3C9U);
    pins.set(name + "enable", 1);
    pins.set(name + "posx-cmd", 0.5);
    pins.set(name + "velx-cmd", 100);
    pins.set(name + "accx-cmd", 1000);
    pins.set(name + "posy-scale", 4);
    pins.set(name + "posy-cmd", 1);
    cycle();
    EXPECT_EQ(bus.registers[MODE], 9U);
    EXPECT_EQ(bus.registers[POS_X], 0x3FFFFFFFU);
    EXPECT_EQ(bus.registers[VEL_X], 0x8637BU);
    EXPECT_EQ(bus.registers[ACC_X], 0xE1U);
    EXPECT_EQ(bus.registers[POS_Y], 0x1FFFFFFFU);
    pins.set(name + "controlx", 0);
    pins.set(name + "controly", 7);
    pins.set(name + "commandx", 0x1234);
    pins.set(name + "commandy", 0x5678);
    pins.set(name + "commandmodex", 1);
    pins.set(name + "18bitmodey", 1);
    pins.set("xy2mod.read-timer-number", 1);
    cycle();
    EXPECT_EQ(bus.registers[MODE], 0x1838U);
    EXPECT_EQ(bus.registers[COMMAND], 0x56781234U);
    EXPECT_EQ(bus.registers[READ_TIMER], 0x9000U);
    EXPECT_EQ(bus.registers[WRITE_TIMER], 0U);
}

TEST_F(GalvanometerOfBoard, StopsInTheSameCycleWhenDisabled) {
    pins.set(name + "enable", 1);
    pins.set(name + "posx-cmd", 1);
    pins.set(name + "velx-cmd", 5);
    pins.set(name + "commandmodex", 1);
    cycle();
    pins.set(name + "enable", 0);
    bus.next_read = CycleRead::FAILED;
    cycle();
    for (const std::uint16_t address : {POS_X, POS_Y, VEL_X, ACC_X}) {
        EXPECT_EQ(bus.registers[address], 0U);
    }
    EXPECT_EQ(bus.registers[MODE], 0x3C9U) << "clears overflows";
}

TEST_F(GalvanometerOfBoard, ShowsFeedbackAndOverflows) {
    bus.on_read_register = [](std::uint16_t address) -> std::optional<std::uint32_t> {
        switch (address) {
        case POS_X: return 0x40000000U;
        case VEL_X: return 0x1579U;
        case MODE: return 0x140U;
        case STATUS: return 0x1234U;
        default: return std::nullopt;
        }
    };
    pins.set(name + "posx-scale", 2);
    cycle();
    EXPECT_NEAR(pins.get(name + "posx-fb"), 1.0, 1e-6);
    EXPECT_NEAR(pins.get(name + "velx-fb"), 0.9998985, 1e-6);
    EXPECT_EQ(pins.get(name + "posx-overflow"), 1.0);
    EXPECT_EQ(pins.get(name + "posy-overflow"), 0.0);
    EXPECT_EQ(pins.get(name + "velx-overflow"), 1.0);
    EXPECT_EQ(pins.get(name + "status"), 0x1234);
}

TEST(GalvanometerFigures, AreLimitedToFullScaleOnTheirSide) {
    GalvanometerPins pins;
    for (const double value : {1.0, 1.5, 1e30}) {
        for (const double sign : {1.0, -1.0}) {
            pins.pos_cmd = pins.vel_cmd = pins.acc_cmd = sign * value * 1e12;
            const GalvanometerWords words = galvanometer_words(pins, CLOCK_LOW);
            for (const std::uint32_t word : {words.position, words.velocity, words.acceleration}) {
                EXPECT_EQ(static_cast<std::int32_t>(word), static_cast<std::int32_t>(sign * 2147483647.0));
            }
        }
    }
    pins.pos_cmd = std::nan("");
    pins.vel_cmd = std::numeric_limits<double>::infinity();
    pins.acc_cmd = 0;
    EXPECT_EQ(galvanometer_words(pins, CLOCK_LOW), GalvanometerWords{});
}

TEST(GalvanometerFigures, FeedbackIsTheInverseOfTheCommand) {
    for (double value = -7.0; value < 7.0; value += 0.031) {
        GalvanometerPins pins;
        pins.scale = 7.0;
        pins.pos_cmd = value;
        pins.vel_cmd = value * 10;
        galvanometer_read(pins, galvanometer_words(pins, CLOCK_LOW), CLOCK_LOW);
        EXPECT_NEAR(pins.pos_fb, value, 1e-8);
        EXPECT_NEAR(pins.vel_fb, value * 10, 2e-4);
    }
}

}  // namespace
}  // namespace mw::mesa::test
