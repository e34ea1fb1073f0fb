// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a connection with a task that accepts its commands.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "clients/rsh/answers.hh"
#include "clients/rsh/session.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::rsh {
namespace {

using messages::MessageKind;
using messages::Mode;
using messages::Progress;
using messages::State;

class RshTest : public ::testing::Test {
  protected:
    explicit RshTest(Dialect dialect = Dialect::NEWER) {
        settings.dialect = dialect;
        settings.ini = &ini;
        settings.num_spindles = 2;
        status->task.state = State::ON;
        status->trajectory.num_joints = 3;
        desk.take(now_ns);
        desk.publish(*status);
        shared.emplace(client::Viewer(memory.segment()));
        EXPECT_TRUE(shared->read().has_value());
        session = begin();
    }
    std::unique_ptr<Session> begin() {
        return std::make_unique<Session>(settings, *shared,
                                         [this] { return client::Client::join(memory.segment()); });
    }
    /// Runs a cycle of task; returns the commands as text.
    void cycle() {
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            asked += (asked.empty() ? "" : ", ") + messages::to_text(delivery.command);
            last_serial = delivery.serial;
            status->last_command = delivery.serial;
            if (progress != Progress::STARTED) {
                desk.tell(delivery.serial, progress, progress == Progress::DONE ? "" : "no");
            }
        }
        status->time_ns = now_ns;
        ++status->cycle;
        desk.publish(*status);
        EXPECT_TRUE(shared->read().has_value());
        session->step(static_cast<double>(now_ns) * 1e-9);
    }
    /// The answer to a line, within some cycles.
    std::string say(const std::string &line) {
        asked.clear();
        session->take(line + "\r\n");
        for (int i = 0; i < 8; ++i) {
            cycle();
        }
        return std::exchange(session->output(), {});
    }
    void greet() {
        say("hello EMC me 1.0");
        say("set echo off");
        say("set enable EMCTOO");
        say("set verbose on");
    }

    diagnostics::Sink sink{[](const diagnostics::Diagnostic &) {}};
    ini::IniFile ini =
        ini::IniFile::parse("[EMCIO]\nTOOL_TABLE = tools.tbl\n[A]\nB = c d\n", "/m/m.ini", sink);
    Settings settings;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    Progress progress = Progress::DONE;
    mailbox::Serial last_serial = 0;
    std::string asked;
    std::optional<SharedView> shared;
    std::unique_ptr<Session> session;
};

class OldRshTest : public RshTest {
  protected:
    OldRshTest() : RshTest(Dialect::OLD) {}
};

TEST_F(RshTest, NothingIsCommandedBeforeHelloAndTheSecondPassword) {
    EXPECT_EQ(say("set mode mdi"), "SET MODE NAK\r\n");
    EXPECT_EQ(say("hello WRONG me 1.0"), "HELLO NAK\r\n");
    EXPECT_EQ(say("hello EMC me 1.0"), "HELLO ACK EMCNETSVR 1.1\r\n");
    EXPECT_EQ(say("set mode mdi"), "set mode mdi\r\nSET MODE NAK\r\n");
    EXPECT_EQ(say("set enable WRONG"), "set enable WRONG\r\nSET ENABLE NAK\r\n");
    EXPECT_EQ(say("set mode mdi"), "set mode mdi\r\nSET MODE NAK\r\n");
    EXPECT_EQ(asked, "");
    EXPECT_EQ(say("set enable EMCTOO"), "set enable EMCTOO\r\n");
    EXPECT_EQ(say("set mode mdi"), "set mode mdi\r\n");
    EXPECT_NE(asked, "");
    // A later wrong password revokes both.
    EXPECT_EQ(say("hello WRONG me 1.0"), "HELLO NAK\r\n");
    EXPECT_EQ(say("set mode mdi"), "SET MODE NAK\r\n");
}

