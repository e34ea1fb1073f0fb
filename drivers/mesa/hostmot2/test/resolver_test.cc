// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include "drivers/mesa/hostmot2/modules/resolver.hh"
#include "drivers/mesa/hostmot2/test/modules_fixture.hh"

namespace mw::mesa::test {
namespace {

class ResolverOfBoard : public BoardTest {
  protected:
    static constexpr std::uint16_t COMMAND = 0x3C00, STATUS = 0x3E00, VELOCITY = 0x3F00, POSITION = 0x4000;

    void SetUp() override {
        Idrom idrom = with_module(module_of(Gtag::RESOLVER, 1, COMMAND), {0x81, 0x82, 0x09});
        std::erase_if(idrom.modules, [](const ModuleDescriptor &m) { return m.gtag == Gtag::PWM; });
        load(idrom);
        cycle();
    }
    void turn_to(std::uint32_t position) {
        bus.registers[POSITION] = position;
        cycle();
    }
    const std::string name = "resolver.00.";
};

/// Values that LinuxCNC's driver shows for the same registers with a clock of 100 MHz.
TEST_F(ResolverOfBoard, ShowsWhatLinuxCncShows) {
    EXPECT_TRUE(pins.pins.contains("resolver.05.angle"));
    EXPECT_FALSE(pins.pins.contains("resolver.06.angle"));
    turn_to(0x40000000);
    EXPECT_EQ(pins.get(name + "angle"), 0.25);
    EXPECT_EQ(pins.get(name + "position"), 0.25);
    EXPECT_EQ(pins.get(name + "count"), 4194304.0);
    turn_to(0xC0000001);
    EXPECT_EQ(pins.get(name + "count"), -4194304.0);
    bus.registers[VELOCITY] = 0xFFF00000;
    pins.set(name + "velocity-scale", 2);
    cycle();
    EXPECT_NEAR(pins.get(name + "velocity"), -9.765625, 1e-9);
    EXPECT_NEAR(pins.get(name + "velocity-rpm"), -585.9375, 1e-6);
    pins.set(name + "scale", 10);
    pins.set(name + "index-enable", 1);
    cycle();
    EXPECT_EQ(pins.get(name + "index-enable"), 1.0);
    turn_to(0x08000000);
    EXPECT_EQ(pins.get(name + "index-enable"), 0.0);
    EXPECT_NEAR(pins.get(name + "position"), 0.3125, 1e-9);
    EXPECT_EQ(pins.get(name + "count"), 524288.0);
    turn_to(0x48000000);
    pins.set(name + "reset", 1);
    cycle();
    EXPECT_EQ(pins.get(name + "position"), 0.0);
    EXPECT_EQ(pins.get(name + "rawcounts"), 4718592.0);
}

TEST_F(ResolverOfBoard, ShowsErrorsAndKeepsItsValuesAfterAFailedRead) {
    turn_to(0x40000000);
    bus.registers[STATUS] = 1;
    turn_to(0x50000000);
    EXPECT_EQ(pins.get(name + "error"), 1.0);
    EXPECT_EQ(pins.get("resolver.01.error"), 0.0);
    EXPECT_EQ(pins.get(name + "position"), 0.3125);
    bus.registers[STATUS] = 0;
    bus.next_read = CycleRead::FAILED;
    turn_to(0x60000000);
    EXPECT_EQ(pins.get(name + "error"), 1.0);
    EXPECT_EQ(pins.get(name + "position"), 0.3125);
    cycle();
    EXPECT_EQ(pins.get(name + "position"), 0.375);
}

TEST_F(ResolverOfBoard, SetsTheNearestExcitation) {
    EXPECT_EQ(bus.last(COMMAND), -1) << "not before a user chooses one";
    for (const auto &[khz, shown, command] :
         {std::tuple{6.0, 5.0, 0x802}, {1.0, 2.5, 0x801}, {99.0, 10.0, 0x803}}) {
        pins.set("resolver.excitation-khz", khz);
        cycle();
        EXPECT_EQ(pins.get("resolver.excitation-khz"), shown);
        EXPECT_EQ(bus.last(COMMAND), command);
        cycle();
        EXPECT_EQ(bus.last(COMMAND), -1) << "once";
    }
    bus.next_write_lost = true;
    cycle(2);
    EXPECT_EQ(bus.last(COMMAND), 0x803) << "again after a lost packet";
}

TEST(ResolverReadings, CountEveryTurn) {
    std::mt19937 random(11);
    std::uniform_int_distribution<std::int64_t> change(-2'000'000'000, 2'000'000'000);
    ResolverState state;
    ResolverPins pins;
    std::int64_t position = 0x12345678;
    resolver_read(state, pins, {static_cast<std::uint32_t>(position)});
    for (int i = 0; i < 20'000; ++i) {
        position += change(random);
        resolver_read(state, pins, {static_cast<std::uint32_t>(position)});
        ASSERT_NEAR(pins.position, static_cast<double>(position) / 4294967296.0, 1e-6) << i;
        ASSERT_EQ(pins.rawcounts, static_cast<std::int32_t>(position >> 8)) << i;
    }
}

TEST(ResolverReadings, IndexIsAtZeroInBothDirections) {
    for (const int direction : {1, -1}) {
        ResolverState state;
        ResolverPins pins;
        pins.index_divisor = 4;
        std::int64_t position = 0x80000000LL;
        resolver_read(state, pins, {static_cast<std::uint32_t>(position)});
        pins.index_enable = true;
        int turns = 0;
        while (pins.index_enable && turns < 1000) {
            position += direction * 0x11111111LL;
            resolver_read(state, pins, {static_cast<std::uint32_t>(position)});
            ++turns;
        }
        EXPECT_EQ(state.zero % (4LL << 32), 0) << "one in four";
        EXPECT_LT(std::abs(pins.position), 0.07) << direction;
    }
}

TEST(ResolverReadings, PositionFileGivesTheTurns) {
    ResolverState state;
    ResolverPins pins;
    pins.use_position_file = true;
    pins.scale = 5.0;
    pins.joint_pos_fb = 5.0 * 17.26;
    resolver_read(state, pins, {0x40000000U});
    EXPECT_NEAR(pins.position, 5.0 * 17.25, 1e-9);
}

}  // namespace
}  // namespace mw::mesa::test
