// SPDX-License-Identifier: GPL-2.0-or-later
// Changes of mode, and commands that wait for them.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

TEST_F(TaskTest, ManualModeIsThatOfJointsWhereAxesCannotBeMoved) {
    ASSERT_EQ(ask(SetMode{Mode::AUTO}), Progress::DONE);
    motion.teleop_refusal = motion::Reason::SIDE_APART;
    EXPECT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE)
        << "home or bring the sides together, in manual mode";
    EXPECT_EQ(motion.status.mode, motion::Mode::FREE);
    EXPECT_NE(messages().find("differs from the other joint"), std::string::npos);
    EXPECT_NE(ask(SetTeleop{true}), Progress::DONE) << "axes were asked for";
    EXPECT_EQ(task.status().task.mode, Mode::MANUAL);
}

TEST_F(TaskTest, AStopDoesNotWaitForTheModeToChange) {
    motion.mode_stuck = true;
    const auto mode = post(SetMode{Mode::AUTO});
    cycles(3);
    const auto jog = post(JogContinuous{true, 0, 5}), other = post(JogContinuous{true, 1, 5});
    const auto stop = post(JogStop{true, 0});
    cycles(3);
    EXPECT_EQ(progress(stop), Progress::DONE);
    EXPECT_NE(joined().find("jog stop"), std::string::npos);
    EXPECT_EQ(progress(jog), Progress::REFUSED) << "it would begin after its stop";
    EXPECT_EQ(reason(jog), "the command was sent before a stop");
    EXPECT_EQ(progress(mode), Progress::STARTED);
    EXPECT_EQ(progress(other), Progress::STARTED) << "everything else waits";
    cycles(2100);
    EXPECT_EQ(progress(mode), Progress::FAILED);
    EXPECT_EQ(joined().find("jog 0"), std::string::npos);
    EXPECT_NE(joined().find("jog 1"), std::string::npos);
}

TEST_F(TaskTest, AHoldOfARunThatWaitsForTheModeHoldsIt) {
    open("G21 F600\nG1 X7\nM2\n");
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    motion.mode_stuck = true;
    post(SetMode{Mode::AUTO});
    const auto run = post(RunProgram{}), hold = post(PauseProgram{});
    cycles(3);
    EXPECT_EQ(progress(run), Progress::STARTED);
    EXPECT_EQ(progress(hold), Progress::STARTED);
    motion.status.mode = motion::Mode::COORD;
    cycles(5);
    EXPECT_EQ(progress(hold), Progress::DONE) << reason(hold);
    EXPECT_TRUE(task.status().task.isPaused);
    EXPECT_EQ(joined().find("line 7"), std::string::npos);
    EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE);
    cycles(20);
    EXPECT_EQ(progress(run), Progress::DONE);
}

TEST_F(TaskTest, AStopAlsoEndsOlderCommandsThatStillWaitForTheMode) {
    for (const Command &stop :
         {Command{AbortAll{}}, Command{SetState{State::OFF}}, Command{SetState{State::ESTOP}}}) {
        ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
        post(SetMode{Mode::AUTO});
        const auto waiting = post(Mdi{"G21 G1 X7 F600"}), text = post(OperatorText{"reported anyway"});
        ASSERT_EQ(ask(stop), Progress::DONE);
        EXPECT_EQ(reason(waiting), "the command was sent before a stop");
        EXPECT_EQ(progress(text), Progress::DONE);
        ask(SetState{State::ESTOP_RESET});
        ask(SetState{State::ON});
        EXPECT_EQ(ask(Mdi{"G21 G1 X8 F600"}), Progress::DONE) << reason(request);
    }
    EXPECT_TRUE(joined().contains("line 8") && !joined().contains("line 7")) << joined();
}

TEST_F(TaskTest, AChangeOfModeAfterAStopWaitsUntilTheMachineStands) {
    motion.status.isInPosition = false;  // a jog continues
    EXPECT_EQ(ask(SetMode{Mode::AUTO}), Progress::REFUSED);
    for (const Command &stop : {Command{JogStop{false, 0}}, Command{AbortAll{}}}) {
        motion.status.isInPosition = false;
        post(stop);
        const auto change = post(SetMode{Mode::MDI});
        cycles(9000);  // the braking time of a heavy axis
        EXPECT_EQ(progress(change), Progress::STARTED);
        EXPECT_EQ(task.status().task.mode, Mode::MANUAL);
        motion.status.isInPosition = true;
        cycles(5);
        EXPECT_EQ(progress(change), Progress::DONE);
        EXPECT_EQ(task.status().task.mode, Mode::MDI);
        ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    }
}

TEST_F(TaskTest, AChangeOfModeDoesNotWaitForAJogThatBeganAfterAStop) {
    post(AbortAll{});
    const auto jog = post(JogContinuous{true, 0, 5});
    cycles(3);
    ASSERT_EQ(progress(jog), Progress::DONE) << reason(jog);
    motion.status.isInPosition = false;
    EXPECT_EQ(ask(SetMode{Mode::AUTO}), Progress::REFUSED);
}

}  // namespace
}  // namespace mw::task
