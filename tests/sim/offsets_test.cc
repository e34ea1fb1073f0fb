// SPDX-License-Identifier: GPL-2.0-or-later
// Motor motion besides programs and jogs, on a whole machine in virtual time: external offsets by their pins,
// tables of screw errors from the INI file.
#include <fmt/format.h>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class OffsetMachine : public VirtualMachineTest {
  protected:
    void SetUp() override {
        SimMachine sim;
        sim.axis_range = 100;
        sim.write(folder_);
        insert("[AXIS_X]\n", "OFFSET_AV_RATIO = 0.25\n");
        insert("[JOINT_1]\n", "COMP_FILE = y.comp\nCOMP_FILE_TYPE = 1\n");
        write("y.comp", "# Y\n-100 0.02 -0.02\n100 0.04 0.01\n");
        switch_on_config((folder_ / "sim.ini").string());
        ASSERT_NE(machine_, nullptr);
        set_pin("axis.x.eoffset-enable", "1");
        set_pin("axis.x.eoffset-scale", "0.01");
        cycles(3);
    }
    void insert(const std::string &after, const std::string &lines) {
        std::string text = read("sim.ini");
        const auto at = text.find(after);
        ASSERT_NE(at, std::string::npos) << after;
        write("sim.ini", text.insert(at + after.size(), lines));
    }
    double number(const std::string &name) const { return machine_->hal().values().get(name)->as_number(); }
};

TEST_F(OffsetMachine, ProgramsKnowNothingOfAnExternalOffset) {
    ASSERT_EQ(mdi("G21 G90 G0 X10"), task::Progress::DONE) << messages();
    set_pin("axis.x.eoffset-counts", "200");
    cycles(1000);
    EXPECT_DOUBLE_EQ(number("axis.x.eoffset"), 2);
    EXPECT_TRUE(pin("motion.eoffset-active"));
    ASSERT_EQ(mdi("G91 G0 X1"), task::Progress::DONE) << messages();
    EXPECT_NEAR(number("axis.x.pos-cmd"), 11, 1e-9);
    EXPECT_NEAR(number("joint.0.motor-pos-cmd"), 13, 1e-9);
    ask(task::SetMode{task::Mode::MANUAL});
    ask(task::AbortAll{});
    cycles(50);
    ASSERT_EQ(mdi("G91 G0 X1"), task::Progress::DONE) << messages();
    EXPECT_NEAR(number("axis.x.pos-cmd"), 12, 1e-9) << "it continues from the position of the program";
    EXPECT_NEAR(number("joint.0.motor-pos-cmd"), 14, 1e-9);
    EXPECT_EQ(mdi("G90 G0 X99"), task::Progress::FAILED) << "with the offset it is outside the soft limit";
    EXPECT_LT(number("joint.0.motor-pos-cmd"), 100);
}

TEST_F(OffsetMachine, ATableOfScrewErrorsOfTheIniFileMovesTheMotor) {
    ASSERT_EQ(mdi("G21 G90 G0 Y50"), task::Progress::DONE) << messages();
    EXPECT_NEAR(number("joint.1.motor-pos-cmd"), 50.035, 1e-9);
    EXPECT_NEAR(number("joint.1.pos-fb"), 50, 1e-9);
    ASSERT_EQ(mdi("G0 Y0"), task::Progress::DONE) << messages();
    cycles(100);
    EXPECT_NEAR(number("joint.1.motor-pos-cmd"), -0.005, 1e-9);
    EXPECT_NEAR(number("joint.1.backlash-filt"), -0.005, 1e-9);
    EXPECT_EQ(number("joint.0.backlash-filt"), 0);
}

TEST_F(OffsetMachine, SettingsOfTheIniFileMayBeTurnedByPins) {
    EXPECT_EQ(number("ini.x.max-limit"), 100);
    EXPECT_EQ(number("ini.x.max_limit"), 100) << "as files and scripts of LinuxCNC have it";
    EXPECT_EQ(number("ini.traj_max_velocity"), number("ini.traj-max-velocity"));
    EXPECT_EQ(number("ini.0.max-velocity"), 200);
    messages();
    set_pin("ini.x.max-limit", "20");
    cycles(5);
    EXPECT_EQ(motion().axis[0].max_limit, 20);
    EXPECT_EQ(mdi("G21 G90 G0 X30"), task::Progress::FAILED);
    set_pin("ini.x.max-limit", "-200");
    cycles(5);
    EXPECT_NE(messages().find("ini.x.max-limit is -200: the other limit is -100"), std::string::npos);
    EXPECT_EQ(motion().axis[0].max_limit, 20) << "the old value stays";
    set_pin("ini.0.max-velocity", "0");
    cycles(5);
    EXPECT_NE(messages().find("ini.0.max-velocity is 0: the value is out of range"), std::string::npos);
    set_pin("ini.traj-arc-blend-enable", "0");
    cycles(5);
    EXPECT_NE(messages().find("this setting has no effect"), std::string::npos);
}

