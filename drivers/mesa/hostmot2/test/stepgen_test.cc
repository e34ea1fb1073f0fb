// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>
#include <random>

#include "drivers/mesa/hostmot2/modules/stepgen.hh"
#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

constexpr std::uint16_t RATE = 0x2000, ACCUMULATOR = 0x2100;

/// Simulates a step generator of the board: 48 bit, of which the driver reads bits 16 to 47.
struct Motor {
    std::int64_t position = 0;  ///< [1/65536 step]
    double rest = 0.0;
    void move(std::int32_t rate) {
        const double units =
            rate * (static_cast<double>(CLOCK_LOW) / 4294967296.0) * PERIOD_S * 65536.0 + rest;
        const double whole = std::floor(units);
        rest = units - whole;
        position += static_cast<std::int64_t>(whole);
    }
    double steps() const { return static_cast<double>(position) / 65536.0; }
};

class StepgenOfBoard : public BoardTest {
  protected:
    void SetUp() override {
        load(firmware());
        pins.set(name + "steplen", 1000);
        pins.set(name + "stepspace", 1000);
        bus.registers[ACCUMULATOR] = start;
        cycle();
    }
    void pass() {
        const auto rate = static_cast<std::int32_t>(bus.registers[RATE]);
        motor.move(rate);
        bus.registers[ACCUMULATOR] = start + static_cast<std::uint32_t>(motor.position);
        cycle();
    }

    const std::string name = "stepgen.00.";
    std::uint32_t start = 0xFFFF8000;
    Motor motor;
};

TEST_F(StepgenOfBoard, CountsEveryStepOverManyWrapsAndLostCycles) {
    std::mt19937 random(41);
    std::uniform_int_distribution<std::int32_t> change(-2'000'000'000, 2'000'000'000);
    std::int64_t position = 0;
    pins.set(name + "position-scale", 200);
    for (int i = 0; i < 20'000; ++i) {
        const std::int32_t moved = change(random) / ((i % 1000 < 500) ? 4 : 100);
        position += moved;
        bus.registers[ACCUMULATOR] = start + static_cast<std::uint32_t>(position);
        const bool lost = random() % 5 == 0 && std::abs(moved) < 30'000'000;
        bus.next_read = lost ? CycleRead::FAILED : CycleRead::DONE;
        cycle();
        if (!lost) {
            ASSERT_EQ(static_cast<std::int32_t>(pins.get(name + "counts")),
                      static_cast<std::int32_t>(position >> 16))
                << i;
            ASSERT_NEAR(pins.get(name + "position-fb"), static_cast<double>(position) / 65536.0 / 200.0,
                        1e-9);
        }
    }
}

TEST_F(StepgenOfBoard, IsStillUntilItIsEnabled) {
    pins.set(name + "position-cmd", 100);
    pins.set(name + "velocity-cmd", 100);
    for (int i = 0; i < 10; ++i) {
        pass();
        EXPECT_EQ(bus.registers[RATE], 0U);
    }
}

TEST_F(StepgenOfBoard, StopsAtOnceWhenDisabled) {
    pins.set(name + "control-type", 1);
    pins.set(name + "velocity-cmd", 1000);
    pins.set(name + "maxaccel", 0);
    pins.set(name + "enable", 1);
    pass();
    EXPECT_NEAR(static_cast<std::int32_t>(bus.registers[RATE]), 1000.0 * 4294967296.0 / CLOCK_LOW, 1.0);
    EXPECT_NEAR(pins.get(name + "velocity-fb"), 1000.0, 1e-9);
    pins.set(name + "enable", 0);
    bus.next_read = CycleRead::FAILED;
    pass();
    EXPECT_EQ(bus.registers[RATE], 0U) << "also when the read fails";
    EXPECT_EQ(pins.get(name + "velocity-fb"), 0.0);
}

TEST_F(StepgenOfBoard, VelocityIsLimitedByPinsAndBySteps) {
    pins.set(name + "control-type", 1);
    pins.set(name + "velocity-cmd", -1e9);
    pins.set(name + "maxaccel", 0);
    pins.set(name + "enable", 1);
    pass();
    EXPECT_NEAR(pins.get(name + "velocity-fb"), -1e9 / 2000, 1e-6);
    pins.set(name + "maxvel", 300);
    pass();
    EXPECT_NEAR(pins.get(name + "velocity-fb"), -300, 1e-9);
    pins.set(name + "velocity-cmd", std::numeric_limits<double>::quiet_NaN());
    pass();
    EXPECT_EQ(bus.registers[RATE], 0U);
}

