// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are not axes, as loaded modules: joints stay within their limits on paths and in axis
// jogs. The judge is that of VirtualMachineTest.
#include <cmath>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class KinematicsTest : public VirtualMachineTest {
  protected:
    void make_table(double x_limit = 1000) {
        SimMachine table;
        table.coordinates = "XYZAC";
        table.kinematics = "tablekins";
        const SimJoint linear{false, 200, 1500, -x_limit, x_limit, 0};
        const SimJoint rotary{true, 180, 720, -3600, 3600, 0};
        table.joints = {linear, linear, linear, rotary, rotary};
        switch_on_config(table.write(folder_));
    }
    /// An arm that is homed with these angles of shoulder and elbow.
    void make_scara(double shoulder, double elbow) {
        SimMachine arm;
        arm.coordinates = "XYZABC";
        arm.kinematics = "scarakins";
        const SimJoint linear{false, 200, 1500, -1000, 1000, 0};
        const SimJoint rotary{true, 180, 720, -3600, 3600, 0};
        arm.joints = {rotary, rotary, linear, rotary, rotary, rotary};
        arm.joints[0].home = shoulder;
        arm.joints[1].home = elbow;
        switch_on_config(arm.write(folder_));
    }
    /// A part that rotates under a tool at X10.
    void make_rose() {
        SimMachine rose;
        rose.axis_range = 1000;
        rose.kinematics = "rosekins";
        rose.joints = {{false, 200, 1500, 0, 1000, 0, 10}, {}, {true, 360, 7200, -3600, 3600, 0}};
        switch_on_config(rose.write(folder_));
    }
    void jog(int axis, double velocity, double distance) {
        post(task::JogIncrement{false, axis, velocity, distance});
        for (int i = 0; i < 60000 && (i < 20 || !motion().isInPosition); ++i) {
            cycles(1);
        }
    }
};

TEST_F(KinematicsTest, ATableTurnsASlowlyAsItsJointsAsk) {
    make_table();
    ASSERT_EQ(mdi("G21 G90 G0 X100"), task::Progress::DONE) << messages();
    ASSERT_EQ(mdi("G0 C180"), task::Progress::DONE) << messages();
    EXPECT_NEAR(motion().joint[0].pos_cmd, -100, 1e-6);
    EXPECT_EQ(judge_.report(), "");
    EXPECT_GT(judge_.count(), 1000U);
}

TEST_F(KinematicsTest, TeleopKeepsJointLimits) {
    make_table();
    ASSERT_EQ(mdi("G21 G90 G0 X200"), task::Progress::DONE) << messages();
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    ASSERT_EQ(motion().mode, motion::Mode::TELEOP);
    jog(geometry::AXIS_C, 180, 180);
    EXPECT_NEAR(motion().carte_pos_cmd[geometry::AXIS_C], 180, 1e-6);
    EXPECT_NEAR(motion().joint[0].pos_cmd, -200, 1e-6);
}

TEST_F(KinematicsTest, ATeleopJogStopsBeforeAJointsSoftLimit) {
    make_table(150);
    ASSERT_EQ(mdi("G21 G90 G0 X140 Y140"), task::Progress::DONE) << messages();
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    jog(geometry::AXIS_C, 180, -60);
    EXPECT_LT(std::abs(motion().carte_pos_cmd[geometry::AXIS_C]), 59);
    EXPECT_NE(messages().find("would leave its soft limits"), std::string::npos);
    jog(geometry::AXIS_C, 180, -motion().carte_pos_cmd[geometry::AXIS_C]);
    EXPECT_NEAR(motion().carte_pos_cmd[geometry::AXIS_C], 0, 1e-6) << "and can be jogged back";
}

TEST_F(KinematicsTest, AnElbowStaysOnItsSide) {
    for (const double side : {1.0, -1.0}) {
        make_scara(side * 30, side * 60);
        for (const char *line : {"G21 G90 G1 X350 Y200 F6000", "X200 Y-300", "X-350 Z400", "Y100"}) {
            ASSERT_EQ(mdi(line), task::Progress::DONE) << line << ": " << messages();
            EXPECT_GT(side * motion().joint[1].pos_cmd, 5) << line;
        }
        cycles(2);  // the feedback is one cycle late
        EXPECT_NEAR(motion().carte_pos_fb[geometry::AXIS_X], -350, 1e-6);
        EXPECT_NEAR(motion().carte_pos_fb[geometry::AXIS_Y], 100, 1e-6);
        EXPECT_EQ(judge_.report(), "");
    }
}

