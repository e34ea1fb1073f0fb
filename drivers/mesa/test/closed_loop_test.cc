// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the driver with the simulated board, which was written from the same description by another person:
// motors end at the commanded position, also when the network loses packets.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/ethernet/cycle_report.hh"
#include "drivers/mesa/test/rig.hh"

namespace mw::mesa::test {
namespace {

constexpr const char *STEPPER =
    "motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=x counts_per_rev=4000 index_rev=0.25\n";
constexpr double SCALE = 100.0;  // steps per mm

void prepare_stepgen(Rig &rig, const std::string &name) {
    rig.pins.set(name + ".position-scale", SCALE);
    rig.pins.set(name + ".steplen", 2000);
    rig.pins.set(name + ".stepspace", 2000);
    rig.pins.set(name + ".dirsetup", 1000);
    rig.pins.set(name + ".dirhold", 1000);
    rig.pins.set(name + ".maxaccel", 3000);
    rig.pins.set(name + ".enable", 1);
}

/// A command that accelerates at random within 2000 mm/s2 and 100 mm/s, and stops at the end.
class RandomCommand {
  public:
    explicit RandomCommand(unsigned seed) : rng_(seed) {}

    double next() {
        constexpr double PERIOD_S = 1e-3, ACCEL = 2000, SPEED = 100;
        if (--left_ <= 0) {
            left_ = std::uniform_int_distribution<int>(20, 300)(rng_);
            accel_ = std::uniform_real_distribution<double>(-ACCEL, ACCEL)(rng_);
        }
        velocity_ = std::clamp(velocity_ + accel_ * PERIOD_S, -SPEED, SPEED);
        position_ += velocity_ * PERIOD_S;
        return position_;
    }

