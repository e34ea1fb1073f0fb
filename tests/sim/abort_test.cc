// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the state after an abort with a whole machine in virtual time: [RS274NGC]ON_ABORT_COMMAND and the
// next work (I1, D1).
#include <cmath>

#include <fmt/format.h>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class AbortTest : public VirtualMachineTest {
  protected:
    /// A machine whose on-abort procedure has this body.
    void switch_on_with(const std::string &body) {
        write("on_abort.ngc", "o<on_abort> sub\n" + body + "o<on_abort> endsub\nM2\n");
        switch_on([&](task::Settings &task) {
            task.interpreter.on_abort_command = "O <on_abort> call";
            task.interpreter.subroutine_path.push_back(folder_.string());
        });
        messages();
    }
};

constexpr const char *BODY = "(debug,because %d#1)\nG90 G40 G80\nM65 P0\nM9\n";
constexpr const char *LONG = "G21 G91 F600\nM64 P0\nG1 X100\nM2\n";

TEST_F(AbortTest, TheOnAbortCommandRunsWhenTheMachineStands) {
    switch_on_with(BODY);
    start(LONG);
    cycles(1000);
    ASSERT_TRUE(pin("motion.digital-out-00"));
    ASSERT_GT(motion().current_velocity, 5);
    post(task::AbortAll{});
    for (int i = 0; i < 1000 && pin("motion.digital-out-00"); ++i) {
        cycles(1);
        ASSERT_TRUE(pin("motion.digital-out-00") || motion().isInPosition) << "cleaned up while moving";
    }
    EXPECT_FALSE(pin("motion.digital-out-00"));
    EXPECT_EQ(messages(), "because 8\n");
    EXPECT_EQ(machine_->task().status().task.interp_state, task::InterpState::IDLE);
    const double rest = x();
    EXPECT_EQ(mdi("X5 G0"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 5.0) << "G90 of the procedure is active";
    EXPECT_GT(rest, 5.0);
}

TEST_F(AbortTest, TheOnAbortCommandIsToldWhy) {
    switch_on_with("(debug,because %d#1)\n");
    start("G1 X1\nM2\n");  // no feed
    EXPECT_EQ(finish(), task::Progress::FAILED);
    cycles(3);
    EXPECT_NE(messages().find("because 9\n"), std::string::npos);
    EXPECT_EQ(mdi("G1 X1"), task::Progress::FAILED);
    cycles(3);
    EXPECT_NE(messages().find("because 10\n"), std::string::npos);
    EXPECT_EQ(mdi("G0 X9999"), task::Progress::FAILED);
    cycles(3);
    EXPECT_NE(messages().find("because 1\n"), std::string::npos);
    ask(task::SetState{task::State::OFF});
    cycles(10);
    EXPECT_EQ(messages(), "because 4\n");
    ask(task::SetState{task::State::ESTOP});
    cycles(10);
    EXPECT_EQ(messages(), "because 6\n");
    ask(task::SetState{task::State::ESTOP_RESET});
    cycles(10);
    EXPECT_EQ(messages(), "because 5\n");
    ask(task::SetState{task::State::ON});
    cycles(10);
    start(LONG);
    cycles(500);
    ASSERT_TRUE(machine_->hal().signals().unlink("joint.0.motor-pos-fb").has_value());
    cycles(1000);
    const std::string all = messages();
    EXPECT_NE(all.find("because 3\n"), std::string::npos) << all;
    EXPECT_EQ(all.find("because 7\n"), std::string::npos) << all;
}

/// Nothing starts or moves without a new command, also if a procedure commands it.
TEST_F(AbortTest, TheOnAbortCommandCannotMoveOrStartAnything) {
    for (const char *bad :
         {"G0 X50", "G53 G0 Z0", "M3 S1000", "M8", "T1 M6", "G38.3 X9 F10", "M0", "M66 P0 L3 Q9"}) {
        SCOPED_TRACE(bad);
        switch_on_with(std::string("M65 P0\n") + bad + "\nM65 P1\n");
        start("G21 G91 F600\nM64 P0\nM64 P1\nG1 X100\nM2\n");
        cycles(1000);
        ASSERT_TRUE(pin("motion.digital-out-01"));
        post(task::AbortAll{});
        cycles(500);
        const double rest = x();
        EXPECT_FALSE(pin("motion.digital-out-00")) << "what comes before is done";
        EXPECT_TRUE(pin("motion.digital-out-01")) << "what comes after is not";
        const std::string all = messages();
        EXPECT_NE(all.find("on_abort.ngc:3"), std::string::npos) << all;
        cycles(2000);
        EXPECT_EQ(x(), rest);
        EXPECT_EQ(machine_->hal().values().get("spindle.0.speed-out")->as_float(), 0.0);
        EXPECT_FALSE(pin("iocontrol.0.coolant-flood"));
        EXPECT_EQ(mdi("G90 G0 X1"), task::Progress::DONE) << messages();
        machine_.reset();
    }
}

TEST_F(AbortTest, AnOnAbortCommandThatFailsIsToldOnce) {
    switch_on_with("M65 P0\nG1 X[1/0]\n");
    start(LONG);
    cycles(1000);
    post(task::AbortAll{});
    cycles(500);
    EXPECT_FALSE(pin("motion.digital-out-00"));
    const std::string all = messages();
    EXPECT_NE(all.find("ON_ABORT_COMMAND"), std::string::npos) << all;
    EXPECT_NE(all.find("divide by zero"), std::string::npos) << all;
    EXPECT_NE(all.find("on_abort.ngc:3:"), std::string::npos) << all;
    EXPECT_EQ(all.find("divide by zero"), all.rfind("divide by zero")) << all;
    EXPECT_EQ(mdi("G90 G0 X1"), task::Progress::DONE) << messages();
}

TEST_F(AbortTest, AMissingOnAbortProcedureIsToldAndNothingElse) {
    switch_on([](task::Settings &task) { task.interpreter.on_abort_command = "O <nowhere> call"; });
    messages();
    ask(task::AbortAll{});
    cycles(10);
    EXPECT_NE(messages().find("no subroutine o<nowhere>"), std::string::npos);
}

TEST_F(AbortTest, AFaultOfTheToolChangerIsInTheParameters) {
    switch_on_with("(debug,because %d#1: %d#5600 %d#5601)\n");
    ASSERT_TRUE(machine_->hal().signals().unlink("iocontrol.0.tool-changed").has_value());
    set_pin("iocontrol.0.toolchanger-reason", "7");
    start("G21 G90\nT2 M6\nG0 X5\nM2\n");
    cycles(2000);
    set_pin("iocontrol.0.toolchanger-fault", "TRUE");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    cycles(10);
    EXPECT_NE(messages().find("because 1: 1 7\n"), std::string::npos);
    set_pin("iocontrol.0.toolchanger-fault", "FALSE");
    EXPECT_EQ(mdi("T1"), task::Progress::DONE);
    EXPECT_EQ(mdi("(debug,%d#5600 %d#5601)"), task::Progress::DONE);
    EXPECT_EQ(messages(), "0 0\n");
}

/// The axes still brake when the next line arrives; it begins at their stop position.
TEST_F(AbortTest, WorkRightAfterAnAbortBeginsWhereTheMachineComesToRest) {
    switch_on();
    start("G21 G90 F6000\nG1 X100\nM2\n");
    cycles(500);
    ASSERT_GT(motion().current_velocity, 50);
    post(task::AbortAll{});
    cycles(1);
    post(task::SetMode{task::Mode::MDI});
    run_ = post(task::Mdi{"G90 G1 F600 Y3"});
    samples_.clear();
    cycles(2);
    EXPECT_EQ(finish(), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(motion().carte_pos_cmd.y(), 3.0);
    double furthest = 0;
    for (const motion::TraceSample &sample : samples_) {
        EXPECT_GE(sample.carte_pos_cmd.x(), furthest - 1e-9) << "X comes back";
        furthest = std::max(furthest, sample.carte_pos_cmd.x());
        if (sample.carte_pos_cmd.y() > 0) {
            EXPECT_NEAR(sample.carte_pos_cmd.x(), x(), 1e-9) << "X moves on with Y";
        }
    }
}

/// An abort at any time: the machine stops, cleans up once, and executes the next line.
TEST_F(AbortTest, AnAbortInAnyCycleLeavesAMachineThatGoesOn) {
    switch_on_with("(debug,because %d#1)\nM65 P0\n");
    constexpr double FASTEST_MM_S = 200.0, PERIOD_S = 1e-3;
    for (int when = 1; when < 2600; when += 37) {
        SCOPED_TRACE(when);
        ASSERT_EQ(mdi("G90 G54 G49 G0 X0 Y0 Z0"), task::Progress::DONE) << messages();
        messages();
        start("G21 G90 G64 P0.1 F3000 S500 M3\nM64 P0\nG1 X5 Y1\nX9\nG3 X12 Y4 J3\nM62 P1\nG1 X14\nG4 "
              "P0.1\nT2 M6\n"
              "G43 H2 G1 X16\nM66 P0 L3 Q0.2\nG38.3 X18 F2000\nM63 P1\nG0 X25 Y9\nM65 P0\nG55 G1 X30 "
              "F3000\nM2\n");
        cycles(when);
        const bool isRunning = progress(run_) == task::Progress::STARTED;
        samples_.clear();
        post(task::AbortAll{});
        post(task::SetMode{task::Mode::MDI});
        run_ = post(task::Mdi{"G53 G0 Z1"});
        cycles(2);
        ASSERT_EQ(finish(), task::Progress::DONE) << messages();
        cycles(400);
        ASSERT_EQ(motion().carte_pos_cmd.z(), 1.0);
        ASSERT_FALSE(pin("motion.digital-out-00"));
        ASSERT_NEAR(machine_->hal().values().get("spindle.0.speed-out")->as_float(), 0.0, 1e-9);
        if (isRunning) {
            const std::string all = messages();
            ASSERT_EQ(all.find("because 8"), all.rfind("because")) << all;
        }
        double way = 0;  // the sign of X's last step
        int turns = 0;
        for (std::size_t i = 1; i < samples_.size(); ++i) {
            const double step = samples_[i].carte_pos_cmd.x() - samples_[i - 1].carte_pos_cmd.x();
            ASSERT_LE(std::fabs(step), FASTEST_MM_S * PERIOD_S * 1.001);
            turns += step * way < 0 ? 1 : 0;
            way = std::fabs(step) > 1e-9 ? step : way;
        }
        ASSERT_EQ(turns, 0) << "X came back";
    }
}

/// Displays, motion and the next line agree about the blocks that were read ahead and never became active.
TEST_F(AbortTest, AfterAnAbortTheCodesAreThoseOfTheExecutedBlock) {
    switch_on();
    EXPECT_EQ(mdi("G10 L2 P2 X10"), task::Progress::DONE);
    EXPECT_EQ(mdi("T1 M6"), task::Progress::DONE);
    start("G21 G90 F600 S700\nG54 G1 X100\nG55 G43.1 Z7 S1900\nG92 Y5\nM66 P0 L3 Q100\nM2\n");
    cycles(500);
    EXPECT_EQ(machine_->task().status().offsets.g5x_index, 1);
    ask(task::AbortAll{});
    cycles(500);
    const task::Status &status = machine_->task().status();
    EXPECT_EQ(status.offsets.g5x_index, 1);
    EXPECT_EQ(status.offsets.tool.z(), 0);
    EXPECT_EQ(status.offsets.g92.y(), 0);
    EXPECT_EQ(machine_->hal().values().get("motion.tooloffset.z")->as_float(), 0);
    EXPECT_EQ(mdi("(debug,%d#5220 %d#5212 %d#<_rpm>)"), task::Progress::DONE);
    EXPECT_EQ(messages(), "1 0 700\n");
    EXPECT_EQ(mdi("G0 X0 M3"), task::Progress::DONE);
    EXPECT_DOUBLE_EQ(x(), 0.0);
    cycles(100);
    EXPECT_EQ(machine_->hal().values().get("spindle.0.speed-out")->as_float(), 700.0)
        << "S as displays show it";
}

}  // namespace
}  // namespace mw::machine