TEST_F(StepgenOfBoard, FollowsATrajectoryWithLostCyclesWithinOneCycleOfVelocity) {
    std::mt19937 random(7);
    pins.set(name + "position-scale", 400);
    pins.set(name + "maxaccel", 2000);
    pins.set(name + "maxvel", 100);
    pins.set(name + "enable", 1);
    double position = 0.0, velocity = 0.0, target = 0.0, worst = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        if (i % 400 == 0) {
            target = std::uniform_real_distribution<double>(-50, 50)(random);
        }
        velocity += std::clamp(target - velocity, -1000 * PERIOD_S, 1000 * PERIOD_S);
        position += velocity * PERIOD_S;
        pins.set(name + "position-cmd", position);
        bus.next_read = random() % 50 == 0 ? CycleRead::FAILED : CycleRead::DONE;
        bus.next_write_lost = random() % 50 == 0;
        pass();
        // The motor is at the command of one cycle ago.
        worst = std::max(worst, std::abs(motor.steps() / 400 - (position - 2 * velocity * PERIOD_S)));
    }
    EXPECT_LT(worst, 3 * 50 * PERIOD_S) << "50 units/s for the lost cycles";
    for (int i = 0; i < 400; ++i) {
        velocity -= std::clamp(velocity, -1000 * PERIOD_S, 1000 * PERIOD_S);
        position += velocity * PERIOD_S;
        pins.set(name + "position-cmd", position);
        pass();
    }
    EXPECT_NEAR(motor.steps() / 400, position, 0.5 / 400) << "no step is lost";
}

TEST_F(StepgenOfBoard, ApproachesAStepOfTheCommandWithoutOvershootOrExcessAcceleration) {
    pins.set(name + "position-scale", 1000);
    pins.set(name + "maxaccel", 500);
    pins.set(name + "maxvel", 20);
    pins.set(name + "enable", 1);
    pass();
    pins.set(name + "position-cmd", 1.5);
    // maxvel and maxaccel limit the velocity of the command in the cycle of the step.
    double before = 0.0, most = 0.0;
    for (int i = 0; i < 2000; ++i) {
        pass();
        const double velocity = pins.get(name + "velocity-fb");
        ASSERT_LE(std::abs(velocity - before), 500 * PERIOD_S + 1e-9) << i;
        ASSERT_LE(std::abs(velocity), 20 + 1e-9);
        before = velocity;
        most = std::max(most, motor.steps() / 1000);
    }
    EXPECT_NEAR(motor.steps() / 1000, 1.5, 1e-3);
    EXPECT_LT(most, 1.5 + 1e-3);
}

TEST_F(StepgenOfBoard, TimesAreRoundedUpToClocksAndLimited) {
    for (const std::uint32_t ns : {0U, 1U, 10U, 11U, 995U, 163'830U, 163'831U, 0xFFFFFFFFU}) {
        const double clocks = std::min(std::ceil(ns * (CLOCK_LOW / 1e9)), 16383.0);
        EXPECT_EQ(step_clocks(ns, CLOCK_LOW), static_cast<std::uint32_t>(clocks)) << ns;
    }
    pins.set(name + "steplen", 2500);
    pins.set(name + "stepspace", 2600);
    pins.set(name + "dirsetup", 10'000);
    pins.set(name + "dirhold", 20'000);
    pins.set(name + "step_type", 2);
    cycle();
    EXPECT_EQ(bus.registers[0x2200], 2U);
    EXPECT_EQ(bus.registers[0x2300], 1000U);
    EXPECT_EQ(bus.registers[0x2400], 2000U);
    EXPECT_EQ(bus.registers[0x2500], 250U);
    EXPECT_EQ(bus.registers[0x2600], 260U);
    EXPECT_EQ(bus.registers[0x2900], 0xFFFFFFFFU);
    EXPECT_EQ(bus.registers[0x2A00], 0U);
    pins.set("stepgen.timer-number", 1);
    cycle();
    EXPECT_EQ(bus.registers[0x2A00], 0x9000U);
    EXPECT_EQ(pins.get("stepgen.01.steplen"), 163'830.0) << "the longest time";
}

TEST_F(StepgenOfBoard, PositionResetMakesItsPositionZero) {
    bus.registers[ACCUMULATOR] = start + 65536 * 1000;
    pins.set(name + "position-reset", 1);
    cycle();
    EXPECT_EQ(pins.get(name + "counts"), 0.0);
    pins.set(name + "position-reset", 0);
    bus.registers[ACCUMULATOR] += 65536 * 5;
    cycle();
    EXPECT_EQ(pins.get(name + "counts"), 5.0);
}

}  // namespace
}  // namespace mw::mesa::test
