// SPDX-License-Identifier: GPL-2.0-or-later
// Tests that the driver reports once, with the cause, when its positions are no longer those of the machine,
// and that it does not report otherwise.
#include <string>

#include <gtest/gtest.h>

#include "drivers/mesa/test/rig.hh"

namespace mw::mesa::test {
namespace {

constexpr const char *MOTOR_WITH_ENCODER =
    "motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=x counts_per_rev=4000 index_rev=0.25\n";
constexpr const char *STEPPER_CONFIG = "num_stepgens=1 num_encoders=1",
                     *SERVO_CONFIG = "num_stepgens=0 num_encoders=1";

/// Runs cycles and collects the driver's reports about positions.
struct Watched {
    Rig rig;
    int losses = 0;
    PositionLoss cause = PositionLoss::NONE;
    int first_cycle = -1;  ///< cycle of the first loss

    explicit Watched(const RigPlan &plan) : rig(plan) {
        if (plan.config == STEPPER_CONFIG) {
            rig.pins.set("stepgen.00.position-scale", 100);
            rig.pins.set("stepgen.00.maxaccel", 3000);
            rig.pins.set("stepgen.00.steplen", 2000);
            rig.pins.set("stepgen.00.stepspace", 2000);
            rig.pins.set("stepgen.00.enable", 1);
        }
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            rig.read();
            ++cycle_;
            const PositionLoss lost = rig.driver->take_position_loss();
            rig.write();
            if (lost != PositionLoss::NONE) {
                ++losses;
                cause = lost;
                first_cycle = first_cycle < 0 ? cycle_ : first_cycle;
            }
        }
    }
    void happen(board::FaultType type, std::int64_t duration_ns = 0) {
        rig.link.perform({.type = type, .at_ns = rig.transport->now_ns(), .duration_ns = duration_ns});
    }