  private:
    std::mt19937 rng_;
    int left_ = 0;
    double accel_ = 0, velocity_ = 0, position_ = 0;
};

/// Runs the command, then stops; returns the last command.
double run_random(Rig &rig, unsigned seed, int cycles) {
    RandomCommand command(seed);
    double last = 0;
    for (int i = 0; i < cycles; ++i) {
        last = command.next();
        rig.pins.set("stepgen.00.position-cmd", last);
        rig.cycle();
    }
    for (int i = 0; i < 500; ++i) {
        rig.cycle();
    }
    return last;
}

TEST(MesaClosedLoop, AMotorFollowsItsCommand) {
    Rig rig({.config = "num_stepgens=1 num_encoders=1", .physics = STEPPER});
    prepare_stepgen(rig, "stepgen.00");
    const double last = run_random(rig, 1, 10'000);
    EXPECT_NEAR(static_cast<double>(rig.steps(0)), last * SCALE, 1.0);
    EXPECT_NEAR(rig.pins.get("stepgen.00.position-fb"), last, 1.0 / SCALE);
    EXPECT_EQ(rig.bus->errors().total(), 0U);
    // 20 counts of the encoder for each step.
    EXPECT_NEAR(rig.pins.get("encoder.00.count"), static_cast<double>(rig.steps(0)) * 20, 20);
}

TEST(MesaClosedLoop, NothingMovesBeforeTheEnable) {
    Rig rig({.config = "num_stepgens=1", .physics = STEPPER});
    prepare_stepgen(rig, "stepgen.00");
    rig.pins.set("stepgen.00.enable", 0);
    for (int i = 0; i < 1000; ++i) {
        rig.pins.set("stepgen.00.position-cmd", 10.0);
        rig.cycle();
    }
    EXPECT_EQ(rig.steps(0), 0);
}

// The goals of hardware.md, part H5: also with all modules of a firmware.
TEST(MesaClosedLoop, ACycleIsOneRequestOneAnswerAndOneWrite) {
    for (const char *model : {"7i76e", "7i80", "7i80hd-3pwm", "7i80hd-resolver", "7i92", "7i92-latch",
                              "7i92-uart", "7i95", "7i96s", "7i97"}) {
        Rig rig({.model = model,
                 .physics = std::string(model) == "7i76e" ? "remote 0 card=7i76\nremote 1 card=7i84\n" : ""});
        rig.cycle();
        rig.cycle();
        const auto before = rig.link.counts();
        for (int i = 0; i < 100; ++i) {
            rig.cycle();
        }
        const auto after = rig.link.counts();
        EXPECT_EQ(after.sent - before.sent, 200U) << model;
        EXPECT_EQ(after.replies - before.replies, 100U) << model;
        EXPECT_EQ(rig.bus->errors().total(), 0U) << model;
    }
}

class MesaLossyNetwork : public ::testing::TestWithParam<const char *> {};

TEST_P(MesaLossyNetwork, AMotorEndsAtItsCommand) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        Rig rig({.config = "num_stepgens=1 num_encoders=1",
                 .physics = STEPPER,
                 .faults = "seed " + std::to_string(seed) + "\n" + GetParam()});
        rig.bus->settings.error_limit = 1'000'000;
        prepare_stepgen(rig, "stepgen.00");
        rig.pins.set("watchdog.timeout_ns", 50'000'000);
        const double last = run_random(rig, seed, 20'000);
        EXPECT_NEAR(static_cast<double>(rig.steps(0)), last * SCALE, 1.0) << GetParam() << " seed " << seed;
        EXPECT_EQ(rig.pins.get("watchdog.has_bit"), 0.0);
        EXPECT_GT(rig.bus->errors().total(), 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, MesaLossyNetwork,
    ::testing::Values("to_board loss=0.001\nto_host loss=0.001", "to_board loss=0.01\nto_host loss=0.01",
                      "to_board loss=0.05\nto_host loss=0.05",
                      "to_board duplicate=0.05 loss=0.001\nto_host duplicate=0.05",
                      "to_board reorder=0.02\nto_host reorder=0.02 loss=0.001",
                      "to_board delay_us=100 jitter_us=300\nto_host delay_us=100 jitter_us=300",
                      "to_board burst=0.001 burst_packets=4"));

TEST(MesaClosedLoop, OnePercentOfLossIsNoFault) {
    Rig rig({.config = "num_stepgens=1 num_encoders=1",
             .physics = STEPPER,
             .faults = "seed 1\nto_board loss=0.01\nto_host loss=0.01"});
    prepare_stepgen(rig, "stepgen.00");
    const double last = run_random(rig, 1, 50'000);
    EXPECT_FALSE(rig.bus->isStopped());
    EXPECT_GT(rig.bus->errors().total(), 500U);
    EXPECT_NEAR(static_cast<double>(rig.steps(0)), last * SCALE, 1.0);
}

TEST(MesaClosedLoop, TheRecordOfCyclesTellsWhichWayPacketsWereLost) {
    Rig rig({.config = "num_stepgens=1", .physics = STEPPER, .faults = "seed 3\nto_board loss=0.01"});
    auto record = std::make_unique<CycleRecord>();
    rig.bus->record_cycles_in(*record);
    prepare_stepgen(rig, "stepgen.00");
    const auto before = rig.link.counts();
    run_random(rig, 3, 5'000);
    const auto lost = static_cast<std::int64_t>((rig.link.counts().sent - before.sent) -
                                                (rig.link.counts().executed - before.executed));
    const CycleRing &ring = record->rings[0];
    std::vector<CycleTimes> cycles;
    for (std::size_t age = ring.size(); age-- > 0;) {
        cycles.push_back(ring.at(age));
    }
    const CycleFigures figures = figures_of(cycles, Rig::PERIOD_NS);
    EXPECT_GT(lost, 50);
    EXPECT_NEAR(static_cast<double>(figures.lost_to_board), static_cast<double>(lost), 2);
    EXPECT_LE(figures.failures(), static_cast<std::size_t>(lost));
}

TEST(MesaClosedLoop, TheRecordOfCyclesIsRightInTheCycleThatStopsTheTraffic) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        Rig rig({.config = "num_stepgens=1", .physics = STEPPER});
        rig.link.disturb({.loss = 0.2}, {}, seed);
        auto record = std::make_unique<CycleRecord>();
        rig.bus->record_cycles_in(*record);
        rig.pins.set("watchdog.timeout_ns", 500'000'000);
        const auto before = rig.link.counts();
        for (int i = 0; i < 8'000 && !rig.bus->isStopped(); ++i) {
            rig.cycle();
        }
        ASSERT_TRUE(rig.bus->isStopped());
        const auto lost = static_cast<std::int64_t>((rig.link.counts().sent - before.sent) -
                                                    (rig.link.counts().executed - before.executed));
        const CycleRing &ring = record->rings[1 - record->current.load()];
        std::vector<CycleTimes> cycles;
        for (std::size_t age = ring.size(); age-- > 0;) {
            cycles.push_back(ring.at(age));
        }
        EXPECT_LE(figures_of(cycles, Rig::PERIOD_NS).lost_to_board, lost) << "seed " << seed;
    }
}

// Random arms at random speeds; the index is at 0.25 rev, which is count 1000 of each revolution of 4000.
TEST(MesaClosedLoop, EachIndexIsLatchedWhereItIs) {
    for (const char *faults : {"", "seed 5\nto_board loss=0.05\nto_host loss=0.05"}) {
        Rig rig({.config = "num_stepgens=1 num_encoders=1", .physics = STEPPER, .faults = faults});
        rig.bus->settings.error_limit = 1'000'000;
        prepare_stepgen(rig, "stepgen.00");
        rig.pins.set("watchdog.timeout_ns", 50'000'000);
        RandomCommand command(7);
        std::mt19937 rng(7);
        int latched = 0;
        bool armed = false;
        for (int i = 0; i < 60'000; ++i) {
            rig.pins.set("stepgen.00.position-cmd", command.next());
            if (!armed && std::bernoulli_distribution(0.02)(rng)) {
                rig.pins.set("encoder.00.index-enable", 1);
                armed = true;
            }
            rig.cycle();
            if (armed && rig.pins.get("encoder.00.index-enable") == 0.0) {
                armed = false;
                ++latched;
                const auto raw = static_cast<std::int64_t>(rig.pins.get("encoder.00.rawlatch"));
                // A step is 20 counts, within which the shaft jumps over the index.
                const auto off = ((raw - 1000) % 4000 + 4000) % 4000;
                ASSERT_TRUE(off <= 20 || off >= 3980)
                    << "raw latch " << raw << " in cycle " << i << " with '" << faults << "'";
            }
        }
        EXPECT_GT(latched, 100) << faults;
    }
}

TEST(MesaClosedLoop, WithoutItsHostTheBoardTurnsItsOutputsOff) {
    Rig rig({.config = "num_stepgens=1", .physics = STEPPER});
    prepare_stepgen(rig, "stepgen.00");
    double position = 0;
    for (int i = 0; i < 1000; ++i) {
        rig.pins.set("stepgen.00.position-cmd", position += 0.05);
        rig.cycle();
    }
    const std::int64_t before = rig.steps(0);
    rig.wait(1'000'000'000);
    const std::int64_t after = rig.steps(0);
    // 50 mm/s for the 5 ms of the watchdog and one period.
    EXPECT_LE(after - before, static_cast<std::int64_t>(50 * SCALE * 0.0061) + 1);
    // The host returns: it detects the bite, and nothing moves until a user resets it.
    for (int i = 0; i < 100; ++i) {
        rig.cycle();
    }
    EXPECT_EQ(rig.pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(rig.steps(0), after);
    rig.pins.set("stepgen.00.enable", 0);
    rig.pins.set("watchdog.has_bit", 0);
    for (int i = 0; i < 10; ++i) {
        rig.cycle();
    }
    EXPECT_EQ(rig.pins.get("watchdog.has_bit"), 0.0);
    EXPECT_EQ(rig.steps(0), after);
    rig.pins.set("stepgen.00.enable", 1);
    rig.pins.set("stepgen.00.position-cmd", rig.pins.get("stepgen.00.position-fb") + 1.0);
    for (int i = 0; i < 1000; ++i) {
        rig.cycle();
    }
    // The step generator has counted while its pins were off; the motor makes only the steps of the new move.
    EXPECT_NEAR(static_cast<double>(rig.steps(0) - after), 1.0 * SCALE, 1.0);
}

TEST(MesaClosedLoop, ABoardThatWasSwitchedOffDoesNotMoveUntilAnOperatorActs) {
    Rig rig({.config = "num_stepgens=1",
             .physics = STEPPER,
             .faults = "event power_off at_ms=500 duration_ms=300"});
    prepare_stepgen(rig, "stepgen.00");
    double position = 0;
    std::int64_t at_stop = -1;
    for (int i = 0; i < 2000; ++i) {
        rig.pins.set("stepgen.00.position-cmd", position += 0.05);
        rig.cycle();
        if (rig.bus->isStopped() && at_stop < 0) {
            at_stop = rig.steps(0);
        }
    }
    ASSERT_GE(at_stop, 0);
    EXPECT_EQ(rig.steps(0), at_stop);
}

// Resetting io_error alone must not switch outputs on: the operator must also clear has_bit.
TEST(MesaClosedLoop, ABiteDuringAStopIsShownAfterTheReset) {
    Rig rig({.config = "num_stepgens=1", .physics = STEPPER});
    const auto run = [&](int cycles) {
        for (int i = 0; i < cycles; ++i) {
            rig.cycle();
        }
    };
    run(10);
    ASSERT_NE(rig.simulated.firmware().read(0x1100), 0U);
    rig.bus->stop();
    run(20);
    EXPECT_EQ(rig.simulated.firmware().read(0x0D00), 1U);
    rig.bus->resume();
    run(5);
    EXPECT_EQ(rig.pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(rig.simulated.firmware().read(0x1100), 0U);
    rig.pins.set("watchdog.has_bit", 0);
    run(5);
    EXPECT_NE(rig.simulated.firmware().read(0x1100), 0U);
}

}  // namespace
}  // namespace mw::mesa::test
