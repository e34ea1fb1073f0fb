// SPDX-License-Identifier: GPL-2.0-or-later
// A complete machine in virtual time: modes of task and motion agree, requests end, jogs and homing follow
// the override, and requests of a program are done when they are reported as done.
#include <cmath>

#include <fmt/format.h>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class ModesTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }
    void jog_x(double velocity) {
        ask(task::SetTeleop{false});  // a homed machine is in teleop mode
        cycles(10);
        ask(task::JogContinuous{true, 0, velocity});
        cycles(300);
    }
    double joint_speed(int joint) const {
        return std::abs(motion().joint[static_cast<std::size_t>(joint)].vel_cmd);
    }
};

TEST_F(ModesTest, AModeThatMotionRefusesIsRefused) {
    ask(task::SetMode{task::Mode::MANUAL});
    cycles(5);
    jog_x(20);
    ASSERT_GT(joint_speed(0), 10);
    const auto id = ask(task::SetMode{task::Mode::AUTO});
    cycles(10);
    EXPECT_EQ(progress(id), task::Progress::REFUSED);
    EXPECT_NE(reason(id), "");
    EXPECT_EQ(machine_->task().status().task.mode, task::Mode::MANUAL);
    write("p.ngc", "G21 G0 X1\nM2\n");
    ask(task::OpenProgram{(folder_ / "p.ngc").string()});
    const auto run = ask(task::RunProgram{});
    cycles(20);
    EXPECT_EQ(progress(run), task::Progress::REFUSED);
    ask(task::AbortAll{});
    cycles(500);
    const auto again = ask(task::SetMode{task::Mode::AUTO});
    cycles(10);
    EXPECT_EQ(progress(again), task::Progress::DONE) << reason(again);
    run_ = ask(task::RunProgram{});
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
}

TEST_F(ModesTest, CommandsBehindAModeChangeWaitForIt) {
    const auto mode = post(task::SetMode{task::Mode::MDI});
    run_ = post(task::Mdi{"G21 G0 X3"});
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_EQ(progress(mode), task::Progress::DONE);
    EXPECT_DOUBLE_EQ(x(), 3);
}

TEST_F(ModesTest, AnAbortEndsARunAtAnyTime) {
    for (int wait = 0; wait < 60; wait += 3) {
        ask(task::SetMode{task::Mode::AUTO});
        start("G21 G90 G1 X20 F6000\nX0\nM2\n");
        cycles(wait);
        post(task::AbortAll{});
        cycles(400);
        EXPECT_NE(progress(run_), task::Progress::STARTED) << wait;
    }
}

TEST_F(ModesTest, ARunIsNotForgottenHoweverManyRequestsFollow) {
    start("G21 G90 G1 X100 F600\nM2\n");
    cycles(20);
    for (int i = 0; i < 1000; ++i) {
        post(task::SetFeedOverride{1.0});
        if (i % 10 == 0) {
            cycles(1);
        }
    }
    EXPECT_EQ(progress(run_), task::Progress::STARTED);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_NEAR(x(), 100, 1e-9);
}

TEST_F(ModesTest, TheFeedOverrideActsOnJogs) {
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetFeedOverride{0.5});
    jog_x(20);
    EXPECT_NEAR(joint_speed(0), 10, 1e-6);
    ask(task::SetFeedOverride{0});
    cycles(300);
    EXPECT_NEAR(joint_speed(0), 0, 1e-9);
    ask(task::SetFeedOverride{1});
    cycles(300);
    EXPECT_NEAR(joint_speed(0), 20, 1e-6);
    ask(task::AbortAll{});
    cycles(300);
    ask(task::SetTeleop{true});
    cycles(10);
    ask(task::SetFeedOverride{0.25});
    ask(task::JogContinuous{false, 0, -20});
    cycles(300);
    EXPECT_NEAR(joint_speed(0), 5, 1e-6);
}