TEST_F(OffsetMachine, ASpeedTurnedByAPinWaitsUntilNothingMovesInManualMode) {
    start("G21 G90 G1 F6000 X50\nX0\nM2\n");
    cycles(100);
    set_pin("ini.0.max-velocity", "5");
    cycles(100);
    EXPECT_EQ(motion().joint[0].max_velocity, 200);
    EXPECT_NE(messages().find("ini.0.max-velocity waits"), std::string::npos);
    ASSERT_EQ(finish(), task::Progress::DONE);
    ask(task::SetMode{task::Mode::MANUAL});
    cycles(50);
    EXPECT_EQ(motion().joint[0].max_velocity, 5);
}

/// A plasma table with two belts: height control by the offset of Z, and offsets of the table itself in X and
/// Y.
class BeltMachine : public OffsetMachine {
  protected:
    void SetUp() override {
        SimMachine sim;
        sim.kinematics = "corexykins";
        sim.axis_range = 100;
        sim.joints[0].low = sim.joints[1].low = -150;
        sim.joints[0].high = sim.joints[1].high = 150;
        sim.write(folder_);
        for (const char letter : {'X', 'Y', 'Z'}) {
            insert(fmt::format("[AXIS_{}]\n", letter), "OFFSET_AV_RATIO = 0.3\n");
        }
        switch_on_config((folder_ / "sim.ini").string());
        ASSERT_NE(machine_, nullptr);
        for (const char letter : {'x', 'y', 'z'}) {
            set_pin(fmt::format("axis.{}.eoffset-enable", letter), "1");
            set_pin(fmt::format("axis.{}.eoffset-scale", letter), "0.01");
        }
        cycles(3);
    }
};

TEST_F(BeltMachine, ACoreXYTableCutsAndFollowsTheHeightThatItsPinAsksFor) {
    EXPECT_EQ(messages().find("OFFSET_AV_RATIO"), std::string::npos);
    start("G21 G90 G1 F3000 X40 Y10\nX-20\nM2\n");
    for (int n = 0; n < 40; ++n) {
        set_pin("axis.z.eoffset-counts", std::to_string(20 * (n % 7)));
        cycles(50);
    }
    ASSERT_EQ(finish(), task::Progress::DONE) << messages();
    cycles(1000);
    EXPECT_NEAR(number("axis.z.eoffset"), 0.8, 1e-9);
    EXPECT_NEAR(number("axis.z.pos-cmd"), 0, 1e-9);
    EXPECT_NEAR(number("joint.2.motor-pos-cmd"), 0.8, 1e-9);
    EXPECT_NEAR(number("joint.0.motor-pos-cmd"), -10, 1e-9);
    EXPECT_NEAR(number("joint.1.motor-pos-cmd"), -30, 1e-9);
    EXPECT_TRUE(pin("motion.eoffset-active"));
}

TEST_F(BeltMachine, BeltsEndWhereProgramAndOffsetTakeThemTogether) {
    ASSERT_EQ(mdi("G21 G90 G0 X90 Y40"), task::Progress::DONE) << messages();
    set_pin("axis.y.eoffset-counts", "3000");
    cycles(2000);
    EXPECT_NEAR(number("axis.y.eoffset"), 20, 1e-6) << "joint 0 is X + Y, and ends at 150";
    EXPECT_TRUE(pin("motion.eoffset-limited"));
    EXPECT_EQ(mdi("X91"), task::Progress::FAILED);
    EXPECT_NE(messages().find("exceeds the soft limit of a joint"), std::string::npos);
    ASSERT_EQ(mdi("G0 X50"), task::Progress::DONE) << messages();
    cycles(2000);
    EXPECT_NEAR(number("axis.y.eoffset"), 30, 1e-9);
    EXPECT_NEAR(number("joint.0.motor-pos-cmd"), 120, 1e-9);
    EXPECT_FALSE(pin("motion.eoffset-limited"));
}

}  // namespace
}  // namespace mw::machine
