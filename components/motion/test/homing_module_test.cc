// SPDX-License-Identifier: GPL-2.0-or-later
// Homing by a module of a user: it homes, and cannot move a joint outside its limits.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/parameters.hh"
#include "motion/interface/texts.hh"
#include "runtime/virtual_scheduler.hh"
#include "tests/support/limit_checker.hh"

namespace mw::motion {
namespace {

enum class Manner { MILD, FAST, FAR, NOT_A_NUMBER, STUBBORN, GIVING_UP, OWN_PINS, LETTING_GO };

struct HomingModule : ::testing::Test {
    static constexpr double VELOCITY = 20, ACCELERATION = 300, RANGE = 30;
    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    Channels *channels = nullptr;
    CommandId next_id = 1;
    double lowest = 0;
    mw::testing::LimitChecker checker{{{VELOCITY, ACCELERATION}}, 1e-3};

    std::string load(const std::string &name, const std::vector<std::string> &args = {}) {
        const auto status = host->load_realtime(name, args);
        return status.has_value() ? "ok" : status.error().str();
    }
    void start(Manner manner) {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        host = std::move(*hal::LocalHost::create(options, {MW_MODULE_FOLDER, MW_TEST_MODULE_FOLDER}));
        ASSERT_EQ(load("wildhome", {"manner=" + std::to_string(static_cast<int>(manner))}), "ok");
        ASSERT_EQ(load("homemod", {"replaced_by=wildhome"}), "ok");
        ASSERT_EQ(load("trivkins", {"coordinates=X"}), "ok");
        ASSERT_EQ(load("motmod", {"servo_period_nsec=1000000", "num_joints=1"}), "ok");
        hal::Instance &hal = host->hal();
        ASSERT_TRUE(hal.signals().net("pos", {"joint.0.motor-pos-cmd", "joint.0.motor-pos-fb"}));
        ASSERT_TRUE(hal.threads().add_function("motion-command-handler", "servo-thread"));
        ASSERT_TRUE(hal.threads().add_function("motion-controller", "servo-thread"));
        ASSERT_TRUE(hal.threads().start());
        channels = static_cast<Channels *>(*hal.memory().shared_block(Channels::SHMEM_KEY, sizeof(Channels)));
        send(Abort{1});
        set(Parameter::JOINT_MAX_VELOCITY, VELOCITY);
        set(Parameter::JOINT_MAX_ACCELERATION, ACCELERATION);
        set(Parameter::JOINT_MIN_LIMIT, -RANGE / 2);
        set(Parameter::JOINT_MAX_LIMIT, RANGE / 2);
        send(Enable{});
        run(0.05);
        send(Home{0});
        run(0.003);
    }
    void send(const CommandBody &body) { channels->immediate.push({next_id++, 1, body}); }
    void set(Parameter p, double value) { send(SetParameter{static_cast<std::uint16_t>(p), 0, value}); }
    double motor() { return host->hal().values().get("joint.0.motor-pos-cmd")->as_number(); }
    bool isHomed() { return host->hal().values().get("motion.is-all-homed")->as_number() != 0; }
    void run(double seconds) {
        for (int n = 0; n < seconds * 1000; ++n) {
            clock.run_until(clock.now_ns() + 1000000);
            const double q = motor();
            checker.sample(&q);
            lowest = std::min(lowest, q);
        }
    }
    std::string faults() {
        std::string out;
        Fault f;
        while (channels->servo_faults.pop(f)) {
            out += fault_text(f) + '\n';
        }
        return out;
    }
};

TEST_F(HomingModule, HomesAndGivesTheJointItsPlace) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::MILD));
    EXPECT_EQ(host->hal().values().get("joint.0.homing")->as_number(), 1);
    run(5);
    EXPECT_TRUE(isHomed());
    EXPECT_NEAR(motor(), -2, 1e-9) << "4 below the start is 10, and it went to 12";
    EXPECT_NEAR(host->hal().values().get("joint.0.pos-fb")->as_number(), 12, 1e-9);
    EXPECT_EQ(faults(), "");
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LE(checker.worst_velocity(), 5.0 / VELOCITY + 1e-6) << "as slowly as it asked for";
}

TEST_F(HomingModule, SeesFeedbackAndLimitsOfThisCycle) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::MILD));
    const auto pin = [&](const char *name) { return host->hal().values().get(name)->as_number(); };
    int moving = 0;
    for (int n = 0; n < 5000; ++n) {
        const double before = motor();
        run(0.001);
        moving += motor() != before ? 1 : 0;
        ASSERT_EQ(pin("wildhome.0.motor-pos-fb"), before);
        ASSERT_NEAR(pin("wildhome.0.pos-fb"), before - pin("wildhome.0.motor-offset"), 1e-12) << n;
    }
    EXPECT_GT(moving, 500);
    EXPECT_EQ(pin("wildhome.0.vel-limit"), VELOCITY);
    EXPECT_EQ(pin("wildhome.0.acc-limit"), ACCELERATION);
    EXPECT_EQ(pin("wildhome.0.min-pos-limit"), -RANGE / 2);
    EXPECT_EQ(pin("wildhome.0.max-pos-limit"), RANGE / 2);
}

TEST_F(HomingModule, IsKeptWithinSpeedAccelerationAndRangeAndThatIsTold) {
    for (const Manner manner : {Manner::FAST, Manner::FAR}) {
        ASSERT_NO_FATAL_FAILURE(start(manner));
        lowest = 0;
        run(30);
        EXPECT_TRUE(isHomed());
        EXPECT_GE(lowest, -2 * RANGE - 1e-9);
        EXPECT_EQ(faults(), "the homing module commanded more than the limits of joint 0 allow: the joint "
                            "moves within its limits\n");
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        checker.restart();
        host.reset();
    }
}

TEST_F(HomingModule, WhatIsNoNumberEndsHoming) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::NOT_A_NUMBER));
    run(2);
    EXPECT_FALSE(isHomed());
    EXPECT_EQ(motor(), 0);
    EXPECT_NE(faults().find("not a finite number"), std::string::npos);
}

TEST_F(HomingModule, AnAbortStopsItWhetherItHearsOrNot) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::STUBBORN));
    run(1);
    send(Abort{2});
    run(0.5);
    const double stood = motor();
    EXPECT_LT(stood, -1);
    run(2);
    EXPECT_EQ(motor(), stood);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

TEST_F(HomingModule, AJointThatItLetsGoOfBrakesAndStands) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::LETTING_GO));
    run(1);
    const double stood = motor();
    EXPECT_LT(stood, -2);
    EXPECT_GT(stood, -2.2) << "it braked at once";
    run(1);
    EXPECT_EQ(motor(), stood);
    EXPECT_EQ(host->hal().values().get("joint.0.homing")->as_number(), 1);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

TEST_F(HomingModule, OneThatGivesUpIsToldOf) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::GIVING_UP));
    run(5);
    EXPECT_FALSE(isHomed());
    EXPECT_EQ(faults(),
              "homing of joint 0 failed: the homing module reported a failure; check its messages\n");
}

TEST_F(HomingModule, MayHaveTheHomingPinsItself) {
    ASSERT_NO_FATAL_FAILURE(start(Manner::OWN_PINS));
    EXPECT_TRUE(host->hal().values().get("joint.0.home-sw-in").has_value());
    EXPECT_FALSE(host->hal().values().get("joint.0.homing").has_value());
    run(5);
    EXPECT_TRUE(isHomed());
}

}  // namespace
}  // namespace mw::motion
