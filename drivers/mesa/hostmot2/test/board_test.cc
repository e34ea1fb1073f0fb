// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the lists of a cycle, watchdog, inputs and outputs, LEDs: the registers that the driver writes, and
// when.
#include <algorithm>

#include "drivers/mesa/hostmot2/modules/small.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t STATUS = 0x0D00, DATA = 0x1000, DIRECTION = 0x1100, SOURCE = 0x1200,
                        OPEN_DRAIN = 0x1300, INVERT = 0x1400;

class CycleOfBoard : public BoardTest {
  protected:
    void SetUp() override { load(firmware()); }
    std::ptrdiff_t position(std::uint16_t address) const {
        const auto &list = bus.written.back();
        const auto found = std::ranges::find(list, address, &RegisterWrite::address);
        return found == list.end() ? -1 : found - list.begin();
    }
};

TEST_F(CycleOfBoard, WritesNothingBeforeTheFirstCycle) {
    EXPECT_TRUE(bus.written.empty());
    EXPECT_TRUE(bus.loading_writes.empty());
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_TRUE(bus.written.empty()) << "nothing is known of the board";
}

TEST_F(CycleOfBoard, ReadsInOneOrder) {
    const std::vector<RegisterRange> expected{{0x1000, 3}, {0x7600, 1}, {0x7300, 1}, {0x0D00, 1},
                                              {0x2100, 5}, {0x3300, 1}, {0x3000, 1}, {0x3100, 1}};
    EXPECT_EQ(bus.ranges, expected);
}

TEST_F(CycleOfBoard, WritesDirectionsLastWhenItWritesAll) {
    cycle();
    ASSERT_GE(position(DIRECTION), 0);
    for (const std::uint16_t before : {STATUS, DATA, INVERT, OPEN_DRAIN, SOURCE, std::uint16_t{0x2000}}) {
        ASSERT_GE(position(before), 0) << before;
        EXPECT_LT(position(before), position(DIRECTION)) << before;
    }
    EXPECT_LT(position(STATUS), position(OPEN_DRAIN)) << "a bite that is not cleared clears it again";
    EXPECT_LE(static_cast<int>(bus.written.back().size()), bus.max_writes);
}

TEST_F(CycleOfBoard, DirectionsAndSourcesAreThoseOfTheModules) {
    cycle();
    EXPECT_EQ(bus.registers[DIRECTION], 0x3FFU) << "steps and directions";
    EXPECT_EQ(bus.registers[SOURCE], 0x3FFU | (7U << 14U)) << "and the encoder";
    EXPECT_EQ(bus.registers[DIRECTION + 4], 0U);
}

TEST_F(CycleOfBoard, LaterWritesOnlyWhatChanges) {
    cycle(3);
    EXPECT_LT(position(DIRECTION), 0);
    EXPECT_GE(position(DATA), 0);
    EXPECT_EQ(bus.last(0x0E00), 0x5A000000);
    EXPECT_GE(position(0x2000), 0);
    pins.set("gpio.017.is_output", 1);
    cycle();
    EXPECT_EQ(bus.last(DIRECTION + 4), 1);
    EXPECT_LT(position(DIRECTION), 0);
    cycle();
    EXPECT_LT(position(DIRECTION + 4), 0);
}

TEST_F(CycleOfBoard, WritesAllAfterAFailure) {
    cycle(3);
    const std::size_t few = bus.written.back().size();
    bus.next_write_lost = true;
    cycle(2);
    EXPECT_GT(bus.written.back().size(), few);
    EXPECT_GE(position(DIRECTION), 0);
    cycle();
    EXPECT_EQ(bus.written.back().size(), few);
}