TEST_F(KinematicsTest, WhatIsOutOfReachOrSingularIsRefusedBeforeItBegins) {
    make_scara(30, 60);
    const double x = motion().carte_pos_cmd[geometry::AXIS_X];
    EXPECT_NE(mdi("G21 G90 G1 X700 F6000"), task::Progress::DONE);
    EXPECT_NE(messages().find("cannot reach"), std::string::npos) << messages();
    EXPECT_NE(mdi("G1 X0 Y640 F6000"), task::Progress::DONE) << "the arm stretched";
    EXPECT_NE(messages().find("singular"), std::string::npos) << messages();
    EXPECT_EQ(motion().carte_pos_cmd[geometry::AXIS_X], x);
    EXPECT_EQ(mdi("G1 X350 Y200 F6000"), task::Progress::DONE) << messages();
}

TEST_F(KinematicsTest, AStretchedArmIsJoggedOffByAJoint) {
    make_scara(0, 0);
    EXPECT_NE(mdi("G21 G90 G1 X500 F6000"), task::Progress::DONE);
    EXPECT_NE(messages().find("singular"), std::string::npos) << messages();
    EXPECT_TRUE(motion().isEnabled) << "it may be there";
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{false});
    cycles(20);
    post(task::JogIncrement{true, 1, 50, 40});
    for (int i = 0; i < 60000 && (i < 20 || !motion().isInPosition); ++i) {
        cycles(1);
    }
    EXPECT_NEAR(motion().joint[1].pos_cmd, 40, 1e-6);
    EXPECT_EQ(mdi("G1 X500 F6000"), task::Progress::DONE) << messages();
    EXPECT_GT(motion().joint[1].pos_cmd, 5);
}

TEST_F(KinematicsTest, APointOnThreeLegsIsNotLedThroughTheirPlane) {
    SimMachine tripod;
    tripod.axis_range = 1000;
    tripod.kinematics = "tripodkins";
    tripod.hal_lines = "setp tripodkins.Bx 400\nsetp tripodkins.Cx 200\nsetp tripodkins.Cy 350\n";
    tripod.joints = {{false, 200, 1500, 1, 1000, 0, 300},
                     {false, 200, 1500, 1, 1000, 0, 300},
                     {false, 200, 1500, 1, 1000, 0, 300}};
    switch_on_config(tripod.write(folder_));
    const double z = motion().carte_pos_cmd[geometry::AXIS_Z];
    ASSERT_GT(z, 100) << "above the motors";
    EXPECT_NE(mdi("G21 G90 G1 Z-37 F6000"), task::Progress::DONE) << "no checked point is in the plane";
    EXPECT_NE(messages().find("singular"), std::string::npos) << messages();
    EXPECT_EQ(motion().carte_pos_cmd[geometry::AXIS_Z], z);
    EXPECT_EQ(mdi("G1 X150 Y80 Z20 F6000"), task::Progress::DONE) << messages();
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    jog(geometry::AXIS_Z, 50, -40);
    EXPECT_GT(motion().carte_pos_cmd[geometry::AXIS_Z], 0) << "nor by a jog";
    EXPECT_TRUE(motion().isEnabled) << messages();
}

TEST_F(KinematicsTest, NoLineLeadsThroughTheAxisOfARoseEngine) {
    make_rose();
    EXPECT_NE(mdi("G21 G90 G1 X-7 F6000"), task::Progress::DONE);
    EXPECT_NE(messages().find("singular"), std::string::npos) << messages();
    EXPECT_EQ(motion().joint[0].pos_cmd, 10);
    EXPECT_EQ(mdi("G1 X10 Y2 F6000"), task::Progress::DONE) << messages();
    EXPECT_EQ(mdi("G1 X-10 F6000"), task::Progress::DONE) << "2 beside it: " << messages();
    EXPECT_NEAR(motion().joint[2].pos_cmd, 168.69, 0.01);
    EXPECT_EQ(mdi("G1 X10 Y0.2 F6000"), task::Progress::DONE) << messages();
    EXPECT_EQ(mdi("G1 X-10 F6000"), task::Progress::DONE) << "0.2 beside it: " << messages();
    EXPECT_EQ(mdi("G1 Y2 F6000"), task::Progress::DONE) << messages();
    for (const char *beside : {"0.02", "-0.001", "0.0000001"}) {
        EXPECT_EQ(mdi("G1 X10 Y2 F6000"), task::Progress::DONE) << messages();
        EXPECT_EQ(mdi(std::string("G1 Y") + beside), task::Progress::DONE) << messages();
        EXPECT_NE(mdi("G1 X-10 F6000"), task::Progress::DONE) << beside << ": would crawl past";
        EXPECT_NE(messages().find("singular"), std::string::npos) << beside;
    }
}

