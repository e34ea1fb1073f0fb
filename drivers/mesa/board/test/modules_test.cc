// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/board/clock.hh"
#include "drivers/mesa/board/test/host.hh"

namespace mw::mesa::board {
namespace {

constexpr const char *AXIS = "motor x stepgen=0 steps_per_rev=200\n"
                             "encoder 0 motor=x counts_per_rev=4000 index_rev=0.25\n"
                             "switch 17 motor=x below_rev=-1\n";

std::uint32_t rate_of(double steps_per_s) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(steps_per_s * 4294967296.0 / 100e6));
}

TEST(BoardClock, TicksAreExactForYears) {
    EXPECT_EQ(ticks_at(10, 100'000'000), 1);
    EXPECT_EQ(ticks_at(9, 100'000'000), 0);
    constexpr std::int64_t YEAR_NS = 31'557'600LL * S;
    EXPECT_EQ(ticks_at(100 * YEAR_NS / 100 + 20, 100'000'000), YEAR_NS / 10 + 2);
    for (const std::uint32_t hz : {33'333'333U, 66'666'667U, 100'000'000U}) {
        for (std::int64_t tick = 1; tick < 1000; tick += 7) {
            const std::int64_t time = time_of_tick(tick, hz);
            EXPECT_EQ(ticks_at(time, hz), tick);
            EXPECT_EQ(ticks_at(time - 1, hz), tick - 1);
        }
    }
}

// The accumulator is the sum of one rate per tick, independent of the times of the reads.
TEST(BoardStepgen, TheAccumulatorIsTheIntegralOfTheRate) {
    std::mt19937_64 random(5);
    Host host;
    std::uint64_t sum = 0;
    std::int64_t tick = 0;
    std::int32_t rate = 0;
    for (int i = 0; i < 5'000; ++i) {
        host.time_ns += static_cast<std::int64_t>(random() % 2'000'000);
        const std::int64_t now = host.time_ns / 10;
        sum += static_cast<std::uint64_t>(rate) * static_cast<std::uint64_t>(now - tick);
        tick = now;
        ASSERT_EQ(host.read(0x2104), static_cast<std::uint32_t>(sum >> 16U)) << "at " << i;
        rate = static_cast<std::int32_t>(random());
        host.write(0x2004, static_cast<std::uint32_t>(rate));
    }
    EXPECT_EQ(host.read(0x2100), 0U) << "another instance did not move";
}

