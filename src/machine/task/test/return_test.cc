// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a paused program whose operator stops the spindle, jogs away and returns.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

class ReturnTest : public TaskTest {
  protected:
    /// Pauses in the middle of a move: X 7 is active, Z 0 and X 8 wait.
    client::Serial hold() {
        motion.status.axis[geometry::AXIS_Z].max_limit = 40;
        open("G21 F600 G90 G61\nS500 M3 M8\nG1 X3\nM0\nG1 X7 F300\nG1 X8\nM2\n");
        const auto run = post(RunProgram{});
        cycles(20);
        EXPECT_TRUE(task.status().task.isStoppedByProgram);
        motion.isHolding = true;
        EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE);
        cycles(10);
        EXPECT_EQ(ask(PauseProgram{}), Progress::DONE);
        cycles(3);
        motion.log.clear();
        return run;
    }
    void stand_at(double x, double z) {
        motion.status.carte_pos_cmd[geometry::AXIS_X] = x;
        motion.status.carte_pos_cmd[geometry::AXIS_Z] = z;
        cycles(2);
    }
    const messages::ApproachStatus &approach() const { return task.status().approach; }
};

TEST_F(ReturnTest, TheAxesAreJoggedOnlyOnceTheyAreReleased) {
    const auto run = hold();
    EXPECT_EQ(ask(JogContinuous{false, 0, 5}), Progress::REFUSED);
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE) << reason(request);
    EXPECT_TRUE(task.status().task.isAway);
    EXPECT_EQ(motion.status.mode, motion::Mode::TELEOP);
    EXPECT_EQ(ask(JogContinuous{false, 0, 5}), Progress::DONE) << reason(request);
    cycles(3000);
    EXPECT_EQ(progress(run), Progress::STARTED) << "it waits as long as it takes";
    EXPECT_EQ(joined(), "abort, jog 0");
    EXPECT_EQ(ask(StepProgram{}), Progress::REFUSED);
}

TEST_F(ReturnTest, AxesThatMotionHasNotLetGoAreAskedForAgain) {
    hold();
    motion.teleop_refusal = motion::Reason::MOVING;
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::REFUSED);
    motion.teleop_refusal = motion::Reason::NONE;
    EXPECT_EQ(motion.status.mode, motion::Mode::COORD);
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE) << reason(request);
    EXPECT_EQ(motion.status.mode, motion::Mode::TELEOP);
    EXPECT_EQ(ask(JogContinuous{false, 0, 5}), Progress::DONE) << reason(request);
}

TEST_F(ReturnTest, ItComesBackByTheWayThatIsConfirmedAndGoesOn) {
    const auto run = hold();
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE) << reason(request);
    ASSERT_EQ(ask(SpindleOff{}), Progress::DONE);
    ASSERT_EQ(ask(FloodOff{}), Progress::DONE);
    stand_at(20, 10);
    motion.log.clear();
    motion.isHolding = false;
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    cycles(50);
    EXPECT_EQ(joined(), "") << "nothing moves or turns before it is confirmed";
    EXPECT_EQ(approach().to, ApproachTo::PLACE_LEFT);
    EXPECT_EQ(approach().num_moves, 3U);
    EXPECT_EQ(approach().speeds_rpm[0], 500);
    ASSERT_EQ(ask(ConfirmApproach{approach().number}), Progress::DONE) << reason(request);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    EXPECT_EQ(joined(), "line 20, spindle 500, line 3, line 3, line 7, line 8, spindle off");
}

/// The loaded tool must not be treated as loaded by the operator, because it could then not be changed back
/// and only an abort would be possible.
TEST_F(ReturnTest, AProgramThatIsHeldInAToolChangeGoesOnWithItsTool) {
    open("G21 F600\nT5 M6\nG1 X3\nM2\n");
    io.changer_working = false;
    const client::Serial run = post(RunProgram{});
    cycles(30);
    ASSERT_TRUE(io.outputs.tool_change);
    ASSERT_EQ(ask(PauseProgram{}), Progress::DONE);
    io.changer_working = true;
    cycles(30);
    ASSERT_EQ(task.status().tool.in_spindle, 5);
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    cycles(200);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
}

/// The tool may be loaded in the cycle in which the program resumes.
TEST_F(ReturnTest, AProgramThatIsHeldInAToolChangeGoesOnInWhateverCycleTheToolComes) {
    for (int wait = 0; wait < 6; ++wait) {
        open("G21 F600\nT5 M6\nG1 X3\nT0 M6\nM2\n");
        io.changer_working = false;
        const client::Serial run = post(RunProgram{});
        cycles(30);
        ASSERT_TRUE(io.outputs.tool_change);
        ASSERT_EQ(ask(PauseProgram{}), Progress::DONE);
        io.changer_working = true;
        cycles(wait);
        ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
        cycles(200);
        EXPECT_EQ(progress(run), Progress::DONE) << wait << ": " << reason(run);
    }
}

TEST_F(ReturnTest, ASpindleThatWasStoppedInAHoldIsNotForgotten) {
    const auto run = hold();
    ASSERT_EQ(ask(SpindleOff{}), Progress::DONE);
    cycles(2);
    motion.log.clear();
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    motion.isHolding = false;
    cycles(20);
    EXPECT_EQ(joined(), "abort") << "no cut with a stopped spindle";
    EXPECT_EQ(task.status().task.interp_state, InterpState::PAUSED);
    ASSERT_EQ(ask(ConfirmApproach{approach().number}), Progress::DONE) << reason(request);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE);
    EXPECT_EQ(joined(), "abort, spindle 500, line 7, line 8, spindle off");
}

TEST_F(ReturnTest, ResumeWhereNothingWasTouchedGoesOnAtOnce) {
    const auto run = hold();
    motion.isHolding = false;
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE);
    cycles(50);
    EXPECT_EQ(progress(run), Progress::DONE);
    EXPECT_EQ(joined(), "line 7, line 8, spindle off");
}

TEST_F(ReturnTest, AnAbortWhileAwayLeavesNothingThatGoesOn) {
    for (const bool proposed : {false, true}) {
        const auto run = hold();
        ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE);
        stand_at(20, 10);
        motion.isHolding = false;
        if (proposed) {
            ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE);
        }
        const std::uint64_t number = approach().number;
        ASSERT_EQ(ask(AbortAll{}), Progress::DONE);
        EXPECT_EQ(progress(run), Progress::FAILED);
        EXPECT_EQ(ask(ConfirmApproach{number}), Progress::REFUSED);
        EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE);
        cycles(100);
        EXPECT_EQ(joined().find("line"), std::string::npos) << joined();
        EXPECT_FALSE(task.status().task.isAway);
        ask(SetMode{Mode::MANUAL});
    }
}

TEST_F(ReturnTest, FromAProposedWayTheAxesCanBeReleasedAgain) {
    const auto run = hold();
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE);
    stand_at(20, 10);
    motion.isHolding = false;
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE);
    const std::uint64_t first = approach().number;
    ASSERT_EQ(ask(ReleaseAxes{}), Progress::DONE) << reason(request);
    stand_at(3, 10);
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(ask(ConfirmApproach{first}), Progress::REFUSED) << "that way began elsewhere";
    EXPECT_EQ(approach().num_moves, 1U) << "it is over the place: down";
    ASSERT_EQ(ask(ConfirmApproach{approach().number}), Progress::DONE) << reason(request);
    cycles(100);
    EXPECT_EQ(progress(run), Progress::DONE);
    EXPECT_NE(joined().find("line 7, line 8"), std::string::npos);
}

}  // namespace
}  // namespace mw::task