TEST_F(RshTest, AnOrderIsAnsweredWhenItHasEnded) {
    greet();
    progress = Progress::STARTED;
    EXPECT_EQ(say("set mdi g0 x1"), "");
    // Later lines wait.
    EXPECT_EQ(say("get mode"), "");
    desk.tell(last_serial, Progress::DONE, "");
    EXPECT_EQ(say(""), "SET MDI ACK\r\nMODE MANUAL\r\n");
    progress = Progress::REFUSED;
    EXPECT_EQ(say("set mdi g0 x1"), "SET MDI NAK\r\n");
    say("set wait_mode received");
    progress = Progress::STARTED;
    EXPECT_EQ(say("set mdi g0 x1"), "SET MDI ACK\r\n");
}

TEST_F(RshTest, AnOrderThatTakesTooLongIsAnsweredByNo) {
    greet();
    say("set timeout 0.005");
    progress = Progress::STARTED;
    EXPECT_EQ(say("set mdi g0 x1"), "error: it has not ended within 0.005000 seconds\r\nSET MDI NAK\r\n");
}

TEST_F(RshTest, LinesArriveInPiecesAndWithAnyEnd) {
    greet();
    session->take("get mo");
    cycle();
    EXPECT_EQ(session->output(), "");
    session->take("de\n\r\n\rget plat\rget estop");
    cycle();
    EXPECT_EQ(std::exchange(session->output(), {}), "MODE MANUAL\r\nPLAT Linux\r\n");
    session->end_input();
    cycle();
    EXPECT_EQ(session->output(), "ESTOP OFF\r\n");
    EXPECT_TRUE(session->isOver());
}

TEST_F(RshTest, ALineThatIsTooLongIsRefusedAsAWhole) {
    greet();
    EXPECT_EQ(say("set mdi g0 x1" + std::string(3 * MAX_LINE, ' ')),
              "error: the line has more than 4096 bytes\r\nSET LINE NAK\r\n");
    session->take(std::string(10'000'000, 'x'));
    cycle();
    EXPECT_EQ(say("set mode mdi"), "error: the line has more than 4096 bytes\r\nSET LINE NAK\r\n");
    EXPECT_EQ(asked, "");
    EXPECT_EQ(say("get mode"), "MODE MANUAL\r\n");
}

TEST_F(RshTest, WrongWordsAreToldAndAskNothing) {
    greet();
    EXPECT_EQ(say("set home 3"), "error: Invalid joint '3', valid range [-1,2]\r\nSET HOME NAK\r\n");
    EXPECT_EQ(say("set spindle forward 99"),
              "error: Invalid spindle '99', valid range [-1,1]\r\nSET SPINDLE NAK\r\n");
    EXPECT_EQ(say("get ini B X"), "error: INI file entry '[X]B' not found\r\nGET INI NAK\r\n");
    EXPECT_EQ(say("get ini B A"), "INI [A]B=c d\r\n");
    EXPECT_EQ(say("set feed_override fast"),
              "error: Invalid percentage 'fast', not a number\r\nSET FEED_OVERRIDE NAK\r\n");
    EXPECT_EQ(say("set feed_override nan"),
              "error: Invalid percentage 'nan', not a number\r\nSET FEED_OVERRIDE NAK\r\n");
    EXPECT_EQ(say("set load_tool_table other.tbl"),
              "error: the machine's tool table is 'tools.tbl'\r\nSET LOAD_TOOL_TABLE NAK\r\n");
    EXPECT_EQ(say("frobnicate"), "error: Unknown command 'frobnicate'\r\nFROBNICATE NAK\r\n");
    EXPECT_EQ(asked, "");
}

TEST_F(RshTest, StopsNeedNoMachineThatIsOn) {
    greet();
    status->task.state = State::OFF;
    cycle();
    EXPECT_EQ(say("set mode mdi"), "error: Machine must be 'ON' for SET MODE\r\nSET MODE NAK\r\n");
    EXPECT_EQ(say("set abort"), "SET ABORT ACK\r\n");
    EXPECT_EQ(asked, messages::to_text(messages::AbortAll{}));
    EXPECT_EQ(say("set estop on"), "SET ESTOP ACK\r\n");
    EXPECT_EQ(asked, messages::to_text(messages::SetState{State::ESTOP}));
}

