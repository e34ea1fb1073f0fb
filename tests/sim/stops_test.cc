// SPDX-License-Identifier: GPL-2.0-or-later
// Stops of programs that were read ahead, on a whole machine in virtual time: nothing of a block that was not
// executed remains (D1, D2).
#include <fmt/format.h>

#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

constexpr const char *AHEAD =
    "G21 G90 G54\nG1 X20 F300\nG10 L2 P1 X5\nG92 Y1\nG43.1 Z2\nG91\nG20\nM64 P0\nM8\n"
    "S700\n#31=7\nG1 X1 F10\nM2\n";

/// Modes, offsets and outputs as screens show them.
std::string shown(const messages::MachineStatus &status) {
    std::string text;
    for (std::size_t i = 1; i < status.codes.g.size(); ++i) {
        text += fmt::format("{} ", status.codes.g[i]);
    }
    for (std::size_t i = 1; i < status.codes.m.size(); ++i) {
        text += fmt::format("{} ", status.codes.m[i]);
    }
    for (std::size_t i = 1; i < status.codes.settings.size(); ++i) {
        text += fmt::format("{} ", status.codes.settings[i]);
    }
    const auto pose = [&](const geometry::Pose &p) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            text += fmt::format("{} ", p[axis]);
        }
    };
    text += fmt::format("G5x {} ", status.offsets.g5x_index);
    pose(status.offsets.g5x);
    pose(status.offsets.g92);
    pose(status.offsets.tool);
    return text;
}

class StopsTest : public VirtualMachineTest {
  protected:
    void run_until_moving(const std::string &text) {
        mdi("F1000");
        start(text);
        for (int i = 0; i < 5000 && x() < 4; ++i) {
            cycles(1);
        }
        ASSERT_GT(x(), 3.9);
    }
    std::string shown_now() const { return shown(machine_->task().status()); }
    void settle() {
        for (int i = 0; i < 3000 && !motion().isInPosition; ++i) {
            cycles(1);
        }
        cycles(10);
    }
};