TEST_F(ModesTest, AJogThatItsClientDoesNotRenewIsStoppedByMotion) {
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::SetTeleop{false});
    cycles(10);
    for (int n = 0; n < 20; ++n) {
        post(task::JogContinuous{true, 0, 20, 100, n > 0});
        cycles(30);
        EXPECT_TRUE(n < 4 || std::abs(joint_speed(0) - 20) < 1e-6) << joint_speed(0);
    }
    messages();
    cycles(60);
    EXPECT_NEAR(joint_speed(0), 20, 1e-6) << "the lease has not ended";
    cycles(300);
    EXPECT_EQ(joint_speed(0), 0);
    EXPECT_EQ(messages(), "the jog of joint 0 was stopped: it was not renewed within 100 ms\n");
    const auto late = ask(task::JogContinuous{true, 0, 20, 100, true});
    EXPECT_EQ(progress(late), task::Progress::REFUSED);
    EXPECT_EQ(joint_speed(0), 0);
    EXPECT_EQ(messages(), "");
    const auto fresh = ask(task::JogContinuous{true, 0, 20, 100});
    EXPECT_EQ(progress(fresh), task::Progress::DONE) << reason(fresh);
    EXPECT_GT(joint_speed(0), 0);
}

TEST_F(ModesTest, HomingDuringAJogStopsTheJogAndHomes) {
    switch_on_config(SimMachine{}.write(folder_));  // joints that home at their position
    ask(task::SetMode{task::Mode::MANUAL});
    jog_x(50);
    ASSERT_GT(joint_speed(0), 20);
    const auto id = ask(task::HomeJoint{0});
    EXPECT_TRUE(motion().isHoming);
    EXPECT_EQ(progress(id), task::Progress::STARTED);
    const auto jog = ask(task::JogContinuous{true, 0, 50});
    cycles(500);
    EXPECT_EQ(progress(id), task::Progress::DONE) << messages();
    EXPECT_NE(progress(jog), task::Progress::STARTED);
    EXPECT_TRUE(motion().joint[0].isHomed);
    EXPECT_NEAR(motion().joint[0].pos_cmd, 0, 1e-9) << "was stopped while it homed";
    EXPECT_EQ(joint_speed(0), 0);
}

TEST_F(ModesTest, ToolOffsetsAreOnThePinsWhenG43IsDone) {
    for (const double z : {12.5, -3.25, 40.0}) {
        ASSERT_EQ(mdi(fmt::format("G21 G43.1 Z{}", z)), task::Progress::DONE) << messages();
        EXPECT_DOUBLE_EQ(machine_->hal().values().get("motion.tooloffset.z")->as_number(), z);
    }
}

TEST_F(ModesTest, TheSimulatedSpindleOrients) {
    ASSERT_EQ(mdi("S500 M3"), task::Progress::DONE);
    cycles(500);
    for (const double angle : {90.0, 10.0, 270.0}) {
        ASSERT_EQ(mdi(fmt::format("S500 M19 R{} Q2", angle)), task::Progress::DONE) << messages();
        cycles(100);
        const double turns = machine_->hal().values().get("spindle.0.revs")->as_number();
        EXPECT_NEAR(std::remainder(turns * 360 - angle, 360.0), 0, 1.0);
    }
}

TEST_F(ModesTest, RigidTappingGoesToItsDepthAndBack) {
    start("G21 G90 M3 S500\nG0 Z5\nG33.1 Z-5 K1\nG33.1 Z-5 K1 I2\nG0 X3\nM2\n");
    samples_.clear();
    ASSERT_EQ(finish(), task::Progress::DONE) << messages();
    std::vector<double> bottoms;
    bool isDown = false;
    for (const motion::TraceSample &s : samples_) {
        const double z = s.carte_pos_cmd[geometry::AXIS_Z];
        if (!isDown && z < 0) {
            bottoms.push_back(0);
        }
        isDown = z < 0;
        if (isDown) {
            bottoms.back() = std::min(bottoms.back(), z);
        }
    }
    ASSERT_EQ(bottoms.size(), 2U);
    EXPECT_NEAR(bottoms[0], -5, 1) << "within a turn";
    EXPECT_NEAR(bottoms[1], -5, 0.2) << "learned from the first";
    EXPECT_NEAR(motion().carte_pos_cmd.z(), 5, 1e-9);
    EXPECT_NEAR(motion().carte_pos_cmd.x(), 3, 1e-9);
}

