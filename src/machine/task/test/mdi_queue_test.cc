// SPDX-License-Identifier: GPL-2.0-or-later
// Tests MDI lines that wait for the running line.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

class MdiQueueTest : public TaskTest {
  protected:
    MdiQueueTest() : TaskTest(with_room_for_three()) {
        EXPECT_EQ(ask(SetMode{Mode::MDI}), Progress::DONE);
        motion.log.clear();
    }
    static Settings with_room_for_three() {
        Settings settings;
        settings.mdi_queued_commands = 3;
        return settings;
    }
    std::vector<client::Serial> give(int lines) {
        std::vector<client::Serial> given;
        for (int i = 1; i <= lines; ++i) {
            given.push_back(post(Mdi{"G21 F600 G1 X" + std::to_string(i)}));
            cycles(3);
        }
        return given;
    }
};

TEST_F(MdiQueueTest, LinesWaitBehindTheOneThatRunsAndRunInTheirOrder) {
    motion.isHolding = true;
    const auto given = give(5);
    EXPECT_EQ(task.status().task.queued_mdi, 3);
    EXPECT_EQ(progress(given[3]), Progress::STARTED);
    EXPECT_EQ(progress(given[4]), Progress::REFUSED);
    EXPECT_NE(reason(given[4]).find("MDI_QUEUED_COMMANDS"), std::string::npos) << reason(given[4]);
    motion.isHolding = false;
    cycles(60);
    EXPECT_EQ(joined(), "line 1, line 2, line 3, line 4");
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(progress(given[static_cast<std::size_t>(i)]), Progress::DONE);
    }
    EXPECT_EQ(task.status().task.queued_mdi, 0);
}

TEST_F(MdiQueueTest, AnAbortLeavesNothingQueued) {
    for (const Command &stop :
         {Command{AbortAll{}}, Command{SetState{State::OFF}}, Command{SetState{State::ESTOP}}}) {
        motion.isHolding = true;
        const auto given = give(3);
        motion.log.clear();
        ASSERT_EQ(ask(stop), Progress::DONE);
        motion.isHolding = false;
        cycles(60);
        EXPECT_EQ(joined().find("line"), std::string::npos) << joined();
        EXPECT_EQ(progress(given[0]), Progress::FAILED);
        EXPECT_EQ(progress(given[1]), Progress::REFUSED);
        EXPECT_EQ(reason(given[2]), "the command was sent before a stop");
        EXPECT_EQ(task.status().task.queued_mdi, 0);
        ask(SetState{State::ESTOP_RESET});
        ask(SetState{State::ON});
        ask(SetMode{Mode::MDI});
    }
}

TEST_F(MdiQueueTest, ALineThatFailsTakesTheWaitingOnesWithIt) {
    motion.isHolding = true;
    const auto first = post(Mdi{"G21 F600 G1 X1"}), bad = post(Mdi{"G1 X1 X2"}),
               last = post(Mdi{"G21 F600 G1 X9"});
    cycles(5);
    motion.isHolding = false;
    cycles(60);
    EXPECT_EQ(progress(first), Progress::DONE);
    EXPECT_EQ(progress(bad), Progress::FAILED);
    EXPECT_EQ(progress(last), Progress::REFUSED);
    EXPECT_EQ(joined().find("line 9"), std::string::npos) << joined();
}

TEST_F(MdiQueueTest, AHeldLineHoldsThoseBehindIt) {
    motion.isHolding = true;
    const auto given = give(2);
    ASSERT_EQ(ask(PauseProgram{}), Progress::DONE);
    motion.isHolding = false;
    cycles(60);
    EXPECT_EQ(progress(given[1]), Progress::STARTED);
    EXPECT_EQ(joined().find("line 2"), std::string::npos);
    ASSERT_EQ(ask(ResumeProgram{}), Progress::DONE);
    cycles(60);
    EXPECT_EQ(progress(given[1]), Progress::DONE);
}