TEST_F(StopsTest, AfterAnAbortModesOffsetsAndParametersAreThoseOfTheExecutedBlock) {
    switch_on();
    run_until_moving(AHEAD);
    const std::string running = shown_now();
    post(task::AbortAll{});
    settle();
    EXPECT_EQ(shown_now(), running);
    EXPECT_FALSE(pin("motion.digital-out-00"));
    EXPECT_EQ(mdi("G0 X[1+#31] Y0"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 1.0);
    EXPECT_EQ(mdi("G1 X2"), task::Progress::DONE) << "F is kept: " << messages();
    EXPECT_DOUBLE_EQ(x(), 2.0);
}

TEST_F(StopsTest, AProgramThatWasStoppedHasNoLineNorHasAnotherMode) {
    switch_on();
    run_until_moving(AHEAD);
    EXPECT_EQ(machine_->task().status().task.motion_line, 2);
    post(task::AbortAll{});
    cycles(5);
    EXPECT_FALSE(motion().isInPosition) << "it brakes";
    EXPECT_EQ(machine_->task().status().task.motion_line, 0);
    settle();
    start("G21 G90 F3000\nG1 X1\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_EQ(machine_->task().status().task.motion_line, 2);
    ask(task::SetMode{task::Mode::MANUAL});
    EXPECT_EQ(machine_->task().status().task.motion_line, 0);
}

TEST_F(StopsTest, SoTheyAreAfterEveryOtherKindOfStop) {
    const std::vector<messages::Command> stops{task::SetState{task::State::OFF},
                                               task::SetState{task::State::ESTOP},
                                               task::SetMode{task::Mode::MANUAL}};
    for (const messages::Command &stop : stops) {
        switch_on();
        run_until_moving(AHEAD);
        const std::string running = shown_now();
        ask(stop);
        if (machine_->task().status().task.interp_state != task::InterpState::IDLE) {
            continue;  // a command that is rejected while a program runs
        }
        settle();
        EXPECT_EQ(shown_now(), running);
    }
}

TEST_F(StopsTest, WhilePausedTheyAreThoseOfTheExecutedBlock) {
    switch_on();
    run_until_moving(AHEAD);
    const std::string running = shown_now();
    ask(task::PauseProgram{});
    settle();
    EXPECT_EQ(shown_now(), running);
    ask(task::AbortAll{});
    settle();
    EXPECT_EQ(shown_now(), running);
}

TEST_F(StopsTest, ABadLineThatWasReadAheadLeavesNothingOfTheBlocksBeforeItThatWereNotExecuted) {
    switch_on();
    mdi("G54 F1000");
    start("G21 G90 G54\nG1 X20 F300\nG91 G20 F3\nG10 L2 P1 X5\nG1 Q\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    settle();
    const messages::MachineStatus &status = machine_->task().status();
    EXPECT_EQ(status.offsets.g5x.x(), 0);
    EXPECT_EQ(mdi("G0 X1"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 1.0);
}

TEST_F(StopsTest, BlocksThatWereExecutedCountEvenIfTheyMoveNothing) {
    switch_on();
    start("G21 G90 G54\n#31=4\nG10 L2 P1 X1\nG4 P0.2\n#31=5\nG91\nG1 X20 F300\n#31=6\nG90\nM2\n");
    for (int i = 0; i < 5000 && x() < 4; ++i) {
        cycles(1);
    }
    post(task::AbortAll{});
    settle();
    const double at = x();
    EXPECT_EQ(machine_->task().status().offsets.g5x.x(), 1);
    EXPECT_EQ(mdi("G1 X[#31]"), task::Progress::DONE) << messages();
    EXPECT_NEAR(x(), at + 5, 1e-9) << "G91 and #31 = 5";
}

TEST_F(StopsTest, CutterCompensationEndsWithTheStop) {
    switch_on();
    run_until_moving("G21 G90 G17\nG41.1 D2\nG1 X2 F600\nG1 X20\nG1 Y10\nG91\nG40 G1 X0 Y0\nM2\n");
    EXPECT_EQ(machine_->task().status().codes.g[4], 411);
    EXPECT_NEAR(motion().carte_pos_cmd.y(), 1, 1e-9) << "beside the line by the radius";
    post(task::AbortAll{});
    settle();
    EXPECT_EQ(machine_->task().status().codes.g[4], 400);
    EXPECT_EQ(mdi("G0 X1 Y0"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 1.0) << "G90 is active, and no move waits";
    EXPECT_DOUBLE_EQ(motion().carte_pos_cmd.y(), 0.0);
}

TEST_F(StopsTest, InASubroutineNamesAndArgumentsOfTheCallersReturn) {
    switch_on();
    start(
        "o<s> sub\n#3=[#1+1]\n#<_seen>=#3\nG1 X20 F300\n#<_seen>=9\n#1=8\no<s> endsub\nG21 G90\n#1=2\n#3=4\n"
        "o<s> call [5]\n#1=11\n#3=12\nM2\n");
    for (int i = 0; i < 5000 && x() < 4; ++i) {
        cycles(1);
    }
    post(task::AbortAll{});
    settle();
    EXPECT_EQ(mdi("G0 X[#1+10*#3+100*#<_seen>]"), task::Progress::FAILED) << "642 is outside of X's limits";
    EXPECT_EQ(mdi("G0 X#1 Y#3 Z[0-#<_seen>]"), task::Progress::DONE) << messages();
    EXPECT_DOUBLE_EQ(x(), 2.0);
    EXPECT_DOUBLE_EQ(motion().carte_pos_cmd.y(), 4.0);
    EXPECT_DOUBLE_EQ(motion().carte_pos_cmd.z(), -6.0);
}

TEST_F(StopsTest, AStopByMdiHasNothingToPause) {
    switch_on();
    EXPECT_EQ(mdi("M0"), task::Progress::DONE) << messages();
    EXPECT_FALSE(machine_->task().status().task.isPaused);
    EXPECT_EQ(mdi("G0 X1"), task::Progress::DONE) << messages();
}

class StepsTest : public StopsTest {
  protected:
    /// One step; waits until it is done.
    void step() {
        ask(task::StepProgram{});
        for (int i = 0; i < 20000 && isRunning() && !status().isPaused; ++i) {
            cycles(1);
        }
        cycles(5);
    }
    const task::TaskStatus &status() const { return machine_->task().status().task; }
    bool isRunning() const { return status().interp_state != task::InterpState::IDLE; }
};

TEST_F(StepsTest, OneStepIsOneBlockToTheEndOfTheProgram) {
    switch_on();
    mdi("G0 X0 Y0");
    write("p.ngc", "G21 G90 G64\n\n(comment)\nG1 X1 F2000\n#31=3\nG4 P0.1\nM0\nG1 X2\nM2\n");
    ask(task::SetMode{task::Mode::AUTO});
    ask(task::OpenProgram{(folder_ / "p.ngc").string()});
    const std::vector<double> positions{0, 1, 1, 1, 1, 2};
    for (const double position : positions) {
        step();
        EXPECT_TRUE(isRunning());
        EXPECT_TRUE(status().isPaused);
        EXPECT_DOUBLE_EQ(x(), position);
    }
    step();
    EXPECT_FALSE(isRunning()) << "M2 ends the program";
    EXPECT_FALSE(status().isPaused);
    EXPECT_EQ(mdi("G0 X0"), task::Progress::DONE) << messages();
}

TEST_F(StepsTest, AStepWhileAProgramRunsPausesItAtTheEndOfTheMove) {
    switch_on();
    run_until_moving("G21 G90 G61\nG1 X6 F600\nG1 X8\nG1 X10\nG1 X0\nM2\n");
    ask(task::StepProgram{});
    EXPECT_FALSE(motion().isInPosition) << "the move under way is done to its end";
    settle();
    EXPECT_TRUE(status().isPaused);
    EXPECT_DOUBLE_EQ(x(), 6);
    step();
    settle();
    EXPECT_DOUBLE_EQ(x(), 8);
    ask(task::StepProgram{});
    cycles(3);
    ask(task::StepProgram{});  // while a step is active
    settle();
    EXPECT_TRUE(status().isPaused);
    EXPECT_DOUBLE_EQ(x(), 10);
    EXPECT_EQ(messages(), "");
    for (int i = 0; i < 2; ++i) {
        step();
        settle();
    }
    EXPECT_FALSE(isRunning());
}

TEST_F(StepsTest, AStepInADwellPausesIt) {
    switch_on();
    start("G21 G90\nG4 P0.5\nG0 X1\nG0 X2\nM2\n");
    cycles(200);
    ask(task::StepProgram{});
    cycles(1000);
    EXPECT_TRUE(status().isPaused);
    EXPECT_DOUBLE_EQ(x(), 0);
    ask(task::ResumeProgram{});
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_DOUBLE_EQ(x(), 2);
}

}  // namespace
}  // namespace mw::machine