TEST_F(KinematicsTest, AfterAnAbortTurnsAreCountedFromWhereItStands) {
    make_rose();
    EXPECT_NE(mdi("G21 G90 G17 G3 X10 Y0 I-10 J0 P11 F6000"), task::Progress::DONE) << "3960 degrees";
    EXPECT_NE(messages().find("exceeds the soft limit of a joint"), std::string::npos) << messages();
    post(task::Mdi{"G3 X10 Y0 I-10 J0 P9 F6000"});
    for (int i = 0; i < 60000 && motion().joint[2].pos_cmd < 400; ++i) {
        cycles(1);
    }
    ask(task::AbortAll{});
    cycles(2000);
    ASSERT_LT(motion().joint[2].pos_cmd, 1800);
    EXPECT_EQ(mdi("G1 X10 Y0 F6000"), task::Progress::DONE) << messages();
    EXPECT_EQ(mdi("G3 X10 Y0 I-10 J0 P5 F6000"), task::Progress::DONE)
        << "from 9 revolutions it would be outside the limit: " << messages();
}

TEST_F(KinematicsTest, APlatformMovesOnceItsPoseIsKnown) {
    SimMachine hexapod;
    hexapod.coordinates = "XYZABC";
    hexapod.axis_range = 1000;
    hexapod.kinematics = "genhexkins";
    hexapod.joints = std::vector<SimJoint>(6, SimJoint{false, 200, 1500, 1, 1000, 0, 29.7467});
    switch_on_config(hexapod.write(folder_));
    EXPECT_NE(mdi("G21 G90 G1 X1 F600"), task::Progress::DONE) << "the strut lengths alone define no pose";
    EXPECT_NE(messages().find("found no pose"), std::string::npos) << messages();
    EXPECT_NEAR(motion().joint[0].pos_cmd, 29.7467, 1e-9);
    hexapod.hal_lines = "setp genhexkins.z 18\n";
    switch_on_config(hexapod.write(folder_));
    EXPECT_NEAR(motion().carte_pos_cmd[geometry::AXIS_Z], 20, 1e-3);
    EXPECT_EQ(mdi("G21 G90 G1 X3 Y-2 Z25 A5 B-4 C6 F600"), task::Progress::DONE) << messages();
    EXPECT_NEAR(motion().carte_pos_fb[geometry::AXIS_B], -4, 1e-6);
    hexapod.hal_lines.clear();
    hexapod.traj = "HOME = 0 0 20 0 0 0\n";  // as in the INI files of LinuxCNC
    switch_on_config(hexapod.write(folder_));
    EXPECT_EQ(mdi("G21 G90 G1 X3 Y-2 Z25 A5 B-4 C6 F600"), task::Progress::DONE) << messages();
    EXPECT_NEAR(motion().carte_pos_fb[geometry::AXIS_Z], 25, 1e-6);
}

TEST_F(KinematicsTest, APinOfTheKinematicsThatIsChangedMakesNoJointStep) {
    SimMachine table;
    table.coordinates = "XYZAC";
    table.kinematics = "xyzac-trt-kins";
    const SimJoint rotary{true, 180, 720, -3600, 3600, 0};
    table.joints = {{}, {}, {}, rotary, rotary};
    switch_on_config(table.write(folder_));
    set_pin("xyzac-trt-kins.tool-offset", "50");
    cycles(20);
    ASSERT_EQ(mdi("G21 G90 G0 A30"), task::Progress::DONE) << "level it makes no difference: " << messages();
    const double y = motion().joint[1].pos_cmd;
    set_pin("xyzac-trt-kins.tool-offset", "80");
    cycles(20);
    EXPECT_FALSE(motion().isEnabled);
    EXPECT_NE(messages().find("would jump"), std::string::npos);
    EXPECT_NEAR(motion().joint[1].pos_cmd, y, 1e-6);
}

TEST_F(KinematicsTest, AGantryIsStillOfAxesWhateverItsKinstype) {
    SimMachine gantry;
    gantry.coordinates = "XYYZ";
    gantry.kinematics = "trivkins coordinates=XYYZ kinstype=BOTH";
    gantry.joints.resize(4);
    switch_on_config(gantry.write(folder_));
    ASSERT_EQ(mdi("G21 G90 G1 X10 Y20 F600"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(motion().joint[1].pos_cmd, 20);
    EXPECT_DOUBLE_EQ(motion().joint[2].pos_cmd, 20);
}

}  // namespace
}  // namespace mw::machine