TEST_F(ModesTest, ATapThatCannotBeIsRefusedWithItsPlace) {
    start("G21 G90 M3 S500\nG0 Z5\nG33.1 Z-5 K-1\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    EXPECT_NE(messages().find("p.ngc:3"), std::string::npos) << messages();
    start("G21 G90 M3 S500\nG0 Z5\nG33.1 Z4.9 K1\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    const std::string all = messages();
    EXPECT_NE(all.find("p.ngc:3"), std::string::npos) << all;
    EXPECT_NE(all.find("too shallow"), std::string::npos) << all;
    EXPECT_NEAR(motion().carte_pos_cmd.z(), 5, 1e-9) << "nothing has moved";
}

class AxesTest : public VirtualMachineTest {};

TEST_F(AxesTest, ArcsOfUVWRun) {
    SimMachine foam;
    foam.coordinates = "XYZUVW";
    foam.kinematics = "trivkins coordinates=XYZUVW";
    foam.joints.resize(6);
    switch_on_config(foam.write(folder_));
    struct Case {
        const char *code;
        int first, second;
        const char *words;
    };
    for (const Case &c : {Case{"G17.1", geometry::AXIS_U, geometry::AXIS_V, "U10 V0 I5 J0"},
                          Case{"G18.1", geometry::AXIS_W, geometry::AXIS_U, "W10 U0 K5 I0"},
                          Case{"G19.1", geometry::AXIS_V, geometry::AXIS_W, "V10 W0 J5 K0"}}) {
        SCOPED_TRACE(c.code);
        ASSERT_EQ(mdi("G21 G90 G61 G0 U0 V0 W0"), task::Progress::DONE) << messages();
        samples_.clear();
        ASSERT_EQ(mdi(fmt::format("{} G2 {} F600", c.code, c.words)), task::Progress::DONE) << messages();
        double highest = 0;
        for (const motion::TraceSample &s : samples_) {
            if (s.isInMotion == 0) {
                continue;
            }
            EXPECT_NEAR(std::hypot(s.carte_pos_cmd[c.first] - 5, s.carte_pos_cmd[c.second]), 5, 1e-5);
            highest = std::max(highest, s.carte_pos_cmd[c.second]);
        }
        EXPECT_NEAR(highest, 5, 0.01) << "clockwise, by the side of the second axis";
        EXPECT_NEAR(motion().carte_pos_cmd[c.first], 10, 1e-9);
    }
}

TEST_F(AxesTest, AngularLimitsOfTrajHold) {
    SimMachine mill;
    mill.coordinates = "XYZA";
    mill.kinematics = "trivkins coordinates=XYZA";
    mill.joints.resize(4);
    mill.joints[3] = {true, 180, 720, -3600, 3600, 0};
    mill.traj = "MAX_ANGULAR_VELOCITY = 5\nMAX_ANGULAR_ACCELERATION = 20\n";
    switch_on_config(mill.write(folder_));
    samples_.clear();
    ASSERT_EQ(mdi("G21 G90 G0 A20"), task::Progress::DONE) << messages();
    double v = 0;
    double a = 0;
    for (std::size_t i = 2; i < samples_.size(); ++i) {
        const auto at = [&](std::size_t k) { return samples_[k].carte_pos_cmd[geometry::AXIS_A]; };
        v = std::max(v, std::abs(at(i) - at(i - 1)) * 1e3);
        a = std::max(a, std::abs(at(i) - 2 * at(i - 1) + at(i - 2)) * 1e6);
    }
    EXPECT_NEAR(v, 5, 1e-3);
    EXPECT_NEAR(a, 20, 1e-2);
}

}  // namespace
}  // namespace mw::machine
