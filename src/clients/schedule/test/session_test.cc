// SPDX-License-Identifier: GPL-2.0-or-later
// Tests connections and a queue, with a task that accepts their commands.
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "clients/schedule/session.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::schedule {
namespace {

using messages::Progress;

class ScheduleTest : public ::testing::Test {
  protected:
    ScheduleTest() {
        status->task.state = messages::State::ON;
        status->trajectory.num_spindles = 1;
        status->tool.in_spindle = 1;
        desk.take(now_ns);
        desk.publish(*status);
        view.emplace(client::Viewer(memory.segment()));
        EXPECT_TRUE(view->read().has_value());
        scheduler.emplace([this] { return client::Client::join(memory.segment()); }, "/p");
        session = std::make_unique<Session>(Shared{settings, *view, *scheduler});
    }
    /// Runs a cycle of task and of the server.
    void cycle() {
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            const std::string text = messages::to_text(delivery.command);
            asked += (asked.empty() ? "" : "\n") + text;
            status->last_command = delivery.serial;
            if (!refused.empty() && text.find(refused) != std::string::npos) {
                desk.tell(delivery.serial, Progress::REFUSED, "no");
            } else if (is_running && text.find("RunProgram") != std::string::npos) {
                running = delivery.serial;
            } else {
                desk.tell(delivery.serial, Progress::DONE, "");
            }
        }
        status->time_ns = now_ns;
        ++status->cycle;
        desk.publish(*status);
        EXPECT_TRUE(view->read().has_value());
        scheduler->step(view->status(), static_cast<double>(now_ns) * 1e-9);
        session->step(static_cast<double>(now_ns) * 1e-9);
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            cycle();
        }
    }
    std::string say(const std::string &line) {
        session->take(line + "\r\n");
        cycle();
        return std::exchange(session->output(), {});
    }
    void greet() {
        say("hello EMC me 1.1");
        say("set echo off");
        say("set enable EMCTOO");
        say("set verbose on");
    }

    rsh::Settings settings;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    std::optional<rsh::SharedView> view;
    std::optional<Scheduler> scheduler;
    std::unique_ptr<Session> session;
    std::string asked, refused;
    bool is_running = false;  ///< a program does not end by itself
    mailbox::Serial running = 0;
};

TEST_F(ScheduleTest, AnswersAreThoseOfTheOlderProgram) {
    EXPECT_EQ(say("get plat"), "PLAT Linux\r\n");
    EXPECT_EQ(say("hello EMC me"), "HELLO NAK\r\n");
    EXPECT_EQ(say("hello EMC me 1"), "HELLO ACK EMCNETSVR 1.1\r\n");
    EXPECT_EQ(say("get echo"), "get echo\r\nECHO ON\r\n");
    EXPECT_EQ(say("set echo off"), "set echo off\r\n");
    EXPECT_EQ(say("set verbose on"), "SET VERBOSE ACK\n\r");
    EXPECT_EQ(say("get comm_prot"), "COMM_PROT 1\r\n");
    EXPECT_EQ(say("get qmode"), "QMODE STOP\r\n");
    EXPECT_EQ(say("get qstatus"), "QSTATUS 0 0 0 0\r\n");
    EXPECT_EQ(say("get autotagid"), "AUTOTAGID 0\r\n");
    EXPECT_EQ(say("get pollrate"), "POLLRATE 1.000000\r\n");
    EXPECT_EQ(say("get pgmall"), "");
    EXPECT_EQ(say("set enable EMCTOO"), "SET ENABLE ACK\n\r");
    EXPECT_EQ(say("set pgmadd 1 0 1.5 2.5 3.5 0 a.ngc 100 100 1"), "SET PGMADD ACK\n\r");
    EXPECT_EQ(say("get pgmbyid 1"),
              "PGMBYID 1 1 1.500000 2.500000 3.500000 0 a.ngc 100.000000 100.000000 1\r\n");
    EXPECT_EQ(say("get pgmall"),
              "PGMBYINDEX 1 1 1.500000 2.500000 3.500000 0 a.ngc 100.000000 100.000000 1\r\n");
    EXPECT_EQ(say("get prioritybyindex 0"), "PRIORITYBYINDEX 0 1\r\n");
    EXPECT_EQ(say("set prioritybyid 1 9"), "SET PRIORITYBYID ACK\n\r");
    EXPECT_EQ(say("get prioritybyid 1"), "PRIORITYBYID 1 9\r\n");
    EXPECT_EQ(say("set deletebyindex 0"), "SET DELETEBYINDEX ACK\n\r");
    EXPECT_EQ(say("quit"), "");
    EXPECT_TRUE(session->isOver());
}