TEST_F(RshTest, SpindlesTurnOneAtATimeAndStopAllTogether) {
    greet();
    say("set spindle forward");
    EXPECT_EQ(asked, messages::to_text(messages::SpindleOn{0, 500}));
    status->codes.settings[2] = 800;
    cycle();
    say("set spindle reverse 1");
    EXPECT_EQ(asked, messages::to_text(messages::SpindleOn{1, -800}));
    say("set spindle increase 1");
    EXPECT_EQ(asked, messages::to_text(messages::SpindleIncrease{1}));
    say("set spindle off");
    EXPECT_EQ(asked,
              messages::to_text(messages::SpindleOff{0}) + ", " + messages::to_text(messages::SpindleOff{1}));
    status->spindles[1].direction = -1;
    cycle();
    EXPECT_EQ(say("get spindle -1"), "SPINDLE 0 OFF\r\nSPINDLE 1 REVERSE\r\n");
}

TEST_F(RshTest, AJogHasALeaseAndStopsWithItsConnection) {
    greet();
    EXPECT_EQ(say("set jog 1 -60"), "SET JOG ACK\r\n");
    EXPECT_EQ(asked, messages::to_text(messages::JogContinuous{true, 1, -1, 500}));
    EXPECT_TRUE(session->isBusy());
    asked.clear();
    for (int i = 0; i < 150; ++i) {
        cycle();
    }
    EXPECT_EQ(asked, messages::to_text(messages::JogContinuous{true, 1, -1, 500, true}));
    asked.clear();
    auto gone = std::move(session);
    session = begin();
    gone.reset();
    cycle();
    EXPECT_EQ(asked, messages::to_text(messages::JogStop{true, 1}));
}

TEST_F(RshTest, AJogThatHasEndedIsNotRenewed) {
    greet();
    say("set jog 1 60");
    progress = Progress::REFUSED;  // the renewal is rejected, because a limit has ended the jog
    for (int i = 0; i < 150; ++i) {
        cycle();
    }
    asked.clear();
    for (int i = 0; i < 300; ++i) {
        cycle();
    }
    EXPECT_EQ(asked, "");
    EXPECT_FALSE(session->isBusy());
}

TEST_F(RshTest, AxesHaveLettersAndJointsNumbers) {
    greet();
    EXPECT_EQ(say("set jog x 60"), "error: Invalid joint 'x', valid range [0,2]\r\nSET JOG NAK\r\n");
    status->trajectory.mode = messages::MotionMode::TELEOP;
    cycle();
    EXPECT_EQ(say("set jog 0 60"), "error: Invalid axis '0', teleop mode has letters\r\nSET JOG NAK\r\n");
    EXPECT_EQ(say("set jog_incr y -120 0.5"), "SET JOG_INCR ACK\r\n");
    EXPECT_EQ(asked, messages::to_text(messages::JogIncrement{false, 1, 2, -0.5}));
}

TEST_F(RshTest, EveryErrorIsToldOnceAlsoToWhoComesLater) {
    greet();
    desk.post(MessageKind::OPERATOR_ERROR, "first");
    desk.post(MessageKind::OPERATOR_DISPLAY, "shown");
    desk.post(MessageKind::OPERATOR_ERROR, "second\nline");
    cycle();
    EXPECT_EQ(say("get error"), "ERROR first\r\n");
    session = begin();
    greet();
    EXPECT_EQ(say("get error"), "ERROR second line\r\n");
    EXPECT_EQ(say("get error"), "ERROR OK\r\n");
    EXPECT_EQ(say("get operator_display"), "OPERATOR_DISPLAY shown\r\n");
    EXPECT_EQ(say("get operator_text"), "OPERATOR_TEXT OK\r\n");
}

