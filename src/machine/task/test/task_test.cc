// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/test/task_rig.hh"
#include "messages/declarations/catalogue.hh"
#include "motion/interface/texts.hh"

namespace mw::task {
namespace {

TEST_F(TaskTest, AToolChangeIsConfirmedOnlyWhileAPersonIsAsked) {
    EXPECT_EQ(ask(ConfirmToolChange{}), Progress::REFUSED);
    io.isAsking = true;
    EXPECT_EQ(ask(ConfirmToolChange{}), Progress::DONE);
    EXPECT_FALSE(io.isAsking || task.status().tool.isPersonAsked);
}

TEST_F(TaskTest, AUserCodeRunsWithItsWordsAndIsAwaited) {
    make_program("M101", "echo \"$1 $2\" >> " + (folder / "said").string() + "\n");
    open("G21 F600\nG1 X1\nM101 P2.5\nM101 P1 Q2\nG1 X2\nM2\n");
    motion.log.clear();
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    std::ifstream said(folder / "said");
    std::string first, second;
    std::getline(said, first);
    std::getline(said, second);
    EXPECT_EQ(first, "2.500000 -1.000000");
    EXPECT_EQ(second, "1.000000 2.000000");
}

/// A collet that does not close: no later move may start.
TEST_F(TaskTest, AUserCodeThatFailsStopsTheProgram) {
    make_program("M102", "exit 3\n");
    open("G21 F600\nG1 X1\nM102\nG0 X77\nM2\n");
    motion.log.clear();
    EXPECT_EQ(ask(RunProgram{}), Progress::FAILED);
    EXPECT_NE(messages().find("ended with status 3"), std::string::npos);
    EXPECT_EQ(joined().find("77"), std::string::npos);
}

/// The mark of a completed step must not block later steps and programs.
TEST_F(TaskTest, AResumeAfterAStepThatIsDoneGoesOn) {
    open("G21 F600\nG1 X1\nG1 X2\nG1 X3\nM2\n");
    const client::Serial run = post(StepProgram{});
    cycles(20);
    ASSERT_TRUE(task.status().task.isPaused);
    ASSERT_EQ(ask(StepProgram{}), Progress::DONE) << reason(request);
    cycles(20);
    ASSERT_TRUE(task.status().task.isPaused);
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    cycles(200);
    EXPECT_EQ(progress(run), Progress::DONE) << reason(run);
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE) << reason(request);
    EXPECT_EQ(ask(Mdi{"G0 X5"}), Progress::DONE) << reason(request);
}

/// Reading ahead is limited in each cycle, so that task receives commands.
TEST_F(TaskTest, AnEndlessLoopEndsWithAnAbort) {
    open("o1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n");
    const client::Serial run = post(RunProgram{});
    cycles(100);
    EXPECT_EQ(progress(run), Progress::STARTED);
    EXPECT_EQ(ask(AbortAll{}), Progress::DONE);
    EXPECT_NE(progress(run), Progress::STARTED);
}

TEST_F(TaskTest, AUserCodeNeedsAnExecutableFile) {
    std::ofstream(folder / "M103") << "#!/bin/sh\n";
    open("M103\nM2\n");
    EXPECT_EQ(ask(RunProgram{}), Progress::FAILED);
    EXPECT_NE(messages().find("Unknown m code used: M103"), std::string::npos);
}

TEST_F(TaskTest, AMoveThatCompensationHoldsBackIsTold) {
    ASSERT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G21 F600 G41.1 D1"}), Progress::DONE) << reason(request);
    EXPECT_EQ(messages().find("delays this move"), std::string::npos);
    motion.log.clear();
    EXPECT_EQ(ask(Mdi{"G1 X10 Y10"}), Progress::DONE) << reason(request);
    EXPECT_NE(messages().find("delays this move"), std::string::npos);
    EXPECT_EQ(joined().find("line"), std::string::npos);
    EXPECT_EQ(ask(Mdi{"G40"}), Progress::DONE);
    EXPECT_EQ(joined().substr(0, 4), "line");
}

TEST_F(TaskTest, M99InTheMainProgramBeginsItAgain) {
    open("G21 F600\n#1=[#1+1]\nO1 if [#1 ge 3]\nM2\nO1 endif\nG1 X#1\nM99\n");
    motion.log.clear();
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(joined().substr(0, 14), "line 1, line 2");
}

TEST_F(TaskTest, HomingOfAnotherJointWaitsForTheFirst) {
    motion.status.isHoming = true;
    const auto first = post(HomeJoint{0});
    cycles(3);
    const auto second = post(HomeJoint{1});
    cycles(3);
    for (const int joint : {0, 1, -1}) {  // active joint, waiting joint, all joints
        EXPECT_EQ(ask(HomeJoint{joint}, 3), Progress::REFUSED);
        EXPECT_NE(reason(request).find("homing"), std::string::npos);
    }
    EXPECT_EQ(progress(first), Progress::STARTED);
    EXPECT_EQ(progress(second), Progress::STARTED);
    EXPECT_EQ(task.status().task.waiting.index, 0);
    motion.status.isHoming = false;
    motion.status.joint[0].isHomed = true;
    cycles(1);
    motion.status.isHoming = true;
    cycles(3);
    EXPECT_EQ(progress(first), Progress::DONE) << reason(first);
    EXPECT_EQ(progress(second), Progress::STARTED);
    EXPECT_EQ(task.status().task.waiting.index, 1);
    motion.status.isHoming = false;
    motion.status.joint[1].isHomed = true;
    cycles(3);
    EXPECT_EQ(progress(second), Progress::DONE) << reason(second);
}

TEST_F(TaskTest, AJointThatWaitsToBeHomedIsNotAfterAStop) {
    for (const bool aborted : {true, false}) {
        motion.status.isHoming = true;
        const auto first = post(HomeJoint{0});
        cycles(3);
        const auto second = post(HomeJoint{1});
        cycles(3);
        EXPECT_EQ(progress(second), Progress::STARTED);
        if (aborted) {
            EXPECT_EQ(ask(AbortAll{}), Progress::DONE);
        }
        motion.status.isHoming = false;  // the first joint is not homed
        cycles(5);
        EXPECT_EQ(progress(first), Progress::FAILED) << reason(first);
        EXPECT_EQ(progress(second), Progress::REFUSED) << reason(second);
        EXPECT_EQ(task.status().task.waiting.what, WaitFor::NOTHING);
    }
}

TEST_F(TaskTest, AxesAreMovedByHandOnceAllJointsAreHomed) {
    using MotionMode = motion::Mode;
    motion.status.isAllHomed = false;
    motion.status.isHoming = true;
    const auto homing = post(HomeJoint{-1});
    cycles(3);
    motion.status.isHoming = false;
    motion.status.isAllHomed = true;
    cycles(3);
    EXPECT_EQ(progress(homing), Progress::DONE) << reason(homing);
    EXPECT_EQ(motion.status.mode, MotionMode::TELEOP);
    EXPECT_EQ(ask(SetTeleop{false}), Progress::DONE);
    EXPECT_EQ(motion.status.mode, MotionMode::FREE);
    EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(motion.status.mode, MotionMode::TELEOP);
    // Requesting the same mode again succeeds, but nothing changes during motion.
    EXPECT_EQ(ask(SetTeleop{false}), Progress::DONE);
    motion.status.isInPosition = false;
    EXPECT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(motion.status.mode, MotionMode::FREE);
    motion.status.isInPosition = true;
    EXPECT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(motion.status.mode, MotionMode::TELEOP);
    motion.status.isAllHomed = false;
    EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(motion.status.mode, MotionMode::FREE);
}

TEST_F(TaskTest, WhatComesRightBehindSwitchingOnWaitsForIt) {
    EXPECT_EQ(ask(SetState{State::OFF}), Progress::DONE);
    const auto on = post(SetState{State::ON});
    const auto homing = post(HomeJoint{0});
    motion.status.joint[0].isHomed = true;
    cycles(5);
    EXPECT_EQ(progress(on), Progress::DONE) << reason(on);
    EXPECT_EQ(progress(homing), Progress::DONE) << reason(homing);
}

TEST_F(TaskTest, TheErrorOfALineOfMdiIsToldBare) {
    EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
    EXPECT_EQ(ask(Mdi{"G43.2"}), Progress::FAILED);
    EXPECT_EQ(messages(), "G43.2: No axes specified and H word missing\n");
    open("G43.2\nM2\n");
    EXPECT_EQ(ask(RunProgram{}), Progress::FAILED);
    EXPECT_NE(messages().find("p.ngc:1:"), std::string::npos);
}

TEST_F(TaskTest, AProgramRunsToItsEnd) {
    open("G21 F600\nG1 X1\nG1 X2\nM2\n");
    motion.log.clear();
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(joined().substr(0, 14), "line 1, line 2");
    EXPECT_EQ(task.status().task.interp_state, InterpState::IDLE);
    EXPECT_EQ(task.status().task.programs_ended, 1U);
    EXPECT_TRUE(task.run().isDone());
}

TEST_F(TaskTest, AProgramChoosesThePlannerInItsPlace) {
    open("G21 F600\nG1 X1\nG64 P0.1 R0.5\nG1 X2\nG64 P0.1\nG1 X3\nG64 R0\nG1 X4\nG64 R0\nG1 X5\nM2\n");
    motion.log.clear();
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(joined().substr(0, 59), "line 1, planner 1, line 2, line 3, planner 0, line 4, line ");
    EXPECT_EQ(motion.corner_scale, 0.0);
    EXPECT_NE(messages().find("MAX_LINEAR_JERK"), std::string::npos);
}

TEST_F(TaskTest, CornerSpeedOfG64RTravelsWithTheMoves) {
    open("G21 F600\nG64 P0.1 R0.5\nG1 X2\nM2\n");
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(motion.corner_scale, 0.5);
}

TEST_F(TaskTest, TheOperatorsPlannerComesWhenAllIsIdle) {
    motion.isHolding = true;
    open("G21 F600\nG1 X1\nM2\n");
    request = post(RunProgram{});
    cycles(20);
    motion.log.clear();
    task.planner_mode().wish(1);
    cycles(20);
    EXPECT_EQ(joined(), "");
    EXPECT_NE(messages().find("waits until motion is idle"), std::string::npos);
    motion.isHolding = false;
    cycles(30);
    EXPECT_EQ(joined(), "line 1, spindle off, planner 1");
    task.planner_mode().wish(7);
    cycles(2);
    EXPECT_EQ(joined(), "line 1, spindle off, planner 1");
    EXPECT_NE(messages().find("0 (trapezoidal) or 1"), std::string::npos);
}

class NoSmoothPlanner : public TaskTest {
  protected:
    NoSmoothPlanner() : TaskTest(without()) {}
    static Settings without() {
        Settings settings;
        settings.sequencer.smooth_planner = 0;
        return settings;
    }
};

TEST_F(NoSmoothPlanner, G64RIsRefused) {
    open("G21 F600\nG1 X1\nG64 P0.1 R0.5\nG1 X2\nM2\n");
    motion.log.clear();
    EXPECT_NE(ask(RunProgram{}), Progress::DONE);
    EXPECT_EQ(joined().find("line 2"), std::string::npos);
    EXPECT_NE(messages().find("SMOOTH_PLANNER"), std::string::npos);
}

TEST_F(TaskTest, CommandsThatCannotBeDoneAreRefusedWithAReason) {
    EXPECT_EQ(ask(Mdi{"G0 X1"}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "Must be in MDI mode to issue MDI command");
    EXPECT_EQ(ask(RunProgram{}), Progress::REFUSED);
    EXPECT_EQ(ask(OpenProgram{"/nowhere.ngc"}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("/nowhere.ngc"), std::string::npos);
    motion.status.isAllHomed = false;
    open("M2\n");
    EXPECT_EQ(ask(RunProgram{}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("not all joints are homed"), std::string::npos);
}

TEST_F(TaskTest, WhereNothingRunsPauseAndResumeAreTakenAndDoNothing) {
    EXPECT_EQ(ask(PauseProgram{}), Progress::DONE) << reason(request);
    EXPECT_FALSE(task.status().task.isPaused);
    EXPECT_EQ(ask(ResumeProgram{}), Progress::DONE) << reason(request);
    EXPECT_EQ(task.status().task.interp_state, InterpState::IDLE);
}

TEST_F(TaskTest, SetDebugIsShownInTheStatus) {
    EXPECT_EQ(ask(SetDebug{0x4321}), Progress::DONE);
    EXPECT_EQ(task.status().settings.debug, 0x4321U);
}

TEST_F(TaskTest, AScreenThatStartsInEmergencyStopChoosesJointsAndForgetsHoming) {
    ASSERT_EQ(ask(SetState{State::ESTOP}), Progress::DONE);
    EXPECT_EQ(ask(SetTeleop{false}), Progress::DONE);
    EXPECT_EQ(ask(SetMotionMode{messages::MotionMode::FREE}), Progress::DONE);
    EXPECT_EQ(ask(SetMotionMode{messages::MotionMode::COORD}), Progress::REFUSED);
    EXPECT_EQ(ask(UnhomeJoint{-1}), Progress::DONE);
    EXPECT_EQ(ask(HomeJoint{-1}), Progress::REFUSED);
    ASSERT_EQ(ask(SetMode{Mode::AUTO}), Progress::DONE);
    EXPECT_EQ(ask(SetTeleop{true}), Progress::DONE);
    EXPECT_EQ(task.status().task.mode, Mode::MANUAL) << "as in any mode in which nothing runs";
}

TEST_F(TaskTest, ATurningSpindleChangesItsSpeedInStepsAndNeverItsSense) {
    EXPECT_EQ(ask(SpindleIncrease{0}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "spindle 0 is stopped");
    EXPECT_EQ(ask(SpindleIncrease{7}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "there is no spindle 7");
    motion.log.clear();
    ask(SpindleOn{0, -150});
    ask(SpindleIncrease{0});
    ask(SpindleDecrease{0});
    ask(SpindleDecrease{0});
    ask(SpindleDecrease{0});
    EXPECT_EQ(ask(SpindleConstant{0}), Progress::DONE);
    EXPECT_EQ(joined(), "spindle -150, spindle -250, spindle -150, spindle -50, spindle -1");
    ask(SpindleOff{0});
    EXPECT_EQ(ask(SpindleDecrease{0}), Progress::REFUSED);
}

TEST_F(TaskTest, AVectorOfTeleopSpeedsGoesToMotionInManualMode) {
    SetTeleopVector vector;
    vector.velocity[0] = 3;
    vector.velocity[2] = -4;
    ASSERT_EQ(ask(SetMode{Mode::AUTO}), Progress::DONE);
    EXPECT_EQ(ask(vector), Progress::REFUSED);
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(ask(vector), Progress::DONE);
    const auto *taken = std::get_if<motion::SetTeleopVector>(&motion.last);
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->velocity, vector.velocity);
}

TEST_F(TaskTest, ATableOfScrewErrorsIsReadWhileTheMachineIsOff) {
    const std::string path = (folder / "x.comp").string();
    std::ofstream(path) << "0 0.01 -0.01\n10 0.02 -0.02\n";
    EXPECT_EQ(ask(LoadCompensation{1, path, 1}), Progress::REFUSED) << "it is on";
    ASSERT_EQ(ask(SetState{State::OFF}), Progress::DONE);
    const auto nothing = post(LoadCompensation{1, (folder / "y.comp").string(), 1});
    cycles(2);
    EXPECT_EQ(progress(nothing), Progress::REFUSED);
    EXPECT_NE(reason(nothing).find("y.comp"), std::string::npos);
    EXPECT_EQ(ask(LoadCompensation{1, path, 1}), Progress::DONE);
    cycles(3);
    const auto *last = std::get_if<motion::LoadCompensation>(&motion.last);
    ASSERT_NE(last, nullptr);
    EXPECT_EQ(last->joint, 1);
    EXPECT_EQ(last->index, 1);
    EXPECT_EQ(last->count, 2);
    EXPECT_EQ(last->reverse, -0.02);
    EXPECT_TRUE(task.isConfigured().value_or(false));
}

/// Clients may exist before a machine has started; their rejected commands do not end its start.
TEST_F(TaskTest, WhyASettingWasRefusedIsToldApartFromWhatClientsAre) {
    task.configure({});
    ask(SetState{State::ESTOP});
    EXPECT_EQ(ask(SetState{State::ON}), Progress::REFUSED);
    motion.jog_refusal = motion::Reason::NOT_ENABLED;
    cycles(3);
    EXPECT_TRUE(task.isConfigured().value_or(false));
    motion.setting_refusal = motion::Reason::OUT_OF_RANGE;
    task.configure({{static_cast<std::uint16_t>(motion::Parameter::TRAJ_PLANNER_TYPE), 0, 1}});
    cycles(3);
    motion::Answer answer;
    answer.reason = motion::Reason::OUT_OF_RANGE;
    ASSERT_FALSE(task.isConfigured().has_value());
    EXPECT_EQ(task.isConfigured().error().message, "a setting was rejected: " + motion::reason_text(answer));
}

TEST_F(TaskTest, EveryCommandOfTheVocabularyIsAnsweredAndARefusalSaysWhy) {
    for (const messages::Declaration *declaration : messages::command_declarations()) {
        Command command = *messages::make_command(declaration->number);
        if (!messages::check(command).has_value()) {  // commands with a text that must not be empty
            for (const messages::Field &field : declaration->fields) {
                if (field.type.kind == messages::Kind::TEXT) {
                    *static_cast<std::string *>(field.at(messages::object(command).data)) = "text";
                }
            }
        }
        const Progress end = ask(command, 3000);
        EXPECT_NE(end, Progress::STARTED) << declaration->name;
        EXPECT_EQ(end == Progress::REFUSED || end == Progress::FAILED, !reason(request).empty())
            << declaration->name << ": " << reason(request);
    }
    EXPECT_EQ(ask(SetState{State::ESTOP}), Progress::DONE);
    EXPECT_EQ(task.status().task.state, State::ESTOP);
    EXPECT_EQ(ask(SetState{State::ESTOP_RESET}), Progress::DONE);
}

TEST_F(TaskTest, TheStatusMarksWhatTheMachineDoesNotHave) {
    cycles(2);
    ASSERT_TRUE(client.read_status().has_value());
    const messages::MachineStatus &seen = client.status();
    EXPECT_EQ(seen.trajectory.axis_mask, 7U);
    EXPECT_EQ(seen.trajectory.num_joints, 3);
    for (std::size_t i = 0; i < seen.joints.size(); ++i) {
        EXPECT_EQ(seen.joints[i].isPresent, i < 3) << i;
    }
    for (std::size_t i = 0; i < seen.axes.size(); ++i) {
        EXPECT_EQ(seen.axes[i].isPresent, i < 3) << i;
    }
    for (std::size_t i = 0; i < seen.spindles.size(); ++i) {
        EXPECT_EQ(seen.spindles[i].isPresent, i < 1) << i;
    }
    EXPECT_EQ(seen.task.state, State::ON);
    EXPECT_EQ(seen.codes.g[5], 210) << "G21";
    const auto table = client.read_tools();
    ASSERT_TRUE(table.has_value() && table->has_value());
    EXPECT_EQ((*table)->tools[1].toolno, 5);
    EXPECT_EQ((*table)->version, seen.tool.table_version);
}

TEST_F(TaskTest, TheLastCommandAndHowItStandsAreInTheStatus) {
    motion.isHolding = true;
    open("G21 F600\nG1 X1\nM2\n");
    const auto run = post(RunProgram{});
    cycles(5);
    EXPECT_EQ(task.status().last_command, run);
    EXPECT_EQ(task.status().last_progress, Progress::STARTED);
    motion.isHolding = false;
    cycles(20);
    EXPECT_EQ(task.status().last_progress, Progress::DONE);
    ask(SpindleOff{7});
    EXPECT_EQ(task.status().last_progress, Progress::REFUSED);
}

TEST_F(TaskTest, AnErrorInTheProgramStopsItWithItsPlace) {
    open("G21 F600\nG1 X1\nG1 X2 X3\nG1 X4\nM2\n");
    EXPECT_EQ(ask(RunProgram{}), Progress::FAILED);
    EXPECT_NE(messages().find("p.ngc:3:"), std::string::npos);
    EXPECT_EQ(joined().find("line 4"), std::string::npos);
    ASSERT_NE(task.run().error(), nullptr);
    EXPECT_EQ(task.run().error()->what.place.line, 3);
    EXPECT_FALSE(task.run().isDone());
}

TEST_F(TaskTest, NothingQueuedBeforeAnAbortMovesAfterwards) {
    open("G21 F600\nG1 X1\nG1 X2\nG1 X3\nM2\n");
    motion.isHolding = true;
    post(RunProgram{});
    cycles(5);
    post(AbortAll{});
    cycles(2);
    motion.isHolding = false;
    motion.log.clear();
    cycles(10);
    EXPECT_EQ(joined(), "");
    EXPECT_EQ(ask(RunProgram{}), Progress::DONE);
    EXPECT_NE(joined().find("line 1, line 2, line 3"), std::string::npos);
}

TEST_F(TaskTest, ARefusedMoveEndsTheProgram) {
    open("G21 F600\nG1 X1\nG1 X2\nM2\n");
    motion.rejecting_moves = true;
    EXPECT_EQ(ask(RunProgram{}), Progress::FAILED);
    EXPECT_NE(messages().find("p.ngc:2:1: error: the move exceeds the soft limit of axis X"),
              std::string::npos);
}

TEST_F(TaskTest, AnOpenEstopChainStopsEverything) {
    EXPECT_EQ(task.status().task.state, State::ON);
    io.isChainClosed = false;
    cycles(2);
    EXPECT_EQ(task.status().task.state, State::ESTOP);
    EXPECT_FALSE(motion.status.isEnabled);
    EXPECT_EQ(ask(SetState{State::ON}), Progress::REFUSED);
    EXPECT_EQ(ask(SetState{State::ESTOP_RESET}), Progress::FAILED);
    EXPECT_NE(reason(request).find("iocontrol.0.emc-enable-in"), std::string::npos);
    io.isChainClosed = true;
    EXPECT_EQ(ask(SetState{State::ESTOP_RESET}), Progress::DONE);
    EXPECT_FALSE(motion.status.isEnabled) << "reset never restarts anything";
}

}  // namespace
}  // namespace mw::task