TEST_F(ScheduleTest, WhatIsRefusedSaysWhy) {
    EXPECT_EQ(say("set qmode run"), "SET NAK\r\n") << "before HELLO";
    say("hello EMC me 1");
    say("set echo off");
    EXPECT_EQ(say("set qmode run"), "SET QMODE NAK\n\r") << "before SET ENABLE";
    EXPECT_EQ(say("set enable wrong"), "SET ENABLE NAK\n\r");
    EXPECT_EQ(say("get pgmbyid 9"), "GET PGMBYID NAK\r\n\r\n");
    greet();
    EXPECT_EQ(say("set pgmadd 3"), "error: PGMADD needs 10 words, here are 1\r\nSET PGMADD NAK\n\r");
    EXPECT_EQ(say("get nonsense"), "error: Unknown question 'NONSENSE'\r\nGET NONSENSE NAK\r\n\r\n");
    EXPECT_EQ(say("set pollrate 0"),
              "error: Invalid rate '0', valid: 0.01 to 3600 s\r\nSET POLLRATE NAK\n\r");
    EXPECT_EQ(say(std::string(5000, 'x')), "error: the line has more than 4096 bytes\r\nSET LINE NAK\n\r");
}

TEST_F(ScheduleTest, ProgramsRunInTheirOrderWithWhatTheyAsk) {
    greet();
    say("set pgmadd 2 7 0 0 0 3 /q/b.ngc 50 80 0");
    say("set pgmadd 1 8 1 2 3 0 a.ngc 100 100 4");
    EXPECT_EQ(say("set qmode run"), "SET QMODE ACK\n\r");
    cycles(60);
    EXPECT_EQ(say("get qmode"), "QMODE STOP\r\n");
    EXPECT_EQ(say("get qstatus"), "QSTATUS 0 0 0 0\r\n");
    const auto first = asked.find("T4 M6"), origin = asked.find("G54 G52 X1.000000 Y2.000000 Z3.000000"),
               a = asked.find("/p/a.ngc"), zone = asked.find("G56 G52 X0 Y0 Z0"), b = asked.find("/q/b.ngc");
    ASSERT_NE(b, std::string::npos) << asked;
    EXPECT_TRUE(first < origin && origin < a && a < zone && zone < b) << asked;
}

TEST_F(ScheduleTest, NothingFollowsAProgramThatFailed) {
    greet();
    say("set pgmadd 1 7 0 0 0 1 a.ngc 100 100 0");
    say("set pgmadd 2 8 0 0 0 1 b.ngc 100 100 0");
    refused = "a.ngc";
    say("set qmode run");
    cycles(60);
    EXPECT_EQ(say("get qmode"), "QMODE ERROR\r\n");
    EXPECT_EQ(say("get error"), "ERROR program 7: no\r\n");
    EXPECT_EQ(asked.find("b.ngc"), std::string::npos) << asked;
    EXPECT_EQ(scheduler->queue().jobs().size(), 2U) << "both are still there";
}

TEST_F(ScheduleTest, StopAbortsWhatRunsAndKeepsIt) {
    greet();
    is_running = true;
    say("set pgmadd 1 7 0 0 0 1 a.ngc 100 100 0");
    say("set qmode run");
    cycles(30);
    ASSERT_NE(running, 0U);
    EXPECT_EQ(say("set deletebyid 7"),
              "error: this program runs: stop the queue first\r\nSET DELETEBYID NAK\n\r");
    EXPECT_EQ(say("set qmode pause"), "SET QMODE ACK\n\r");
    EXPECT_EQ(say("get qmode"), "QMODE PAUSE\r\n");
    EXPECT_EQ(say("set qmode resume"), "SET QMODE ACK\n\r");
    EXPECT_NE(asked.find("PauseProgram"), std::string::npos);
    say("set qmode stop");
    cycles(3);
    EXPECT_NE(asked.find("AbortAll"), std::string::npos) << asked;
    EXPECT_EQ(say("get qmode"), "QMODE STOP\r\n");
    EXPECT_EQ(scheduler->queue().jobs().size(), 1U);
    cycles(2000);
    EXPECT_EQ(asked.find("RunProgram", asked.find("AbortAll")), std::string::npos)
        << "nothing begins by itself after a stop";
}

TEST_F(ScheduleTest, AMachineThatIsNotReadyIsSaid) {
    greet();
    say("set pgmadd 1 7 0 0 0 1 a.ngc 100 100 0");
    status->task.state = messages::State::ESTOP;
    cycle();
    EXPECT_EQ(say("set qmode run"), "error: the machine is not on\r\nSET QMODE NAK\n\r");
    EXPECT_EQ(say("get qmode"), "QMODE STOP\r\n");
}

}  // namespace
}  // namespace mw::schedule