TEST_F(RshTest, PositionsAreToldInTheUnitsThatAreAskedFor) {
    greet();
    status->codes.g[5] = 210;
    status->trajectory.position_cmd[0] = 25.4;
    status->offsets.g5x[0] = 10;
    status->offsets.rotation_xy_deg = 90;
    cycle();
    EXPECT_EQ(say("get abs_cmd_pos x"), "ABS_CMD_POS 0 25.400000\r\n");
    EXPECT_EQ(say("get rel_cmd_pos y"), "REL_CMD_POS 1 -15.400000\r\n");
    say("set linear_unit_conversion inch");
    EXPECT_EQ(say("get abs_cmd_pos 0"), "ABS_CMD_POS 0 1.000000\r\n");
    EXPECT_EQ(say("get display_linear_units"), "DISPLAY_LINEAR_UNITS INCH\r\n");
}

TEST_F(RshTest, AnOldStatusIsToldUntilItIsUpdated) {
    greet();
    say("set update none");
    status->task.mode = Mode::MDI;
    cycle();
    EXPECT_EQ(say("get mode"), "MODE MANUAL\r\n");
    say("set update_status");
    EXPECT_EQ(say("get mode"), "MODE MDI\r\n");
}

TEST_F(RshTest, ItWaitsForHomingAndSaysWhenNothingIsHomed) {
    greet();
    status->joints[0].isHoming = true;
    cycle();
    EXPECT_EQ(say("set joint_wait_homed 0"), "");
    status->joints[0].isHoming = false;
    status->joints[0].isHomed = true;
    EXPECT_EQ(say(""), "SET JOINT_WAIT_HOMED ACK\r\n");
    session->take("set joint_wait_homed 1\n");
    for (int i = 0; i < 2100; ++i) {
        cycle();
    }
    EXPECT_EQ(session->output(), "error: nothing is being homed\r\nSET JOINT_WAIT_HOMED NAK\r\n");
}

TEST_F(RshTest, OnlyWhoMayEndsTheServer) {
    EXPECT_EQ(say("shutdown"), "SHUTDOWN NAK\r\n");
    EXPECT_FALSE(session->wantsShutdown());
    greet();
    EXPECT_EQ(say("shutdown"), "SHUTDOWN ACK\r\n");
    EXPECT_TRUE(session->wantsShutdown());
}

TEST_F(RshTest, EveryQuestionAndOrderOfHelpIsKnown) {
    for (const Dialect dialect : {Dialect::NEWER, Dialect::OLD}) {
        settings.dialect = dialect;
        for (const std::string &name : question_names(settings)) {
            EXPECT_NE(answering(settings, name), nullptr) << name;
        }
        for (const std::string &usage : order_usages(settings)) {
            EXPECT_NE(find_order(settings, usage.substr(0, usage.find(' '))), nullptr) << usage;
        }
    }
}

TEST_F(OldRshTest, AnswersHaveTheEndsThatScriptsOf29Know) {
    EXPECT_EQ(say("set echo off"), "SET NAK\r\n");
    EXPECT_EQ(say("hello EMC me 1.0"), "HELLO ACK EMCNETSVR 1.1\r\n");
    EXPECT_EQ(say("set echo off"), "set echo off\r\n");
    EXPECT_EQ(say("set verbose on"), "SET VERBOSE ACK\n\r");
    EXPECT_EQ(say("set mode mdi"), "SET MODE NAK\n\r");
    EXPECT_EQ(say("get bogus"), "GET BOGUS NAK\r\n\r\n");
    EXPECT_EQ(say("bogus"), "");
    EXPECT_EQ(say("get set_wait"), "SET_WAIT RECEIVED\r\n");
    EXPECT_EQ(say("get joint_type 1"), "JOINT_TYPE 1  LINEAR\r\n");
    EXPECT_EQ(say("get teleop_enable"), "TELEOP_ENABLE NO\r\n");
    EXPECT_EQ(say("get joint_homed"), "JOINT_HOMED NO NO NO NO NO NO\r\n");
    say("set enable EMCTOO");
    // A rejected order has been received.
    progress = Progress::REFUSED;
    EXPECT_EQ(say("set mdi g0x1"), "SET MDI ACK\n\r");
}

}  // namespace
}  // namespace mw::rsh