TEST(BoardStepgen, StepsReachTheMotorOnlyWhileItsPinsDrive) {
    Host host("7i76e", AXIS);
    host.write(0x2000, rate_of(10'000));
    host.time_ns = 100 * MS;
    EXPECT_EQ(host.read(0x2100) >> 16U, 999U);
    EXPECT_EQ(host.board.physics().position_steps(0), 0) << "the pins are inputs";
    host.enable_port0();
    host.time_ns = 200 * MS;
    host.read(0x0100);
    EXPECT_NEAR(static_cast<double>(host.board.physics().position_steps(0)), 1000, 1);
    host.write(0x1100, 0x03FE);  // the direction pin is no longer an output
    host.time_ns = 300 * MS;
    host.read(0x0100);
    EXPECT_NEAR(static_cast<double>(host.board.physics().position_steps(0)), 1000, 1);
}

TEST(BoardStepgen, MotorAndAccumulatorAgreeOnEveryStep) {
    std::mt19937 random(8);
    Host host("7i76e", AXIS);
    host.enable_port0();
    for (int i = 0; i < 2'000; ++i) {
        host.write(0x2000, rate_of(static_cast<double>(random() % 200'000) - 100'000.0));
        host.time_ns += static_cast<std::int64_t>(random() % 1'000'000);
        const auto steps = static_cast<std::int16_t>(host.read(0x2100) >> 16U);
        ASSERT_EQ(static_cast<std::int16_t>(host.board.physics().position_steps(0)), steps);
    }
}

/// A stepgen of version 0xC2 that drives a motor with a switch at its index or probe input.
struct LatchHost : Host {
    explicit LatchHost(const std::string &switches)
        : Host("7i92-latch", "motor x stepgen=0 steps_per_rev=200\n" + switches) {
        write(0x1200, 0x3F);
        write(0x1100, 0x0F);
    }
    double latched() { return (read(0x2200) >> 8U) / 256.0; }
};

TEST(BoardStepgen, TheIndexLatchesThePosition) {
    LatchHost host("switch 4 motor=x above_rev=1\n");
    host.write(0x2000, rate_of(20'000));
    host.write(0x2200, 0x30);  // latch at a rising edge
    host.time_ns = 9 * MS;
    EXPECT_EQ(host.read(0x2200), 0x30U) << "the switch is at 200 steps";
    host.time_ns = 30 * MS;
    EXPECT_EQ(host.read(0x2200) & 0xFFU, 0x20U) << "the latch is used up";
    EXPECT_NEAR(host.latched(), 201, 1);
    EXPECT_EQ(host.read(0x2204), 0U) << "the other one does not latch";
}

TEST(BoardStepgen, TheProbeLatchesAtItsOwnEdge) {
    LatchHost host("switch 5 motor=x above_rev=1 closed=low\n");
    host.write(0x2000, rate_of(20'000));
    host.write(0x2200, 0x40);  // latch at a falling edge
    host.time_ns = 30 * MS;
    EXPECT_EQ(host.read(0x2200) & 0xFFU, 0U);
    EXPECT_NEAR(host.latched(), 201, 1);
    host.write(0x2000, rate_of(-20'000));
    host.time_ns = 50 * MS;
    EXPECT_NEAR(host.latched(), 201, 1) << "no latch is wanted";
}

TEST(BoardStepgen, OtherVersionsHaveNoLatch) {
    Host host("7i76e", AXIS);
    host.enable_port0();
    host.write(0x2000, rate_of(20'000));
    host.write(0x2200, 0x50);
    host.time_ns = S;
    EXPECT_EQ(host.read(0x2200), 0x50U);
}

TEST(BoardStepgen, TheOutputsFollowTheirType) {
    Stepgen stepgen;
    const auto outputs = [&](std::uint32_t type, std::int64_t steps) {
        stepgen.settings[2] = type;
        stepgen.steps = steps;
        return (step_output(stepgen, 0) ? 1U : 0U) | (step_output(stepgen, 1) ? 2U : 0U) |
               (step_output(stepgen, 2) ? 4U : 0U);
    };
    stepgen.rate = -1;
    stepgen.accumulator = 0xFFFFFFFF;  // just after a step downwards
    stepgen.settings[5] = 100;
    EXPECT_EQ(outputs(0, 0), 3U) << "step, direction high";
    EXPECT_EQ(outputs(4, 0), 3U);
    EXPECT_EQ(outputs(1, 0), 2U) << "down";
    EXPECT_EQ(outputs(2, -1), 2U) << "quadrature";
    EXPECT_EQ(outputs(2, 1), 1U);
    EXPECT_EQ(outputs(2, 2), 3U);
}

TEST(BoardStepgen, ATableIsRunThroughWithTheSteps) {
    Host host("7i92-latch");
    for (const std::uint32_t entry : {0x8U, 0x4U, 0x2U, 0x1U}) {  // the last entry is written first
        host.write(0x2700, entry);
    }
    host.write(0x2800, 3);
    host.write(0x2200, 3);
    host.write(0x1200, 0xF);
    host.write(0x1100, 0xF);
    host.write(0x2000, rate_of(1000));
    for (int step = 0; step < 20; ++step) {
        host.time_ns = step * MS + MS / 2;
        EXPECT_EQ(host.read(0x1000) & 0xFU, 1U << (step % 4)) << step;
    }
}

TEST(BoardWatchdog, StartsBittenAndBitesAtItsTime) {
    Host host("7i76e", AXIS);
    EXPECT_EQ(host.read(0x0D00), 1U);
    host.enable_port0();
    host.write(0x1300, 0x4);
    host.write(0x2000, rate_of(1000));
    host.time_ns = S;
    EXPECT_EQ(host.read(0x1100), 0x03FFU) << "it is not armed before the first reset";
    host.write(0x0C00, 499'999);  // 5 ms
    host.write(0x0D00, 0);
    host.write(0x0E00, 0x5A000000);
    host.time_ns = S + 5 * MS - 10;
    EXPECT_EQ(host.read(0x0D00), 0U);
    EXPECT_EQ(host.read(0x1100), 0x03FFU);
    host.time_ns = S + 5 * MS;
    EXPECT_EQ(host.read(0x0D00), 1U);
    EXPECT_EQ(host.read(0x1100), 0U);
    EXPECT_EQ(host.read(0x1300), 0U);
    EXPECT_EQ(host.read(0x1200), 0x1FFFFU) << "nothing else is cleared";
    EXPECT_EQ(host.read(0x2000), rate_of(1000)) << "modules run on";
}

TEST(BoardWatchdog, AResetInTimeKeepsTheOutputs) {
    Host host;
    host.write(0x0C00, 499'999);
    host.write(0x0D00, 0);
    host.enable_port0();
    for (int i = 0; i < 100; ++i) {
        host.write(0x0E00, 0x5A000000);
        host.time_ns += 4 * MS;
    }
    EXPECT_EQ(host.read(0x0D00), 0U);
    host.write(0x0E00, 0x5A000001);  // not the whole word
    host.time_ns += 2 * MS;
    EXPECT_EQ(host.read(0x0D00), 1U);
}

TEST(BoardWatchdog, TheMotorStopsAtTheInstantOfTheBite) {
    Host host("7i76e", AXIS);
    host.enable_port0();
    host.write(0x0C00, 499'999);
    host.write(0x0E00, 0x5A000000);
    host.write(0x2000, rate_of(100'000));
    host.time_ns = S;
    host.read(0x0100);
    EXPECT_NEAR(static_cast<double>(host.board.physics().position_steps(0)), 500, 1);
}

TEST(BoardIoPorts, DirectionSourceInversionAndOpenDrain) {
    Host host;
    host.board.firmware().set_input(17, false);
    EXPECT_EQ(host.read(0x1004) & 3U, 2U) << "inputs: one is pulled down, the other has its pull-up";
    host.write(0x1004, 1);
    host.write(0x1104, 1);
    EXPECT_TRUE(host.board.firmware().pin_level(17));
    host.write(0x1404, 1);
    EXPECT_EQ(host.board.firmware().pin_drive(17), Drive::LOW);
    host.write(0x1304, 1);
    EXPECT_EQ(host.board.firmware().pin_drive(17), Drive::LOW);
    host.write(0x1404, 0);
    EXPECT_EQ(host.board.firmware().pin_drive(17), Drive::NONE) << "open drain does not drive high";
    host.write(0x1104, 0);
    host.write(0x1004, 0);
    EXPECT_EQ(host.board.firmware().pin_drive(17), Drive::LOW) << "open drain overrides the direction";
    EXPECT_EQ(host.read(0x1104), 0U);
}

TEST(BoardEncoder, CountsAndTimeStampsFollowTheShaft) {
    Host host("7i76e", AXIS);
    host.enable_port0();
    host.write(0x3200, 48);  // 2 MHz
    host.write(0x2000, rate_of(1000));
    host.time_ns = 100 * MS + 500 * US;
    const std::uint32_t count = host.read(0x3000);
    EXPECT_EQ(count & 0xFFFFU, 2000U) << "100 steps of 20 counts";
    EXPECT_EQ(host.read(0x3300), (100'500U * 2) & 0xFFFFU);
    host.write(0x3000, 0);
    EXPECT_EQ(host.read(0x3000) & 0xFFFFU, 0U);
    host.write(0x2000, rate_of(-1000));
    host.time_ns += 100 * MS;
    EXPECT_EQ(static_cast<std::int16_t>(host.read(0x3000)), -2000);
}

TEST(BoardEncoder, TheIndexLatchesOnceAndClearsItsBit) {
    for (const double direction : {1.0, -1.0}) {
        Host host("7i76e", AXIS);
        host.enable_port0();
        host.write(0x3100, 0x0858);
        EXPECT_EQ(host.read(0x3100) & 0xFFF8U, 0x0858U);
        host.write(0x2000, rate_of(direction * 1000));
        // The index is at 1000 counts, which is 50 steps upwards, and at -3000 counts.
        const std::int64_t reached = direction > 0 ? 50 * MS : 150 * MS;
        host.time_ns = reached - MS;
        EXPECT_EQ(host.read(0x3100) & 0x10U, 0x10U);
        host.time_ns = reached + 2 * MS;
        const std::uint32_t control = host.read(0x3100);
        EXPECT_EQ(control & 0x10U, 0U);
        EXPECT_EQ(static_cast<std::int16_t>(control >> 16U), direction > 0 ? 1000 : -3000);
        host.time_ns = S;
        EXPECT_EQ(host.read(0x3100) >> 16U, control >> 16U) << "later indexes do not latch";
    }
}

TEST(BoardEncoder, TheIndexCanClearTheCounter) {
    Host host("7i76e", AXIS);
    host.enable_port0();
    host.write(0x3100, 0x0868);
    host.write(0x2000, rate_of(1000));
    host.time_ns = 100 * MS + 500 * US;
    EXPECT_EQ(host.read(0x3000) & 0xFFFFU, 1000U);
    EXPECT_EQ(host.read(0x3100) & 0x20U, 0U);
}

// Compared with a model that passes every count.
TEST(BoardEncoder, TheLatchEqualsThatOfASlowModel) {
    std::mt19937 random(77);
    for (int run = 0; run < 20'000; ++run) {
        Encoder encoder;
        encoder.shaft = {.count = static_cast<std::int64_t>(random() % 2000) - 1000,
                         .index_count = static_cast<std::int64_t>(random() % 50),
                         .counts_per_rev = 4 + static_cast<std::int64_t>(random() % 100)};
        const bool once = random() % 2 == 0, active_high = random() % 2 == 0;
        encoder.control = EncoderControl::LATCH_ON_INDEX | (once ? EncoderControl::ONCE : 0U) |
                          (active_high ? EncoderControl::INDEX_POLARITY : 0U);
        const std::int64_t from = encoder.shaft.count;
        const std::int64_t to = from + static_cast<std::int64_t>(random() % 400) - 200;
        std::optional<std::int64_t> latched;
        const std::int64_t way = to > from ? 1 : -1;
        for (std::int64_t count = from; count != to; count += way) {
            const bool before = index_level(encoder.shaft, count);
            const bool after = index_level(encoder.shaft, count + way);
            if (before != after && after == active_high && !(once && latched.has_value())) {
                latched = count + way;
            }
        }
        move_shaft(encoder, {from, to, 0, MS});
        ASSERT_EQ(encoder.latch, static_cast<std::uint16_t>(latched.value_or(0))) << "run " << run;
        ASSERT_EQ((encoder.control & EncoderControl::LATCH_ON_INDEX) == 0, once && latched.has_value());
    }
}

TEST(BoardEncoder, TheProbeLatches) {
    Encoder encoder;
    encoder.shaft.count = 1234;
    encoder.control = EncoderControl::LATCH_ON_PROBE | EncoderControl::PROBE_POLARITY | EncoderControl::ONCE;
    set_probe(encoder, true);
    EXPECT_EQ(encoder.latch, 1234);
    EXPECT_EQ(encoder.control & EncoderControl::LATCH_ON_PROBE, 0U);
    encoder.shaft.count = 99;
    set_probe(encoder, false);
    set_probe(encoder, true);
    EXPECT_EQ(encoder.latch, 1234);
}

TEST(BoardEncoder, TheProbePinLatches) {
    Host host("7i80hd-3pwm");
    host.write(0x3100, 0x7040);  // latch on probe, rising, once
    host.board.firmware().set_input(11, false);
    EXPECT_EQ(host.read(0x3100) & 0x2000U, 0x2000U);
    host.board.firmware().set_input(11, true);
    EXPECT_EQ(host.read(0x3100) & 0x2000U, 0U);
}

TEST(BoardPhysics, ASwitchClosesAtItsPosition) {
    Host host("7i76e", AXIS);
    host.enable_port0();
    EXPECT_EQ(host.read(0x1004) & 1U, 0U);
    host.write(0x2000, rate_of(-1000));
    host.time_ns = 199 * MS;
    EXPECT_EQ(host.read(0x1004) & 1U, 0U);
    host.time_ns = 203 * MS;
    EXPECT_EQ(host.read(0x1004) & 1U, 1U);
}

TEST(BoardPhysics, ASpindleFollowsItsPwmWithALag) {
    Host host("7i97",
              "motor s pwm=0 full_rev_s=50 time_constant_s=0.1\nencoder 0 motor=s counts_per_rev=400\n");
    host.write(0x1200, 0x1FF);
    host.write(0x1100, 0x1FF);
    host.write(0x4100, 3);                            // 12 bits
    host.write(0x4000, 0x80000000 | (2048U << 16U));  // half, in the negative direction
    host.time_ns = 2 * S;
    EXPECT_EQ(host.read(0x3000) & 0xFFFFU, 0U) << "not enabled";
    host.write(0x4400, 1);
    host.time_ns = 4 * S;
    host.read(0x3000);
    // 25 rev/s for 2 s, minus the lag.
    EXPECT_NEAR(host.board.physics().position_rev(0), -25.0 * (2.0 - 0.1), 0.01);
    EXPECT_NEAR(static_cast<std::int16_t>(host.read(0x3000)), -19000, 2);
}

TEST(BoardOutputs, LedsAndSolidStateOutputs) {
    Host host("7i96s");
    host.write(0x0200, 0x40000000);
    EXPECT_FALSE(host.board.firmware().led()->isOn(0));
    EXPECT_TRUE(host.board.firmware().led()->isOn(1));
    host.write(0x7D00, 0x2);
    EXPECT_FALSE(host.board.firmware().ssr()->isOn(2)) << "its rate is not enabled";
    host.write(0x7E00, 0x1000);
    EXPECT_TRUE(host.board.firmware().ssr()->isOn(2));
    host.board.firmware().set_input(3, false);
    EXPECT_EQ(host.read(0x8300) & 0x7FFU, 0x7F7U);
    EXPECT_EQ(host.read(0x8000) & 0x1FU, 10U) << "the highest input";
}

// The DPLL follows a host with a jittering period; positions latched before the sync have no jitter.
TEST(BoardDpll, PositionsLatchedByATimerHaveNoJitterOfTheHost) {
    std::mt19937 random(4);
    Host host;
    host.write(0x7000, static_cast<std::uint32_t>(1000.0 * 4398046511104.0 / 100e6));
    host.write(0x7400, 0x10000 - 0x1999);  // 0.1 of a period before the sync
    host.write(0x2A00, (1U << 12U) | 0x8000U);
    host.write(0x2000, rate_of(100'000));
    std::int64_t base_ns = 0;
    std::uint32_t last = 0;
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        base_ns += MS;
        host.time_ns = base_ns + static_cast<std::int64_t>(random() % 100'000) - 50'000;
        const auto error = static_cast<std::int32_t>(host.read(0x7600));
        const std::uint32_t position = host.read(0x2100);
        if (i > 500) {
            worst = std::max(worst, std::abs((position - last) / 65536.0 - 100.0));
        }
        last = position;
        EXPECT_EQ(static_cast<std::uint32_t>(error), host.read(0x7100));
    }
    // Up to 100 us of jitter are 10 steps.
    EXPECT_LT(worst, 5.0);
    EXPECT_GT(worst, 0.0);
}

}  // namespace
}  // namespace mw::mesa::board
