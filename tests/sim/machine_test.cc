// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time, from INI and HAL files: stops, pauses, inputs, errors.
#include <cmath>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

constexpr double PERIOD_S = 1e-3;

class MachineTest : public VirtualMachineTest {
  protected:
    void SetUp() override { switch_on(); }
    /// Maximum acceleration of X and Y over the samples. [mm/s2]
    double peak_acceleration() const {
        double peak = 0;
        for (std::size_t i = 2; i < samples_.size(); ++i) {
            for (int axis = 0; axis < 2; ++axis) {
                const double d2 = samples_[i].carte_pos_cmd[axis] - 2 * samples_[i - 1].carte_pos_cmd[axis] +
                                  samples_[i - 2].carte_pos_cmd[axis];
                peak = std::fmax(peak, std::fabs(d2) / (PERIOD_S * PERIOD_S));
            }
        }
        return peak;
    }
};

constexpr const char *LONG_MOVES = "G21 G90 G17 G61 F6000\nG1 X100\nY100\nX0\nY0\nM2\n";

TEST_F(MachineTest, ProgramsReadHalItemsInTheCaseOfTheirNames) {
    hal::Instance &hal = machine_->hal();
    ASSERT_TRUE(hal.signals().create("Depth", hal::Type::FLOAT).has_value());
    ASSERT_TRUE(hal.signals().set("Depth", "3").has_value());
    EXPECT_EQ(mdi("G21 G0 X#<_hal[Depth]>"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 3);
    EXPECT_EQ(mdi("G0 X[1 + #<_hal[MOTION.ENABLE]>]"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 2);
    EXPECT_EQ(mdi("G0 X#<_hal[depth]>"), task::Progress::FAILED);
}

TEST_F(MachineTest, AFailureOfAHalFileIsToldOnceWithItsLineAndStillSaysWhatItIs) {
    machine_.reset();
    write("bad.hal", "net a no.such-pin\n");
    sink_.clear();
    loaded_ = LoadedConfig::load(changed_config("mill_mm.ini", {{"LIB:core_sim.hal", "bad.hal"}}), sink_);
    ASSERT_NE(loaded_, nullptr);
    const auto made =
        make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, MachineOptions{});
    ASSERT_FALSE(made.has_value());
    EXPECT_TRUE(made.error().isTold);
    EXPECT_NE(made.error().message, "");
    const int told = sink_.count_errors();
    EXPECT_EQ(told, 1);
    EXPECT_NE(sink_.all().back().str().find("bad.hal:1"), std::string::npos) << sink_.all().back().str();
    sink_.failure(made.error());
    EXPECT_EQ(sink_.count_errors(), told);
}

TEST_F(MachineTest, AnOpenChainDropsTheAmplifiersInTheSameServoCycle) {
    start(LONG_MOVES);
    cycles(500);
    ASSERT_GT(motion().current_velocity, 50);
    ASSERT_TRUE(pin("joint.0.amp-enable-out"));
    hal::Instance &hal = machine_->hal();
    ASSERT_TRUE(hal.signals().unlink("iocontrol.0.user-enable-out").has_value());
    ASSERT_TRUE(hal.signals().set("estop-loop", "FALSE").has_value());
    samples_.clear();
    cycles(1);
    ASSERT_EQ(samples_.size(), 1U);
    EXPECT_EQ(samples_[0].isEnabled, 0);
    for (int joint = 0; joint < 3; ++joint) {
        EXPECT_FALSE(pin("joint." + std::to_string(joint) + ".amp-enable-out"));
    }
    cycles(3);
    EXPECT_EQ(machine_->task().status().task.state, task::State::ESTOP);
    EXPECT_EQ(progress(run_), task::Progress::FAILED);
}

TEST_F(MachineTest, AnAbortBrakesAlongThePathWithinTheLimits) {
    start(LONG_MOVES);
    cycles(500);
    ask(task::AbortAll{});
    cycles(300);
    EXPECT_TRUE(motion().isInPosition);
    EXPECT_TRUE(motion().isEnabled);
    EXPECT_LE(peak_acceleration(), 1500 * (1 + 1e-6) + 1e-6);
    const double y = samples_.back().carte_pos_cmd.y();
    EXPECT_NEAR(y, 0.0, 1e-9) << "still on the first side";
    const geometry::Pose rest = samples_.back().carte_pos_cmd;
    cycles(500);
    EXPECT_EQ(samples_.back().carte_pos_cmd, rest) << "nothing of the old epoch moves";
}

TEST_F(MachineTest, PauseHoldsAndResumeGoesOnToTheExactEnd) {
    start(LONG_MOVES);
    cycles(700);
    ask(task::PauseProgram{});
    cycles(300);
    const geometry::Pose held = samples_.back().carte_pos_cmd;
    cycles(200);
    EXPECT_EQ(samples_.back().carte_pos_cmd, held);
    ask(task::ResumeProgram{});
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_LE(peak_acceleration(), 1500 * (1 + 1e-6) + 1e-6);
    EXPECT_EQ(samples_.back().carte_pos_cmd.x(), 0.0);
    EXPECT_EQ(samples_.back().carte_pos_cmd.y(), 0.0);
}

TEST_F(MachineTest, AProgramStopHoldsWhatIsBehindIt) {
    start("G21 G90 G61 F6000\nG1 X2\nM0\nM8\nG1 X4\nM1\nG1 X6\nM60\nM2\n");
    for (const double stands : {2.0, 4.0, 6.0}) {
        for (int i = 0; i < 5000 && !machine_->task().status().task.isPaused; ++i) {
            cycles(1);
        }
        ASSERT_TRUE(machine_->task().status().task.isStoppedByProgram);
        cycles(2000);
        EXPECT_DOUBLE_EQ(x(), stands);
        EXPECT_EQ(pin("iocontrol.0.coolant-flood"), stands > 3);
        EXPECT_EQ(progress(run_), task::Progress::STARTED);
        ask(task::ResumeProgram{});
    }
    EXPECT_EQ(finish(), task::Progress::DONE);
}

TEST_F(MachineTest, AProgramErrorStopsTheSpindleToo) {
    start("G21 G90 S5000 M3\nG1 X50 F1000\nG1 X100 X5\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    EXPECT_NE(messages().find("p.ngc:3:"), std::string::npos);
    cycles(3000);
    EXPECT_EQ(machine_->hal().values().get("spindle.0.speed-out")->as_float(), 0.0);
    EXPECT_TRUE(motion().isEnabled);
}

TEST_F(MachineTest, FollowingErrorIsAFaultThatSwitchesOff) {
    start(LONG_MOVES);
    cycles(300);
    ASSERT_TRUE(machine_->hal().signals().unlink("joint.0.motor-pos-fb").has_value());
    cycles(1000);
    EXPECT_FALSE(motion().isEnabled);
    EXPECT_NE(messages().find("joint 0 following error"), std::string::npos);
}

TEST_F(MachineTest, AToolChangeWaitsForItsPin) {
    ASSERT_TRUE(machine_->hal().signals().unlink("iocontrol.0.tool-changed").has_value());
    start("G21 G90\nT2 M6\nG0 X5\nM2\n");
    cycles(4000);
    EXPECT_EQ(progress(run_), task::Progress::STARTED);
    EXPECT_EQ(machine_->task().status().task.waiting.what, task::WaitFor::TOOL_CHANGED);
    ASSERT_TRUE(machine_->hal().values().set("iocontrol.0.tool-changed", "TRUE").has_value());
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_EQ(machine_->task().status().tool.in_spindle, 2);
}

/// A tool arm must not move before the spindle has its angle.
TEST_F(MachineTest, OrientingASpindleIsAwaitedUpToItsTime) {
    ASSERT_TRUE(machine_->hal().signals().unlink("spindle.0.is-oriented").has_value());  // a person confirms
    const std::string program = "G21 G90\nM19 R90 Q2\nG0 X5\nM19 R180 Q2\nG0 X9\nM2\n";
    start(program);
    for (const double angle : {90.0, 180.0}) {
        cycles(600);
        EXPECT_TRUE(pin("spindle.0.orient"));
        EXPECT_EQ(machine_->hal().values().get("spindle.0.orient-angle")->as_float(), angle);
        EXPECT_EQ(machine_->task().status().task.waiting.what, task::WaitFor::SPINDLE_ORIENTED);
        EXPECT_EQ(x(), angle == 90.0 ? 0.0 : 5.0) << "moved before the spindle was there";
        set_pin("spindle.0.is-oriented", "TRUE");
        cycles(5);
        set_pin("spindle.0.is-oriented", "FALSE");
    }
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 9.0);
    start(program);
    cycles(1900);
    EXPECT_EQ(progress(run_), task::Progress::STARTED);
    cycles(300);
    EXPECT_EQ(progress(run_), task::Progress::FAILED);
    EXPECT_NE(messages().find("spindle 0 is not oriented within 2 seconds"), std::string::npos);
    EXPECT_DOUBLE_EQ(x(), 9.0);
    start("G21 G90\nM19 R90\nG0 X3\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE) << "without Q nothing is awaited";
}

TEST_F(MachineTest, BackBoringMovesAsideOnlyWithAnOrientedSpindle) {
    ASSERT_TRUE(machine_->hal().signals().unlink("spindle.0.is-oriented").has_value());  // a person confirms
    start("G21 G90 G0 X0 Y0 Z5\nS1000 M3\nF3000 G87 X0 Y0 Z-3 R1 I2 J0 K-1\nG80\nM2\n");
    cycles(5000);
    EXPECT_EQ(machine_->task().status().task.waiting.what, task::WaitFor::SPINDLE_ORIENTED);
    EXPECT_GT(motion().carte_pos_cmd.z(), 0.5);
    set_pin("spindle.0.is-oriented", "TRUE");
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
}

TEST_F(MachineTest, WaitsBeyondTheRangeOfTheClockDoNotEnd) {
    constexpr int CYCLES = 20000;
    for (const char *wait : {"G4 P1000000000000000000", "G4 P9223372037", "M66 P0 L3 Q100000000000"}) {
        start(std::string("G21 G90\n") + wait + "\nG0 X5\nM2\n");
        EXPECT_EQ(finish(CYCLES), task::Progress::STARTED) << wait;
        EXPECT_NEAR(x(), 0, 1e-9) << wait;
        ask(task::AbortAll{});
        cycles(100);
    }
}

TEST_F(MachineTest, SynchronisedOutputsWithoutAMoveAreNeverTooMany) {
    std::string text = "G21 G90\nG0 X1\n";
    for (int n = 0; n < 5000; ++n) {
        text += "M62 P0\nM63 P1\n";
    }
    start(text + "G0 X2\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_NEAR(x(), 2, 1e-6);
    EXPECT_EQ(motion().digital_out & 3U, 1U);
}

TEST_F(MachineTest, MoveAndOutputStayInProgramOrder) {
    start("G21 G90 F3000\nG1 X10\nM64 P0\nG1 X20\nM65 P0\nM2\n");
    double on_at = -1, off_at = -1;
    for (int i = 0; i < 3000; ++i) {
        cycles(1);
        const bool isOn = pin("motion.digital-out-00");
        on_at = isOn && on_at < 0 ? motion().carte_pos_cmd.x() : on_at;
        off_at = !isOn && on_at >= 0 && off_at < 0 ? motion().carte_pos_cmd.x() : off_at;
    }
    EXPECT_NEAR(on_at, 10.0, 1e-9);
    EXPECT_NEAR(off_at, 20.0, 1e-9);
}

}  // namespace
}  // namespace mw::machine