  private:
    int cycle_ = 0;
};

TEST(MesaLostPositions, ABoardThatWasSwitchedOffHasLostThemWhenTheTrafficStops) {
    for (const char *config : {STEPPER_CONFIG, SERVO_CONFIG}) {
        Watched watched({.config = config, .physics = MOTOR_WITH_ENCODER});
        watched.run(500);
        ASSERT_EQ(watched.losses, 0);
        watched.happen(board::FaultType::POWER_OFF, 300'000'000);
        watched.run(2000);
        EXPECT_EQ(watched.losses, 1) << config;
        EXPECT_EQ(watched.cause, PositionLoss::STOPPED);
        EXPECT_LE(watched.first_cycle, 500 + 5) << "five failures reach the limit";
        watched.rig.bus->resume();
        watched.run(50);
        EXPECT_EQ(watched.losses, 2) << "the operator learns that the board has restarted, too";
        EXPECT_EQ(watched.cause, PositionLoss::RESTARTED);
    }
}

TEST(MesaLostPositions, ALinkThatReturnsDoesNotMakeThemValid) {
    Watched watched({.config = STEPPER_CONFIG, .physics = MOTOR_WITH_ENCODER});
    watched.run(500);
    watched.happen(board::FaultType::LINK_DOWN, 300'000'000);
    watched.run(1000);
    EXPECT_EQ(watched.losses, 1);
    EXPECT_EQ(watched.cause, PositionLoss::STOPPED);
    EXPECT_LE(watched.first_cycle, 500 + 5);
}

// Too short for the limit of failures: no traffic is stopped.
TEST(MesaLostPositions, ARestartIsSeenInTheFirstReadAfterIt) {
    for (const char *config : {STEPPER_CONFIG, SERVO_CONFIG}) {
        for (const std::int64_t off_ns : {0LL, 2'500'000LL}) {
            Watched watched({.config = config, .physics = MOTOR_WITH_ENCODER});
            watched.run(500);
            watched.happen(off_ns == 0 ? board::FaultType::RESET : board::FaultType::POWER_OFF, off_ns);
            watched.run(500);
            EXPECT_EQ(watched.losses, 1) << config;
            EXPECT_EQ(watched.cause, PositionLoss::RESTARTED);
            EXPECT_LE(watched.first_cycle, 500 + 4);
        }
    }
}

TEST(MesaLostPositions, CountersThatRestartDoNotMoveTheShownPositions) {
    Watched watched({.config = STEPPER_CONFIG, .physics = MOTOR_WITH_ENCODER});
    for (int i = 0; i < 1000; ++i) {
        watched.rig.pins.set("stepgen.00.position-cmd", 0.02 * i);
        watched.run(1);
    }
    watched.run(200);
    const double position = watched.rig.pins.get("stepgen.00.position-fb");
    const double counts = watched.rig.pins.get("encoder.00.count");
    ASSERT_NEAR(position, 19.98, 0.02);
    watched.happen(board::FaultType::RESET);
    watched.run(50);
    ASSERT_EQ(watched.losses, 1);
    EXPECT_EQ(watched.rig.pins.get("stepgen.00.position-fb"), position);
    EXPECT_EQ(watched.rig.pins.get("encoder.00.count"), counts);
}

// After a bite the step generators continue without their pins. Encoders count the movement of the motor.
TEST(MesaLostPositions, ABiteLosesThoseOfEnabledStepGeneratorsOnly) {
    Watched stepper({.config = STEPPER_CONFIG, .physics = MOTOR_WITH_ENCODER});
    stepper.run(500);
    stepper.rig.wait(20'000'000);
    stepper.run(50);
    EXPECT_EQ(stepper.losses, 1);
    EXPECT_EQ(stepper.cause, PositionLoss::BITTEN);

    Watched servo({.config = SERVO_CONFIG, .physics = MOTOR_WITH_ENCODER});
    servo.run(500);
    servo.rig.wait(20'000'000);
    servo.run(50);
    EXPECT_EQ(servo.rig.pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(servo.losses, 0);

    Watched off({.config = STEPPER_CONFIG, .physics = MOTOR_WITH_ENCODER});
    off.rig.pins.set("stepgen.00.enable", 0);
    off.run(500);
    off.rig.wait(20'000'000);
    off.run(50);
    EXPECT_EQ(off.rig.pins.get("watchdog.has_bit"), 1.0);
    EXPECT_EQ(off.losses, 0);
}

TEST(MesaLostPositions, LostLateAndDisorderedPacketsLoseNone) {
    for (const char *faults :
         {"to_board loss=0.02\nto_host loss=0.02", "to_board duplicate=0.05\nto_host duplicate=0.05",
          "to_board reorder=0.05\nto_host reorder=0.05",
          "to_board delay_us=500 jitter_us=1500\nto_host delay_us=100 jitter_us=300",
          "to_board burst=0.001 burst_packets=4"}) {
        Watched watched({.config = STEPPER_CONFIG,
                         .physics = MOTOR_WITH_ENCODER,
                         .faults = std::string("seed 3\n") + faults});
        watched.rig.bus->settings.error_limit = 1'000'000;
        watched.rig.pins.set("watchdog.timeout_ns", 50'000'000);
        watched.run(20'000);
        EXPECT_EQ(watched.losses, 0) << faults;
        EXPECT_GT(watched.rig.bus->errors().total() + watched.rig.bus->counters().stale, 0U) << faults;
    }
}

// The first packet that a board gets after its restart may be a write.
TEST(MesaLostPositions, NoWriteHidesARestart) {
    for (int us = 0; us < 4'000; us += 50) {
        Watched watched({.config = SERVO_CONFIG, .physics = MOTOR_WITH_ENCODER});
        watched.run(20);
        watched.happen(board::FaultType::POWER_OFF, us * 1'000);
        watched.run(20);
        EXPECT_EQ(watched.losses, 1) << us << " us";
        EXPECT_EQ(watched.cause, PositionLoss::RESTARTED) << us << " us";
        EXPECT_FALSE(watched.rig.bus->isStopped()) << us << " us";
    }
}

}  // namespace
}  // namespace mw::mesa::test