// A bite that the driver has not detected yet must not be undone.
TEST_F(CycleOfBoard, WritesNoConfigurationInACycleWhoseReadFailed) {
    cycle(3);
    const std::size_t few = bus.written.back().size();
    bus.next_read = CycleRead::FAILED;
    bus.registers[STATUS] = 1;
    cycle();
    EXPECT_EQ(bus.written.back().size(), few);
    EXPECT_LT(position(DIRECTION), 0);
    EXPECT_EQ(bus.registers[STATUS], 1U);
    cycle();
    EXPECT_EQ(pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(bus.registers[STATUS], 1U);
}

TEST_F(CycleOfBoard, WritesNoConfigurationWhenItWasSuspendedAfterTheRead) {
    cycle(3);
    const std::size_t few = bus.written.back().size();
    bus.next_write_lost = true;
    cycle();
    board->read(PERIOD_NS, now_ns + PERIOD_NS);
    now_ns += 100 * PERIOD_NS;
    bus.registers[STATUS] = 1;  // the watchdog bites in this time
    write();
    EXPECT_EQ(bus.written.back().size(), few);
    cycle();
    EXPECT_EQ(pins.get("watchdog.has_bit"), 1.0);
}

TEST_F(CycleOfBoard, WritesAllInTheFirstCycleThatIsReadAfterAFailure) {
    cycle(3);
    bus.next_read = CycleRead::FAILED;
    cycle();
    cycle();
    EXPECT_GE(position(DIRECTION), 0);
    EXPECT_LT(position(STATUS), 0) << "only an operator clears a bite";
}

TEST_F(CycleOfBoard, WritesAllAfterAWriteThatCouldNotBeSent) {
    cycle(3);
    pins.set("gpio.017.is_output", 1);
    bus.next_write_rejected = true;
    cycle(2);
    EXPECT_EQ(bus.last(DIRECTION + 4), 1);
    EXPECT_GE(position(DIRECTION), 0);
}

TEST_F(CycleOfBoard, WritesNothingWhileTheBusIsStopped) {
    cycle(3);
    const std::size_t count = bus.written.size();
    bus.next_read = CycleRead::STOPPED;
    cycle();
    EXPECT_EQ(bus.written.size(), count);
    cycle();
    EXPECT_EQ(bus.written.size(), count + 1);
    EXPECT_GE(position(DIRECTION), 0);
}

TEST_F(CycleOfBoard, ABiteStopsAllWritesUntilTheOperatorClearsIt) {
    cycle(3);
    bus.registers[STATUS] = 1;
    const std::size_t count = bus.written.size();
    cycle(20);
    EXPECT_EQ(pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(bus.written.size(), count);
    pins.set("watchdog.has_bit", 0);
    cycle();
    EXPECT_EQ(bus.last(STATUS), 0);
    EXPECT_GE(position(DIRECTION), 0);
    cycle(20);
    EXPECT_EQ(pins.get("watchdog.has_bit"), 0.0);
    EXPECT_LT(position(DIRECTION), 0);
}

// PCI, EPP, SPI: after a power cycle the status of the watchdog is that of a bite, too.
TEST_F(CycleOfBoard, ABiteLosesAllPositionsWhereTheBusDoesNotShowARestart) {
    cycle(3);
    EXPECT_EQ(board->take_position_loss(), PositionLoss::NONE);
    bus.registers[STATUS] = 1;
    read();
    EXPECT_EQ(board->take_position_loss(), PositionLoss::RESTARTED);
    EXPECT_EQ(board->take_position_loss(), PositionLoss::NONE);
    write();
    read();
    EXPECT_EQ(board->take_position_loss(), PositionLoss::NONE) << "once";
}

TEST_F(CycleOfBoard, TellsABiteOnceWithItsCause) {
    cycle(3);
    bus.next_read = CycleRead::FAILED;
    read();
    now_ns += 6 * PERIOD_NS;
    write();
    bus.registers[STATUS] = 1;
    read();
    const BoardEvents events = board->take_events();
    EXPECT_TRUE(events.bitten);
    EXPECT_EQ(events.longest_gap_ns, 7 * PERIOD_NS);
    cycle(5);
    EXPECT_FALSE(board->take_events().bitten);
}

TEST_F(CycleOfBoard, APowerUpStatusIsNoBite) {
    cycle();
    EXPECT_EQ(pins.get("watchdog.has_bit"), 0.0);
    EXPECT_EQ(bus.registers[STATUS], 0U);
}

TEST_F(CycleOfBoard, ALostFirstWriteIsRepeated) {
    bus.next_write_lost = true;
    cycle(3);
    EXPECT_EQ(pins.get("watchdog.has_bit"), 0.0);
    EXPECT_EQ(bus.registers[DIRECTION], 0x3FFU);
}

TEST_F(CycleOfBoard, AWatchdogThatStaysBittenIsReported) {
    bus.on_write = [this](RegisterWrite) { bus.registers[STATUS] = 1; };
    cycle(30);
    EXPECT_EQ(pins.get("watchdog.has_bit"), 1.0);
}

TEST_F(CycleOfBoard, UnloadingBeforeTheFirstWriteWritesNothing) {
    bus.loading_writes.clear();
    board->stop();
    EXPECT_TRUE(bus.loading_writes.empty()) << "another host may drive the board";
    cycle(2);
    board->stop();
    ASSERT_EQ(bus.loading_writes.size(), 1U);
    EXPECT_EQ(bus.loading_writes[0], (RegisterWrite{0x0C00, 0}));
}

TEST_F(CycleOfBoard, WatchdogTimeIsItsParameter) {
    cycle();
    EXPECT_EQ(bus.registers[0x0C00], CLOCK_LOW / 200 - 1) << "5 ms";
    pins.set("watchdog.timeout_ns", 10'000'000);
    cycle();
    EXPECT_EQ(bus.last(0x0C00), CLOCK_LOW / 100 - 1);
    board->stop();
    EXPECT_EQ(bus.registers[0x0C00], 0U) << "one clock";
}

TEST_F(CycleOfBoard, InputsAndTheirInverse) {
    bus.registers[DATA + 4] = 0b100;
    cycle();
    EXPECT_EQ(pins.get("gpio.019.in"), 1.0);
    EXPECT_EQ(pins.get("gpio.019.in_not"), 0.0);
    EXPECT_EQ(pins.get("gpio.018.in"), 0.0);
    EXPECT_EQ(pins.get("gpio.018.in_not"), 1.0);
    bus.registers[DATA + 4] = 0;
    bus.next_read = CycleRead::FAILED;
    cycle();
    EXPECT_EQ(pins.get("gpio.019.in"), 1.0) << "values stay after a failed read";
}

TEST_F(CycleOfBoard, OutputsFollowTheirParameters) {
    pins.set("gpio.050.out", 1);
    cycle();
    EXPECT_EQ(bus.registers[DIRECTION + 8], 0U) << "an output is an input until a user makes it one";
    pins.set("gpio.050.is_output", 1);
    pins.set("gpio.050.invert_output", 1);
    cycle();
    EXPECT_EQ(bus.registers[DATA + 8], 1U << 16U);
    EXPECT_EQ(bus.registers[DIRECTION + 8], 1U << 16U);
    EXPECT_EQ(bus.registers[INVERT + 8], 1U << 16U);
    pins.set("gpio.050.is_opendrain", 1);
    cycle();
    EXPECT_EQ(bus.registers[OPEN_DRAIN + 8], 1U << 16U);
}

TEST_F(CycleOfBoard, PinsOfModulesHaveTheParametersOfOutputsOnly) {
    EXPECT_TRUE(pins.pins.contains("gpio.001.in"));
    EXPECT_FALSE(pins.pins.contains("gpio.001.out"));
    EXPECT_TRUE(pins.pins.contains("gpio.001.invert_output"));
    EXPECT_FALSE(pins.pins.contains("gpio.014.invert_output")) << "an input of the encoder";
    EXPECT_EQ(pins.aliases["stepgen.00.step.invert_output"], "gpio.001.invert_output");
    EXPECT_EQ(pins.aliases["stepgen.04.direction.is_opendrain"], "gpio.008.is_opendrain");
}

TEST_F(CycleOfBoard, LedsAreBitsFromTheTop) {
    pins.set("led.CR01", 1);
    pins.set("led.CR04", 1);
    cycle();
    EXPECT_EQ(bus.registers[0x0200], 0x90000000U);
}

TEST_F(CycleOfBoard, PhaseLockedLoopHasTheRateOfTheThread) {
    pins.set("dpll.01.timer-us", -50);
    bus.registers[0x7600] = 0xFFFF0000;
    cycle();
    EXPECT_NEAR(bus.registers[0x7000], 1000.0 * 4398046511104.0 / CLOCK_LOW, 1.0);
    EXPECT_EQ(bus.registers[0x7400] & 0xFFFFU, static_cast<std::uint32_t>(0.05 * 65536));
    EXPECT_EQ(bus.registers[0x7200], (1U << 24U) | 0x400000U);
    EXPECT_EQ(bus.registers[0x7300], 2000U << 16U);
    EXPECT_NEAR(pins.get("dpll.phase-error-us"), -1000.0 * 65536 / 4294967296.0, 1e-9);
}

TEST_F(CycleOfBoard, ACycleDoesNotAllocate) {
    cycle(3);
    bus.recording = false;
    pins.set("stepgen.00.enable", 1);
    pins.set("encoder.00.index-enable", 1);
    mw::testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        bus.next_read = i % 7 == 0 ? CycleRead::FAILED : CycleRead::DONE;
        cycle();
    }
    EXPECT_EQ(guard.calls(), 0U);
}

TEST(FastGpioOfBoard, NeedsABusWithImmediateAccess) {
    MemoryBus bus;
    auto board = Board::make(bus, firmware(), *parse_config(""));
    ASSERT_TRUE(board.has_value());
    EXPECT_FALSE((*board)->hasFastGpio());
}

class FastGpio : public BoardTest {
  protected:
    void SetUp() override {
        bus.immediate = true;
        load(firmware());
        pins.set("gpio.020.is_output", 1);
    }
    static constexpr std::uint32_t PIN_20 = 1U << 3U;
};

TEST_F(FastGpio, ReadsAndWritesBetweenTwoCycles) {
    cycle(2);
    bus.registers[DATA] = 1;
    board->read_gpio();
    EXPECT_EQ(pins.get("gpio.000.in"), 1.0);
    EXPECT_EQ(pins.get("gpio.000.in_not"), 0.0);
    pins.set("gpio.020.out", 1);
    board->write_gpio();
    EXPECT_EQ(bus.registers[DATA + 4], PIN_20);
    EXPECT_EQ(bus.registers[DIRECTION + 4] & PIN_20, PIN_20);
    pins.set("gpio.020.is_output", 0);
    board->write_gpio();
    EXPECT_EQ(bus.registers[DIRECTION + 4] & PIN_20, 0U);
    cycle();
    EXPECT_EQ(bus.registers[DIRECTION + 4] & PIN_20, 0U) << "the cycle agrees";
}

TEST_F(FastGpio, WritesNothingUnlessTheCycleDoes) {
    board->write_gpio();
    EXPECT_TRUE(bus.immediate_writes.empty()) << "before the first cycle";
    cycle(2);
    board->write_gpio();
    EXPECT_FALSE(bus.immediate_writes.empty());
    bus.registers[STATUS] = 1;  // a bite
    cycle(12);
    ASSERT_EQ(pins.get("watchdog.has_bit"), 1.0);
    bus.immediate_writes.clear();
    board->write_gpio();
    EXPECT_TRUE(bus.immediate_writes.empty()) << "while the watchdog has bitten";
}

TEST(SolidStateRelays, RateIsADivisorWithItsEnable) {
    EXPECT_EQ(ssr_rate(1'000'000, CLOCK_LOW), (1U << 12U) | 48U);
    EXPECT_EQ(ssr_rate(1, CLOCK_LOW), (1U << 12U) | 1998U) << "limited to 25 kHz";
}

}  // namespace
}  // namespace mw::mesa::test