TEST_F(MdiQueueTest, TheStatusTellsWhatTaskWaitsForInTheWordsOfOlderClients) {
    EXPECT_EQ(task.status().task.exec_state, messages::ExecState::DONE);
    post(Mdi{"G4 P0.1"});
    cycles(10);
    EXPECT_EQ(task.status().task.exec_state, messages::ExecState::WAITING_FOR_DELAY);
    cycles(200);
    io.changer_working = false;
    post(Mdi{"T5 M6"});
    cycles(20);
    EXPECT_EQ(task.status().task.exec_state, messages::ExecState::WAITING_FOR_IO);
    ask(AbortAll{});
    motion.isHolding = true;
    post(Mdi{"G21 F600 G1 X1 M0"});
    cycles(10);
    EXPECT_EQ(task.status().task.exec_state, messages::ExecState::WAITING_FOR_MOTION_AND_IO);
    ask(AbortAll{});
    cycles(10);
    EXPECT_EQ(task.status().task.exec_state, messages::ExecState::DONE);
}

/// A tap from a client sends motion the same command as G33.1.
TEST_F(MdiQueueTest, ATapOfAClientIsThatOfG33_1) {
    geometry::Pose end = task.status().trajectory.position_cmd;
    end[geometry::AXIS_Z] -= 10;
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1.5}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("SetSpindleSync"), std::string::npos) << reason(request);
    ASSERT_EQ(ask(SetSpindleSync{0, 1.25, true}), Progress::DONE);
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1.5}), Progress::REFUSED) << "the speed alone";
    EXPECT_EQ(ask(SetSpindleSync{5, 1.25, false}), Progress::REFUSED) << "there is one spindle";
    ASSERT_EQ(ask(SetSpindleSync{0, 1.25, false}), Progress::DONE);
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1.5}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "Spindle not turning in g33.1");
    motion.status.spindle[0].speed_cmd_rpm = 500;
    cycles(2);
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1.5}), Progress::DONE) << reason(request);
    EXPECT_EQ(joined(), "tap -10");
    const motion::RigidTap sent = motion.last_tap;
    EXPECT_EQ(sent.end.z(), end.z());
    EXPECT_EQ(sent.pitch_scale, 1.5);
    EXPECT_EQ(sent.terms.feed_per_revolution, 1.25);
    EXPECT_TRUE(sent.terms.isThread());
    EXPECT_EQ(ask(Mdi{"G21 M3 S500 G33.1 Z-10 K1.25 I1.5"}), Progress::DONE) << reason(request);
    EXPECT_EQ(motion.last_tap.end, sent.end);
    EXPECT_EQ(motion.last_tap.pitch_scale, sent.pitch_scale);
    EXPECT_EQ(motion.last_tap.terms.feed_per_revolution, sent.terms.feed_per_revolution);
    EXPECT_EQ(motion.last_tap.terms.velocity_synched, sent.terms.velocity_synched);
}

TEST_F(MdiQueueTest, ATapOfAClientWaitsForItsTurnAndWantsMdiModeAndItsPitchAgainAfterAnAbort) {
    motion.status.spindle[0].speed_cmd_rpm = 500;
    geometry::Pose end = task.status().trajectory.position_cmd;
    end[geometry::AXIS_Z] -= 10;
    ASSERT_EQ(ask(SetSpindleSync{0, 1.25, false}), Progress::DONE);
    motion.isHolding = true;
    const auto line = post(Mdi{"G21 F600 G1 X3"});
    cycles(3);
    const auto tap = post(RigidTapMove{end, 5, 1});
    cycles(3);
    EXPECT_EQ(ask(SetSpindleSync{0, 2, false}), Progress::REFUSED) << "that of the tap that waits stays";
    motion.isHolding = false;
    cycles(60);
    EXPECT_EQ(progress(line), Progress::DONE);
    EXPECT_EQ(progress(tap), Progress::DONE) << reason(tap);
    EXPECT_EQ(joined(), "line 3, tap -10");
    ASSERT_EQ(ask(AbortAll{}), Progress::DONE);
    motion.status.spindle[0].speed_cmd_rpm = 500;
    cycles(20);
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1}), Progress::REFUSED);
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    EXPECT_EQ(ask(SetSpindleSync{0, 1.25, false}), Progress::REFUSED);
    EXPECT_EQ(ask(RigidTapMove{end, 5, 1}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "Must be in MDI mode to issue MDI command");
}

}  // namespace
}  // namespace mw::task
