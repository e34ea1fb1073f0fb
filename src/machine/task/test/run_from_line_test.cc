// SPDX-License-Identifier: GPL-2.0-or-later
// Tests RunProgram from a line: the proposal that a client sees and confirms, and the moves that follow.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

class RunFromLineTest : public TaskTest {
  protected:
    static constexpr const char *PROGRAM =
        "G21 F600\nT5 M6\nS800 M3 M8\nG0 X10 Z5\nG1 Z-1\nG1 X20\nG1 X30\nM2\n";
    /// Starts the program and calculates the state.
    client::Serial from(const std::string &text, int line) {
        motion.status.axis[geometry::AXIS_Z].max_limit = 40;
        open(text);
        motion.log.clear();
        const auto run = post(RunProgram{line});
        cycles(5);
        return run;
    }
    const messages::ApproachStatus &approach() const { return task.status().approach; }
};

TEST_F(RunFromLineTest, NothingMovesOrTurnsBeforeAPersonConfirms) {
    const auto run = from(PROGRAM, 7);
    cycles(500);
    EXPECT_EQ(joined(), "");
    EXPECT_EQ(progress(run), Progress::STARTED);
    EXPECT_EQ(task.status().task.interp_state, InterpState::PAUSED);
    EXPECT_EQ(approach().to, ApproachTo::LINE);
    EXPECT_EQ(approach().line, 7);
    EXPECT_EQ(approach().tool, 5);
    EXPECT_TRUE(approach().mustChangeTool && approach().isFloodOn);
    EXPECT_EQ(approach().speeds_rpm[0], 800);
    EXPECT_EQ(approach().num_moves, 3U);
    EXPECT_EQ(ask(ConfirmApproach{approach().number + 1}), Progress::REFUSED);
    EXPECT_EQ(joined(), "");
    EXPECT_EQ(ask(ConfirmApproach{approach().number}), Progress::DONE) << reason(request);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    EXPECT_EQ(joined(), "line 0, spindle off, spindle 800, line 20, line 20, line 30, spindle off");
    EXPECT_TRUE(io.outputs.tool_number == 5);
    EXPECT_EQ(approach().number, 0U);
}

TEST_F(RunFromLineTest, ResumeOfAnOlderClientConfirmsWhatHasBeenSeen) {
    const auto run = from(PROGRAM, 7);
    EXPECT_EQ(ask(ResumeProgram{}), Progress::REFUSED) << "no one can have seen it yet";
    EXPECT_EQ(joined(), "");
    cycles(600);
    EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE);
}

TEST_F(RunFromLineTest, WhereNothingHasToBeBroughtAboutItRunsAtOnce) {
    const auto run = from("(a)\n(b)\nG21 F600\n(c)\nG1 X7\nM2\n", 5);
    cycles(50);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    EXPECT_EQ(joined().substr(0, 6), "line 7");
}

TEST_F(RunFromLineTest, AnAbortDropsTheProposalAndWhatWasCalculated) {
    const auto run = from("G21 F600\nG10 L2 P1 X5\nG91\nG1 X10\nG1 X20\nM2\n", 5);
    const std::uint64_t number = approach().number;
    ASSERT_NE(number, 0U);
    ASSERT_EQ(ask(AbortAll{}), Progress::DONE);
    EXPECT_EQ(progress(run), Progress::FAILED);
    EXPECT_EQ(ask(ConfirmApproach{number}), Progress::REFUSED);
    EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE);
    cycles(50);
    EXPECT_EQ(joined().find("line"), std::string::npos) << joined();
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"F600 G1 X3"}), Progress::DONE);
    EXPECT_NE(joined().find("line 3"), std::string::npos) << joined() << ": no G91 and no offset";
}

TEST_F(RunFromLineTest, ALineThatCannotIsRefusedWithTheNearestOneThatCan) {
    const auto run = from("G21 F600\nG0 Z5\nG41.1 D2 G1 X5\nY10\nX20\nG40 Y20\nM2\n", 5);
    EXPECT_EQ(progress(run), Progress::FAILED);
    EXPECT_NE(reason(run).find("the nearest possible line before it is 3"), std::string::npos) << reason(run);
    EXPECT_EQ(task.status().task.interp_state, InterpState::IDLE);
    EXPECT_EQ(ask(RunProgram{-1}), Progress::REFUSED);
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
}

TEST_F(RunFromLineTest, OneThatIsPausedWhileItIsCalculatedAndRefusedHoldsNoOther) {
    open("G21 F600\nG0 Z5\nG41.1 D2 G1 X5\nY10\nX20\nG40 Y20\nM2\n");
    const auto run = post(RunProgram{5});
    const auto pause = post(PauseProgram{});
    cycles(5);
    EXPECT_EQ(progress(pause), Progress::DONE) << reason(pause);
    EXPECT_EQ(progress(run), Progress::FAILED);
    EXPECT_TRUE(std::holds_alternative<motion::Resume>(motion.last));
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
}

TEST_F(RunFromLineTest, StepsWhileItIsCalculatedDoNotHideTheProposal) {
    open("F600\n#1=0\no1 while [#1 LT 1000]\n#1=[#1+1]\no1 endwhile\nG1 X7\nG1 X9\nM2\n");
    const auto run = post(RunProgram{7});
    cycle();
    EXPECT_EQ(ask(StepProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(ask(StepProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(approach().number, 0U) << "it is not calculated yet";
    cycles(50);
    ASSERT_NE(approach().number, 0U);
    EXPECT_TRUE(task.status().task.isPaused);
    EXPECT_EQ(ask(ConfirmApproach{approach().number}), Progress::DONE) << reason(request);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
}

TEST_F(RunFromLineTest, AStopWhileItIsCalculatedEndsIt) {
    const auto run = from("#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile\nG0 X1\nM2\n", 5);
    cycles(20);
    EXPECT_EQ(progress(run), Progress::STARTED);
    EXPECT_EQ(ask(SetState{State::ESTOP}), Progress::DONE);
    EXPECT_EQ(progress(run), Progress::FAILED);
    EXPECT_EQ(joined().find("line"), std::string::npos);
}

}  // namespace
}  // namespace mw::task
