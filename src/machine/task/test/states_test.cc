// SPDX-License-Identifier: GPL-2.0-or-later
// States, modes, homing and waiting commands, each part tested alone.
#include <gtest/gtest.h>

#include "machine/task/states/homing_request.hh"
#include "machine/task/states/inbox.hh"
#include "machine/task/states/machine_state.hh"
#include "machine/task/states/motion_orders.hh"
#include "machine/task/states/operating_mode.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/stops.hh"

namespace mw::task {
namespace {

constexpr std::int64_t S = 1000000000;
constexpr MachineState::Seen OPEN{false, true, false}, CLOSED{true, false, false}, ENABLED{true, false, true};

TEST(Request, EndsOnceAndOnlyItsOwnOrderRefusesIt) {
    Request request;
    EXPECT_FALSE(request.end(Progress::DONE).has_value()) << "none is under way";
    request.begin(7, 100);
    EXPECT_FALSE(request.refuse(0, "no order was given").has_value());
    request.set_order(3);
    EXPECT_FALSE(request.refuse(4, "another's").has_value());
    EXPECT_FALSE(request.isLate(100));
    EXPECT_TRUE(request.isLate(101));
    const auto ended = request.refuse(3, "not enabled");
    ASSERT_TRUE(ended.has_value());
    EXPECT_EQ(ended->command, 7U);
    EXPECT_EQ(ended->progress, Progress::REFUSED);
    EXPECT_EQ(ended->reason, "not enabled");
    EXPECT_FALSE(request.refuse(3, "again").has_value());
    EXPECT_FALSE(request.isLate(1000));
}

TEST(MotionOrders, EndInTheirOrderWithWhatMotionSays) {
    MotionOrders orders;
    const auto until = [](motion::CommandId last) {
        return [last](motion::CommandId order) { return order <= last; };
    };
    EXPECT_FALSE(orders.next(until(100), 6).has_value());
    orders.begin(1, 10, RefusalIsFor::EVERYBODY, 5);
    orders.begin(2, 11, RefusalIsFor::ITS_CLIENT, 5);
    orders.begin(3, 12, RefusalIsFor::EVERYBODY, 5);
    EXPECT_FALSE(orders.next(until(9), 6).has_value());
    EXPECT_FALSE(orders.refuse(13, "another's").has_value());
    const auto refused = orders.refuse(11, "too far");
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->ending.command, 2U);
    EXPECT_EQ(refused->ending.progress, Progress::REFUSED);
    EXPECT_EQ(refused->ending.reason, "too far");
    EXPECT_EQ(refused->reader, RefusalIsFor::ITS_CLIENT);
    EXPECT_EQ(orders.next(until(12), 6)->command, 1U);
    EXPECT_EQ(orders.next(until(12), 6)->command, 3U);
    EXPECT_FALSE(orders.next(until(12), 6).has_value());
}

TEST(MotionOrders, FailWhereMotionDoesNotAnswer) {
    MotionOrders orders;
    const auto none = [](motion::CommandId) { return false; };
    orders.begin(1, 10, RefusalIsFor::EVERYBODY, 0);
    orders.begin(2, 11, RefusalIsFor::EVERYBODY, 1);
    EXPECT_FALSE(orders.next(none, CHANGE_TIMEOUT_NS).has_value());
    const auto failed = orders.next(none, CHANGE_TIMEOUT_NS + 1);
    ASSERT_TRUE(failed.has_value());
    EXPECT_EQ(failed->command, 1U);
    EXPECT_EQ(failed->progress, Progress::FAILED);
    EXPECT_NE(failed->reason, "");
    EXPECT_FALSE(orders.next(none, CHANGE_TIMEOUT_NS + 1).has_value());
}

class MachineStateTest : public testing::Test {
  protected:
    void reset() {
        ASSERT_EQ(state.ask(State::ESTOP_RESET, 1, 0).outcome, Progress::STARTED);
        EXPECT_EQ(state.step(CLOSED).event, MachineState::Event::ESTOP_RESET);
        ASSERT_TRUE(state.end_request(0).has_value());
    }
    void switch_on() {
        reset();
        ASSERT_EQ(state.ask(State::ON, 2, 0).outcome, Progress::STARTED);
        EXPECT_EQ(state.step(ENABLED).event, MachineState::Event::NONE);
        EXPECT_EQ(state.end_request(0)->progress, Progress::DONE);
        ASSERT_EQ(state.state(), State::ON);
    }
    MachineState state;
};

TEST_F(MachineStateTest, CannotBeSwitchedOnInEmergencyStop) {
    const auto asked = state.ask(State::ON, 1, 0);
    ASSERT_FALSE(asked.outcome.has_value());
    EXPECT_NE(asked.outcome.error().message.find("reset it first"), std::string::npos);
    EXPECT_EQ(state.step(ENABLED).event, MachineState::Event::ESTOP_RESET) << "the chain alone was closed";
}

TEST_F(MachineStateTest, GoesToEmergencyStopWhenTheChainOpensAndEndsWhatWasAskedFor) {
    reset();
    ASSERT_EQ(state.ask(State::ON, 5, 0).outcome, Progress::STARTED);
    const auto news = state.step(OPEN);
    EXPECT_EQ(news.event, MachineState::Event::CHAIN_OPENED);
    ASSERT_TRUE(news.ended.has_value());
    EXPECT_EQ(news.ended->command, 5U);
    EXPECT_EQ(news.ended->progress, Progress::FAILED);
    EXPECT_EQ(state.state(), State::ESTOP);
    EXPECT_EQ(state.step(OPEN).event, MachineState::Event::NONE) << "told once";
}

TEST_F(MachineStateTest, AChainThatStaysOpenFailsTheResetAfterTwoSeconds) {
    ASSERT_EQ(state.ask(State::ESTOP_RESET, 5, S).outcome, Progress::STARTED);
    EXPECT_EQ(state.step({false, false, false}).event, MachineState::Event::NONE);
    EXPECT_FALSE(state.end_request(3 * S).has_value());
    const auto ended = state.end_request(3 * S + 1);
    ASSERT_TRUE(ended.has_value());
    EXPECT_EQ(ended->reason, "pin iocontrol.0.emc-enable-in stays FALSE: the e-stop chain is open");
    EXPECT_EQ(state.state(), State::ESTOP);
}

TEST_F(MachineStateTest, MotionThatDoesNotEnableFailsTheSwitchingOn) {
    reset();
    ASSERT_EQ(state.ask(State::ON, 5, 0).outcome, Progress::STARTED);
    state.set_order(11);
    EXPECT_FALSE(state.refuse(10, "").has_value());
    EXPECT_EQ(state.refuse(11, "a fault is latched")->progress, Progress::REFUSED);
    ASSERT_EQ(state.ask(State::ON, 6, 0).outcome, Progress::STARTED);
    state.step(CLOSED);
    EXPECT_EQ(state.end_request(2 * S + 1)->reason,
              "the motion controller does not enable: is pin motion.enable TRUE?");
}

TEST_F(MachineStateTest, TheLastStateThatWasAskedForCounts) {
    reset();
    ASSERT_EQ(state.ask(State::ON, 5, 0).outcome, Progress::STARTED);
    const auto off = state.ask(State::OFF, 6, 0);
    EXPECT_EQ(off.outcome, Progress::DONE);
    EXPECT_EQ(off.replaced->command, 5U);
    EXPECT_EQ(off.replaced->progress, Progress::FAILED);
    EXPECT_EQ(state.step(ENABLED).event, MachineState::Event::NONE);
    EXPECT_EQ(state.state(), State::ESTOP_RESET) << "motion's late enabling does not switch on";
}

TEST_F(MachineStateTest, IsOffWhenMotionIsAndAnEmergencyStopIsAtOnce) {
    switch_on();
    EXPECT_EQ(state.step(CLOSED).event, MachineState::Event::WENT_OFF);
    EXPECT_EQ(state.state(), State::ESTOP_RESET);
    EXPECT_EQ(state.ask(State::ESTOP, 9, 0).outcome, Progress::DONE);
    EXPECT_EQ(state.state(), State::ESTOP);
}

TEST(OperatingMode, ChangesWhenMotionHasAnsweredAndAgrees) {
    OperatingMode mode;
    mode.begin(Mode::AUTO, motion::Mode::COORD, 4, 20, 0);
    EXPECT_TRUE(mode.isChanging());
    EXPECT_EQ(mode.order(), 20U);
    EXPECT_FALSE(mode.step(false, motion::Mode::COORD, 1).has_value()) << "the mode of before the order";
    EXPECT_FALSE(mode.step(true, motion::Mode::FREE, 1).has_value());
    EXPECT_EQ(mode.mode(), Mode::MANUAL);
    EXPECT_EQ(mode.step(true, motion::Mode::COORD, 1)->progress, Progress::DONE);
    EXPECT_EQ(mode.mode(), Mode::AUTO);
    EXPECT_FALSE(mode.isChanging());
}

TEST(OperatingMode, StaysWhenMotionRefusesIsLateOrTheWorkIsAborted) {
    OperatingMode mode;
    mode.begin(Mode::AUTO, motion::Mode::COORD, 4, 20, 0);
    EXPECT_EQ(mode.refuse(20, "not homed")->progress, Progress::REFUSED);
    mode.begin(Mode::AUTO, motion::Mode::COORD, 5, 21, 0);
    EXPECT_EQ(mode.step(true, motion::Mode::FREE, 2 * S + 1)->progress, Progress::FAILED);
    mode.begin(Mode::AUTO, motion::Mode::COORD, 6, 22, 0);
    EXPECT_EQ(mode.give_up("aborted")->reason, "aborted");
    EXPECT_FALSE(mode.give_up("aborted").has_value());
    EXPECT_FALSE(mode.step(true, motion::Mode::COORD, 1).has_value());
    EXPECT_EQ(mode.mode(), Mode::MANUAL);
}

TEST(OperatingMode, IsManualWhereMotionHasLeftTheCoordinatedModeByItself) {
    OperatingMode mode;
    mode.begin(Mode::MDI, motion::Mode::COORD, 4, 20, 0);
    mode.follow(motion::Mode::FREE);
    ASSERT_EQ(mode.step(true, motion::Mode::COORD, 1)->progress, Progress::DONE) << "a change under way";
    mode.follow(motion::Mode::COORD);
    EXPECT_EQ(mode.mode(), Mode::MDI);
    mode.follow(motion::Mode::FREE);
    EXPECT_EQ(mode.mode(), Mode::MANUAL) << "so that asking for MDI again is no command without effect";
}

TEST(OutOfModeWatch, AllowsOneSecondAtATime) {
    OutOfModeWatch watch;
    EXPECT_FALSE(watch.step(true, 5 * S));
    EXPECT_FALSE(watch.step(true, 6 * S));
    EXPECT_TRUE(watch.step(true, 6 * S + 1));
    EXPECT_FALSE(watch.step(false, 7 * S));
    EXPECT_FALSE(watch.step(true, 8 * S)) << "counted anew";
}

TEST(HomingRequest, IsDoneWhenTheJointIsHomedAndFailedWhenItIsNot) {
    motion::Status motion{};
    HomingRequest homing;
    homing.begin(1, 8, 30);
    EXPECT_EQ(homing.joint(), 1);
    EXPECT_FALSE(homing.step(false, motion).has_value()) << "not answered yet";
    motion.isHoming = true;
    EXPECT_FALSE(homing.step(true, motion).has_value());
    motion.isHoming = false;
    motion.joint[1].isHomed = true;
    EXPECT_EQ(homing.step(true, motion)->progress, Progress::DONE);
    homing.begin(-1, 9, 31);
    EXPECT_EQ(homing.step(true, motion)->reason, "homing did not finish") << "of all joints";
    homing.begin(-1, 10, 32);
    motion.isAllHomed = true;
    EXPECT_EQ(homing.step(true, motion)->progress, Progress::DONE);
    EXPECT_FALSE(homing.step(true, motion).has_value());
}

TEST(HomingRequest, EndsWhenItIsRefusedOrAborted) {
    HomingRequest homing;
    homing.begin(0, 8, 30);
    EXPECT_EQ(homing.refuse(30, "not enabled")->progress, Progress::REFUSED);
    homing.begin(0, 9, 31);
    EXPECT_EQ(homing.give_up("aborted")->command, 9U);
    EXPECT_FALSE(homing.isUnderWay());
}

TEST(Inbox, KeepsTheOrderAndLetsStopsPassWhileTheModeChanges) {
    Inbox inbox;
    inbox.add({{1, 1, Mdi{"G0"}}, {2, 1, AbortAll{}}, {5, 1, JogStop{}}});
    inbox.add({{3, 1, Null{}}, {4, 1, SetState{State::OFF}}});
    EXPECT_EQ(inbox.next(true)->serial, 2U);
    EXPECT_EQ(inbox.next(true)->serial, 5U);
    EXPECT_EQ(inbox.next(true)->serial, 4U);
    EXPECT_FALSE(inbox.next(true).has_value());
    EXPECT_EQ(inbox.next(false)->serial, 1U);
    EXPECT_EQ(inbox.next(false)->serial, 3U);
    EXPECT_FALSE(inbox.next(false).has_value());
}

/// True if the command is executed while the mode changes.
bool isTakenWhileTheModeChanges(const Command &command) {
    Inbox inbox;
    inbox.add({{1, 1, command}});
    return inbox.next(true).has_value();
}

TEST(Inbox, EveryStopButAHoldPassesWhileTheModeChanges) {
    int held = 0;
    for (int place = 0; place < mailbox::STOP_PLACES; ++place) {
        const Command stop = mailbox::stop_at(place);
        const bool is_hold = std::holds_alternative<PauseProgram>(stop);
        held += is_hold ? 1 : 0;
        EXPECT_EQ(isTakenWhileTheModeChanges(stop), !is_hold) << messages::to_text(stop);
    }
    EXPECT_EQ(held, 1);
}

TEST(Inbox, EveryChangeOfTheMachinesStatePassesWhileTheModeChangesAndNothingElse) {
    for (const State state : {State::ESTOP, State::ESTOP_RESET, State::OFF, State::ON}) {
        EXPECT_TRUE(isTakenWhileTheModeChanges(SetState{state})) << static_cast<int>(state);
    }
    EXPECT_TRUE(isTakenWhileTheModeChanges(SetState{State::ESTOP_RESET}));
    for (const Command &command :
         {Command{Mdi{"G0"}}, Command{Null{}}, Command{PauseProgram{}}, Command{ResumeProgram{}},
          Command{JogContinuous{}}, Command{OperatorText{"ready"}}}) {
        EXPECT_FALSE(isTakenWhileTheModeChanges(command)) << messages::to_text(command);
    }
}

TEST(Inbox, DropsWhatWasAskedForBeforeAStopButNoLineForTheOperator) {
    Inbox inbox;
    inbox.add(
        {{1, 1, Mdi{"G0 X1"}}, {2, 1, OperatorText{"ready"}}, {3, 1, AbortAll{}}, {4, 1, Mdi{"G0 X2"}}});
    EXPECT_EQ(inbox.next(true)->serial, 3U);
    EXPECT_EQ(inbox.drop_before(3), std::vector<mailbox::Serial>{1U});
    EXPECT_EQ(inbox.next(false)->serial, 2U);
    EXPECT_EQ(inbox.next(false)->serial, 4U) << "what was asked for after it is carried out";
}

}  // namespace
}  // namespace mw::task
