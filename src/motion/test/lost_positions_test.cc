// SPDX-License-Identifier: GPL-2.0-or-later
// A driver reports that its positions do not match the machine.
#include <gtest/gtest.h>

#include "motion/interface/texts.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

geometry::Pose x_at(double x) {
    geometry::Pose pose;
    pose[0] = x;
    return pose;
}

bool isNothingKnown(const MotionRig &rig) {
    const Status &s = rig.status();
    return !s.isEnabled && !s.isAllHomed && !s.joint[0].isHomed && !s.joint[1].isHomed &&
           !s.joint[2].isHomed && !rig.out->joint[0].isAmpEnabled;
}

TEST(LostPositions, AMovingMachineIsSwitchedOffInTheSameCycleAndUnhomed) {
    for (const Mode mode : {Mode::COORD, Mode::TELEOP, Mode::FREE}) {
        MotionRig rig;
        rig.ready(mode);
        if (mode == Mode::COORD) {
            rig.line(x_at(100));
            rig.send_path(Flush{});
        } else {
            rig.send(JogContinuous{{mode == Mode::FREE, 0}, 20});
        }
        rig.step(300);
        ASSERT_GT(std::abs(rig.status().joint[0].vel_cmd), 1.0);
        ++rig.in.lost_positions;
        rig.step();
        EXPECT_TRUE(isNothingKnown(rig));
        ASSERT_EQ(rig.faults.size(), 1U);
        EXPECT_EQ(rig.faults[0].kind, FaultKind::POSITIONS_LOST);
        EXPECT_NE(fault_text(rig.faults[0]).find("home all joints"), std::string::npos);
        rig.step(1000);
        EXPECT_TRUE(isNothingKnown(rig)) << "nothing comes back by itself";
        EXPECT_EQ(rig.faults.size(), 1U);
        const double rests_at = rig.out->joint[0].motor_pos_cmd;
        rig.send(Enable{});
        rig.step(100);
        EXPECT_TRUE(rig.status().isEnabled) << "an operator may switch it on";
        EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, rests_at);
        EXPECT_FALSE(rig.status().isAllHomed);
        rig.send(SetMode{Mode::FREE});
        rig.step(10);
        rig.ready();
        EXPECT_TRUE(rig.status().isAllHomed);
    }
}

TEST(LostPositions, AMachineThatIsOffLosesItsHomes) {
    MotionRig rig;
    rig.ready();
    rig.send(Disable{});
    rig.step(5);
    rig.faults.clear();
    ASSERT_TRUE(rig.status().isAllHomed);
    ++rig.in.lost_positions;
    rig.step();
    EXPECT_TRUE(isNothingKnown(rig));
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::POSITIONS_LOST);
}

TEST(LostPositions, HomingEnds) {
    MotionRig rig;
    rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 0, 5);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 1);
    rig.step(5);
    rig.send(Enable{});
    rig.send(Home{0});
    rig.step(300);
    ASSERT_TRUE(rig.status().isHoming);
    ++rig.in.lost_positions;
    rig.step();
    EXPECT_FALSE(rig.status().isHoming);
    EXPECT_TRUE(isNothingKnown(rig));
}

TEST(LostPositions, AMachineWithoutHomesLosesNothing) {
    MotionRig rig;
    rig.step(5);
    ++rig.in.lost_positions;
    rig.step(5);
    EXPECT_TRUE(rig.faults.empty());
}

}  // namespace
}  // namespace mw::motion
