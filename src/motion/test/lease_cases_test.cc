// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs with a lease: their ends, their limits and their motion.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

TEST(JogLease, WorksIfJointsAreNotAxes) {
    kinematics::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    rig.ready(Mode::TELEOP);
    for (int n = 0; n < 10; ++n) {
        rig.send(JogContinuous{{false, 0}, 30, 0.1, n > 0});
        rig.step(90);
        EXPECT_NEAR(rig.status().current_velocity, 30, 1e-6) << n;
    }
    rig.step(9);
    EXPECT_NEAR(rig.status().current_velocity, 30, 1e-6);
    rig.step(3);
    EXPECT_LT(rig.status().current_velocity, 29.9);
    rig.step(100);
    EXPECT_TRUE(rig.status().isInPosition);
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::JOG_LEASE_ENDED);
    EXPECT_NEAR(rig.faults[0].value, 0.1, 1e-12);
}

/// An operator holds the key at the soft limit: no error, no motion, and no message on release.
TEST(JogLease, AtTheSoftLimitRenewalsChangeNothing) {
    MotionRig rig;
    rig.set(Parameter::JOINT_MAX_LIMIT, 0, 2);
    rig.ready(Mode::FREE);
    for (int n = 0; n < 20; ++n) {
        const CommandId id = rig.send(JogContinuous{{true, 0}, 50, 0.1, n > 0 && n % 2 == 0});
        rig.step(50);
        EXPECT_TRUE(rig.isDone(id)) << n;
    }
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 2.0);
    rig.step(200);
    EXPECT_TRUE(rig.faults.empty());
    const CommandId late = rig.send(JogContinuous{{true, 0}, 50, 0.1, true});
    const CommandId fresh = rig.send(JogContinuous{{true, 0}, 50, 0.1});
    rig.step();
    EXPECT_EQ(rig.refusal(late), Reason::NO_JOG_TO_RENEW);
    EXPECT_EQ(rig.refusal(fresh), Reason::BEYOND_SOFT_LIMIT);
}

/// A client that has not received a stop renews its jog: nothing moves, whether the jog moved or was stopped
/// at a limit.
TEST(JogLease, NoRenewalOutlivesAStop) {
    struct Stop {
        const char *name;
        std::function<void(MotionRig &)> make;
    };
    const Stop stops[] = {
        {"abort", [](MotionRig &r) { r.send(Abort{++r.epoch}); }},
        {"jog stop", [](MotionRig &r) { r.send(JogStop{{true, 0}}); }},
        {"off", [](MotionRig &r) { r.send(Disable{}); }},
        {"enable input",
         [](MotionRig &r) {
             r.in.isEnableOn = false;
             r.step();
             r.in.isEnableOn = true;
         }},
        {"modes",
         [](MotionRig &r) {
             r.run_until([&] { return r.status().isInPosition; }, 30);  // rejected while it moves
             r.send(SetMode{Mode::TELEOP});
             r.send(SetMode{Mode::FREE});
         }},
        {"homing", [](MotionRig &r) { r.send(Home{1}); }},
        {"stop pin",
         [](MotionRig &r) {
             r.in.isJogStopped = true;
             r.step();
             r.in.isJogStopped = false;
         }},
        {"stop pin, at once",
         [](MotionRig &r) {
             r.in.isJogStoppedNow = true;
             r.step();
             r.in.isJogStoppedNow = false;
         }},
        {"a fault",
         [](MotionRig &r) {
             r.in.joint[1].isPosLimitClosed = true;
             r.run_until([&] { return !r.status().isEnabled; }, 5);
             r.in.joint[1].isPosLimitClosed = false;
         }},
    };
    for (const Stop &stop : stops) {
        for (const double limit : {1000.0, 2.0}) {
            SCOPED_TRACE(std::string(stop.name) + " limit " + std::to_string(limit));
            MotionRig rig;
            rig.set(Parameter::JOINT_MAX_LIMIT, 0, limit);
            rig.ready(Mode::FREE);
            const CommandId jog = rig.send(JogContinuous{{true, 0}, 20, 8});
            rig.step(200);
            ASSERT_TRUE(rig.isDone(jog));
            stop.make(rig);
            rig.step(2);
            ASSERT_TRUE(
                rig.run_until([&] { return rig.status().isInPosition && !rig.status().isHoming; }, 30));
            rig.send(Enable{});
            rig.step(2);
            ASSERT_TRUE(rig.status().isEnabled);
            const double place = rig.out->joint[0].motor_pos_cmd;
            const CommandId late = rig.send(JogContinuous{{true, 0}, 20, 8, true});
            rig.step(100);
            EXPECT_EQ(rig.refusal(late), Reason::NO_JOG_TO_RENEW);
            EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, place);
        }
    }
}

/// The jog ends twice the travel from its start, not from its renewal.
TEST(JogLease, OfAnUnhomedJointEndsAsWithoutRenewals) {
    const auto end_of = [](bool isLeased) {
        MotionRig rig;
        rig.set(Parameter::JOINT_MIN_LIMIT, 0, -2);
        rig.set(Parameter::JOINT_MAX_LIMIT, 0, 2);
        rig.send(Enable{});
        rig.step(2);
        for (int n = 0; n < 40; ++n) {
            if (n == 0 || isLeased) {
                rig.send(JogContinuous{{true, 0}, 50, isLeased ? 0.1 : 0.0});
            }
            rig.step(50);
        }
        return rig.out->joint[0].motor_pos_cmd;
    };
    EXPECT_GT(end_of(true), 5);
    EXPECT_EQ(end_of(true), end_of(false));
}

}  // namespace
}  // namespace mw::motion
