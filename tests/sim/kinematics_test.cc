// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are not axes, as loaded modules: joints within their limits on paths and in axis
// jogs. The judge is that of every VirtualMachineTest.
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
    void jog(int axis, double velocity, double distance) {
        post(task::JogIncrement{false, axis, velocity, distance});
        for (int i = 0; i < 60000 && (i < 20 || !motion().isInPosition); ++i) {
            cycles(1);
        }
    }
};

TEST_F(KinematicsTest, ATableTurnsASlowlyAsItsJointsAsk_C13) {
    make_table();
    ASSERT_EQ(mdi("G21 G90 G0 X100"), task::Progress::DONE) << messages();
    ASSERT_EQ(mdi("G0 C180"), task::Progress::DONE) << messages();
    EXPECT_NEAR(motion().joint[0].pos_cmd, -100, 1e-6);
    EXPECT_EQ(judge_.report(), "");
    EXPECT_GT(judge_.count(), 1000U);
}

TEST_F(KinematicsTest, TeleopKeepsJointLimits_C9) {
    make_table();
    ASSERT_EQ(mdi("G21 G90 G0 X200"), task::Progress::DONE) << messages();
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    ASSERT_EQ(motion().mode, motion::Mode::TELEOP);
    jog(geom::AXIS_C, 180, 180);
    EXPECT_NEAR(motion().carte_pos_cmd[geom::AXIS_C], 180, 1e-6);
    EXPECT_NEAR(motion().joint[0].pos_cmd, -200, 1e-6);
}

TEST_F(KinematicsTest, ATeleopJogStopsBeforeAJointsSoftLimit_C13) {
    make_table(150);
    ASSERT_EQ(mdi("G21 G90 G0 X140 Y140"), task::Progress::DONE) << messages();
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{true});
    cycles(20);
    jog(geom::AXIS_C, 180, -60);
    EXPECT_LT(std::abs(motion().carte_pos_cmd[geom::AXIS_C]), 59);
    EXPECT_NE(messages().find("would leave its soft limits"), std::string::npos);
    jog(geom::AXIS_C, 180, -motion().carte_pos_cmd[geom::AXIS_C]);
    EXPECT_NEAR(motion().carte_pos_cmd[geom::AXIS_C], 0, 1e-6) << "and can be jogged back";
}

TEST_F(KinematicsTest, AGantryIsStillOfAxesWhateverItsKinstype_C14) {
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
