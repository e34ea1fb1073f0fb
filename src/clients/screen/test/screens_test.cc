// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the protocol of /api/socket, with a task and a server controlled by the test (J3).
#include <deque>

#include <gtest/gtest.h>

#include "clients/screen/test/screens_rig.hh"

namespace mw::screen {
namespace {

using test::Json;

using test::MS;
using test::ScreensTest;

TEST_F(ScreensTest, AScreenIsGreetedThenToldTheWholeThenChanges) {
    task.status->joints[1].pos_cmd = 3;
    go(300);
    screens->opened(7, {Role::OPERATE, Protection::LOCAL}, now_ns);
    const auto first = sockets.take(7);
    ASSERT_EQ(first.size(), 2U);
    EXPECT_EQ(first[0]["hello"]["version"], "0.1");
    EXPECT_EQ(first[0]["hello"]["role"], "operate");
    EXPECT_GT(first[0]["hello"]["client"], 0);
    EXPECT_EQ(first[1]["full"], true);
    EXPECT_EQ(first[1]["status"]["joints"][1]["pos_cmd"], 3);
    task.status->joints[1].pos_cmd = 4;
    go(50);
    const auto later = of_kind(7, "status");
    ASSERT_EQ(later.size(), 1U);
    EXPECT_EQ(later[0]["status"]["joints"], Json::parse(R"({"1":{"pos_cmd":4.0}})"));
    EXPECT_FALSE(later[0].contains("full"));
}

TEST_F(ScreensTest, EachScreenIsToldThatTaskIsSilentAndThatItIsBack) {
    go(300);
    open(1);
    open(2);
    go(2000);
    EXPECT_TRUE(of_kind(1, "silent").empty());
    const auto wait = [this](std::int64_t ms) {  // without a cycle of task
        for (const std::int64_t end = now_ns + ms * MS; now_ns < end;) {
            now_ns += 10 * MS;
            screens->tick(now_ns);
        }
    };
    of_kind(2, "silent");
    wait(450);
    EXPECT_TRUE(of_kind(1, "silent").empty());
    wait(200);
    for (const SessionId session : {1, 2}) {
        const auto told = of_kind(session, "silent");
        ASSERT_EQ(told.size(), 1U);
        EXPECT_GE(told[0]["silent"], 0.5);
    }
    wait(1000);
    EXPECT_GE(of_kind(1, "silent").size(), 1U);
    go(100);
    const auto back = of_kind(1, "silent");
    ASSERT_EQ(back.size(), 1U);
    EXPECT_EQ(back[0]["silent"], 0);
}

TEST_F(ScreensTest, ASlowScreenGetsFewerAndTheNewest) {
    go(300);
    open(1);
    open(2);
    sockets.busy[1] = true;
    for (int i = 1; i <= 10; ++i) {
        task.status->joints[0].pos_cmd = i;
        go(50);
    }
    EXPECT_TRUE(sockets.take(1).empty());
    EXPECT_GE(of_kind(2, "status").size(), 9U);
    sockets.busy[1] = false;
    go(50);
    const auto told = of_kind(1, "status");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0]["status"]["joints"]["0"]["pos_cmd"], 10);
}

TEST_F(ScreensTest, EachCommandHasItsOutcome) {
    go(300);
    open(1);
    command(1, 7, "SetState", R"("state":"ESTOP_RESET")");
    EXPECT_EQ(go(100).size(), 1U);
    auto outcomes = of_kind(1, "outcome");
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_EQ(outcomes[0]["outcome"], Json::parse(R"({"id":7,"progress":"DONE"})"));

    task.keeping = true;
    command(1, 8, "HomeJoint", R"("joint":-1)");
    const auto taken = go(200);
    ASSERT_EQ(taken.size(), 1U);
    outcomes = of_kind(1, "outcome");
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_EQ(outcomes[0]["outcome"], Json::parse(R"({"id":8,"progress":"STARTED"})"));
    task.desk.tell(taken[0].serial, messages::Progress::FAILED, "no switch");
    go(10);
    outcomes = of_kind(1, "outcome");
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_EQ(outcomes[0]["outcome"], Json::parse(R"({"id":8,"progress":"FAILED","reason":"no switch"})"));
}

TEST_F(ScreensTest, ACommandIsDoneBehindAStatusThatShowsItsEffect) {
    go(300);
    open(1);
    for (int n = 1; n <= 7; ++n) {
        command(1, n, "SetState", R"("state":"ESTOP_RESET")");
        go(10);
        task.status->joints[0].pos_cmd = n;  // the effect, in the cycle after the outcome
        go(20);                              // not the time of the next status for all
        bool is_shown = false, is_done = false;
        for (const Json &one : sockets.take(1)) {
            const Json joints = one.value("status", Json::object()).value("joints", Json::object());
            is_shown = is_shown || (joints.contains("0") && joints["0"]["pos_cmd"] == n);
            if (one.contains("outcome")) {
                is_done = true;
                EXPECT_TRUE(is_shown) << n;
            }
        }
        EXPECT_TRUE(is_done) << n;
        go(70 + 10 * n);  // a different time before the next status
    }
}

TEST_F(ScreensTest, AStopIsDoneWithoutAStatus) {
    go(300);
    open(1);
    sockets.busy[1] = true;
    command(1, 1, "AbortAll");
    go(10);
    const auto outcomes = of_kind(1, "outcome");
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_EQ(outcomes[0]["outcome"]["progress"], "DONE");
}

TEST_F(ScreensTest, WhatIsNoCommandIsRefusedWithAReason) {
    go(300);
    open(1);
    command(1, 1, "NoSuchThing");
    command(1, 2, "JogStop", R"("is_joint":1,"index":0)");
    command(1, 3, "SetFeedOverride", R"("factor":-5.0)");
    for (const Json &one : of_kind(1, "outcome")) {
        EXPECT_EQ(one["outcome"]["progress"], "REFUSED");
        EXPECT_FALSE(one["outcome"]["reason"].get<std::string>().empty());
    }
    for (const char *text : {"", "{", "[]", "{}", R"({"id":-1,"command":{}})", R"({"id":1.5,"command":{}})",
                             R"({"id":1})", R"({"command":{}})", R"({"ping":"x"})", "null"}) {
        say(1, text);
        const auto said = of_kind(1, "error");
        EXPECT_EQ(said.size(), 1U) << text;
    }
    say(1, std::string(60000, '[') + std::string(4000, ']'));
    say(1, R"({"id":9,"command":)" + std::string(30000, '[') + std::string(30000, ']') + "}");
    EXPECT_EQ(of_kind(1, "error").size(), 2U);
    EXPECT_TRUE(go(20).empty());
}

TEST_F(ScreensTest, APingIsAnsweredAndSilenceEnds) {
    go(300);
    open(1);
    open(2);
    for (int i = 0; i < 11; ++i) {
        say(1, R"({"ping":12.5})");
        const auto pongs = of_kind(1, "pong");
        ASSERT_EQ(pongs.size(), 1U);
        EXPECT_EQ(pongs[0]["pong"], 12.5);
        EXPECT_EQ(std::ranges::count(sockets.closed, SessionId{2}), 0);
        go(500);
    }
    EXPECT_EQ(std::ranges::count(sockets.closed, SessionId{1}), 0);
    EXPECT_GE(std::ranges::count(sockets.closed, SessionId{2}), 1);
}

TEST_F(ScreensTest, WhatAConnectionJogsStopsWithIt) {
    go(300);
    open(1);
    open(2);
    const std::string jog = R"(,"velocity":5.0,"distance":100.0)";
    command(1, 1, "JogIncrement", R"("is_joint":true,"index":0)" + jog);
    command(1, 2, "JogAbsolute", R"("is_joint":true,"index":1,"velocity":5.0,"position":1.0)");
    command(1, 3, "JogIncrement", R"("is_joint":false,"index":2)" + jog);
    command(1, 4, "JogStop", R"("is_joint":false,"index":2)");
    command(2, 1, "JogIncrement", R"("is_joint":true,"index":1)" + jog);
    EXPECT_EQ(go(20).size(), 5U);
    screens->closed(1);
    const auto stops = go(20);
    ASSERT_EQ(stops.size(), 1U);  // the other screen now jogs joint 1
    const auto *stop = std::get_if<messages::JogStop>(&stops[0].command);
    ASSERT_NE(stop, nullptr);
    EXPECT_TRUE(stop->isJoint);
    EXPECT_EQ(stop->index, 0);
    screens.reset();
    EXPECT_EQ(task.cycle().size(), 1U);
}

TEST_F(ScreensTest, AScreenOfAnotherUserSeesStatusAndStopsTheMachine) {
    go(300);
    screens->opened(7, {Role::STATUS, Protection::LOCAL}, now_ns);
    const auto first = sockets.take(7);
    ASSERT_EQ(first.size(), 3U);
    EXPECT_EQ(first[0]["hello"]["role"], "view");
    EXPECT_EQ(first[1]["note"], "status only");
    EXPECT_EQ(first[2]["full"], true);
    screens->received(7, R"({"watch": ["joint.0.pos-cmd"]})", now_ns);
    EXPECT_TRUE(screens->watched().empty()) << "values of HAL are not for it";
    command(7, 1, "SynchInterpreter");
    command(7, 2, "AbortAll");
    EXPECT_EQ(go(20).size(), 1U) << "the stop alone";
}

TEST_F(ScreensTest, AScreenWithoutAPlaceStopsTheMachine) {
    std::deque<client::Client> others;  // also before the server is started
    for (auto one = client::Client::join(task.memory.segment()); one.has_value();
         one = client::Client::join(task.memory.segment())) {
        others.push_back(std::move(*one));
    }
    go(300);
    screens->opened(7, {Role::VIEW, Protection::LOCAL}, now_ns);
    const auto first = sockets.take(7);
    ASSERT_EQ(first.size(), 3U);
    EXPECT_EQ(first[0]["hello"]["client"], 0);
    EXPECT_NE(first[1]["note"].get<std::string>().find("only stop"), std::string::npos);
    EXPECT_EQ(first[2]["full"], true) << "it sees the machine";
    command(7, 1, "SynchInterpreter");
    command(7, 2, "AbortAll");
    command(7, 3, "PauseProgram");
    EXPECT_EQ(go(100).size(), 2U);
    const auto outcomes = of_kind(7, "outcome");
    ASSERT_EQ(outcomes.size(), 3U);
    EXPECT_EQ(outcomes[0]["outcome"]["progress"], "REFUSED");
    EXPECT_NE(outcomes[0]["outcome"]["reason"].get<std::string>().find("only stop"), std::string::npos);
    EXPECT_EQ(outcomes[1]["outcome"]["progress"], "DONE");
    EXPECT_EQ(outcomes[2]["outcome"]["progress"], "DONE");
    others.pop_back();
    go(600);
    const auto up = of_kind(7, "machine");
    ASSERT_EQ(up.size(), 1U) << "it has a place now";
    EXPECT_GT(up[0]["client"], 0);
    is_up = false;
}

TEST_F(ScreensTest, AJogThatNothingWouldEndIsRefused) {
    go(300);
    open(1);
    command(1, 1, "JogContinuous", R"("is_joint":true,"index":0,"velocity":5.0)");
    EXPECT_TRUE(go(20).empty());
    const auto outcomes = of_kind(1, "outcome");
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_EQ(outcomes[0]["outcome"]["progress"], "REFUSED");
    EXPECT_NE(outcomes[0]["outcome"]["reason"].get<std::string>().find("lease"), std::string::npos);
    screens->closed(1);
    EXPECT_TRUE(go(20).empty());  // it has no jog
}

TEST_F(ScreensTest, StopsAreNeverLimited) {
    go(300);
    open(1);
    for (int i = 0; i < 1000; ++i) {
        command(1, i, "SetFeedOverride", R"("factor":1.0)");
    }
    EXPECT_GT(of_kind(1, "outcome").size(), 900U);  // rejected
    for (int i = 0; i < 200; ++i) {
        command(1, 2000 + i, "AbortAll");
        command(1, 3000 + i, "SetState", R"("state":"ESTOP")");
    }
    bool aborted = false, estop = false;
    for (const auto &one : task.cycle()) {
        aborted = aborted || std::holds_alternative<messages::AbortAll>(one.command);
        const auto *state = std::get_if<messages::SetState>(&one.command);
        estop = estop || (state != nullptr && state->state == messages::State::ESTOP);
    }
    EXPECT_TRUE(aborted);
    EXPECT_TRUE(estop);
    for (const Json &one : of_kind(1, "outcome")) {
        EXPECT_NE(one["outcome"]["progress"], "REFUSED") << one;
    }
}

TEST_F(ScreensTest, MessagesGoToAllAndToWhoComesLater) {
    go(300);
    open(1);
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "tool \"4\" is missing");
    go(50);
    const auto told = of_kind(1, "message");
    ASSERT_EQ(told.size(), 1U);
    auto expected = Json::parse(R"({"number":1,"kind":"OPERATOR_ERROR","text":"tool \"4\" is missing"})");
    expected["run"] = told[0]["message"]["run"];
    EXPECT_EQ(told[0]["message"], expected);
    screens->opened(2, {Role::OPERATE, Protection::LOCAL}, now_ns);
    const auto later = of_kind(2, "message");
    ASSERT_EQ(later.size(), 1U);
    EXPECT_EQ(later[0]["message"], told[0]["message"]);
}

TEST_F(ScreensTest, AScreenThatConnectsLaterIsToldHowOldMessagesAre) {
    go(300);
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "joint 0 following error");
    go(50);
    screens->tell_note("the door is open");
    go(90000);
    screens->opened(2, {Role::OPERATE, Protection::LOCAL}, now_ns);
    int found = 0;
    for (const Json &one : sockets.take(2)) {
        if (one.contains("message") || one.contains("note")) {
            ++found;
            EXPECT_NEAR(one["age_ms"].get<double>(), 90000.0, 100.0) << one;
        }
    }
    EXPECT_EQ(found, 2);
}

TEST_F(ScreensTest, AServerThatIsStartedAgainShowsTheLastMessagesWithTheirTime) {
    client::Viewer other(task.memory.segment());  // a Python client
    const auto read_all = [&other] {
        while (other.next_message().has_value()) {
        }
    };
    go(300);
    open(1);
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "before");
    read_all();
    go(1000);
    const auto first = of_kind(1, "message");
    ASSERT_EQ(first.size(), 1U);
    start_again();
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "meanwhile");
    read_all();
    now_ns += 500 * MS;
    screens->opened(2, {Role::OPERATE, Protection::LOCAL}, now_ns);
    go(300);
    const auto told = of_kind(2, "message");
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0]["message"], first[0]["message"]) << "a screen knows it as the same message";
    EXPECT_EQ(told[1]["message"]["text"], "meanwhile");
    EXPECT_NEAR(told[0]["age_ms"].get<double>(), 2500, 300);
    EXPECT_NEAR(told[1]["age_ms"].get<double>(), 500, 300);
    EXPECT_FALSE(client::Viewer(task.memory.segment()).next_message().has_value())
        << "other clients get nothing that was read before";
}

TEST_F(ScreensTest, AServerThatIsStartedLateShowsTheLastHundredMessages) {
    client::Viewer other(task.memory.segment());
    for (int i = 1; i <= 150; ++i) {
        task.desk.post(messages::MessageKind::OPERATOR_TEXT, std::to_string(i));
        static_cast<void>(other.next_message());
    }
    go(300);
    screens->opened(1, {Role::OPERATE, Protection::LOCAL}, now_ns);
    const auto told = of_kind(1, "message");
    ASSERT_EQ(told.size(), 100U);
    EXPECT_EQ(told.front()["message"]["text"], "51");
    EXPECT_EQ(told.back()["message"]["text"], "150");
}

TEST_F(ScreensTest, EachMessageIsLoggedOnceAlsoByAServerThatIsStartedAgain) {
    std::vector<std::string> lines;
    const auto keep_log = [&] {
        screens->keep_log([&](const std::string &line, std::int64_t age_ns) {
            if (line.starts_with("ERROR")) {
                lines.push_back(line + " " + std::to_string((age_ns + 500 * MS) / (1000 * MS)) + " s");
            }
        });
    };
    keep_log();
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "before");
    go(100);
    start_again();
    keep_log();
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "meanwhile");
    static_cast<void>(client::Viewer(task.memory.segment()).next_message());
    now_ns += 5000 * MS;
    go(100);
    EXPECT_EQ(lines, (std::vector<std::string>{"ERROR: before 0 s", "ERROR: meanwhile 5 s"}));
}

TEST_F(ScreensTest, WhatOperatorsAreToldIsWrittenDown) {
    std::vector<std::string> lines;
    screens->keep_log([&](const std::string &line, std::int64_t) { lines.push_back(line); });
    go(300);  // without an open screen
    task.desk.post(messages::MessageKind::OPERATOR_ERROR, "tool 4 is missing");
    task.desk.post(messages::MessageKind::OPERATOR_TEXT, "done");
    go(50);
    screens->tell_note("a panel is missing");
    EXPECT_EQ(lines, (std::vector<std::string>{"the machine is running", "ERROR: tool 4 is missing",
                                               "TEXT: done", "NOTE: a panel is missing"}));
}

TEST_F(ScreensTest, WithoutAMachineAScreenIsToldAndCommandsAreRefused) {
    is_up = false;
    go(300);
    screens->opened(1, {Role::OPERATE, Protection::LOCAL}, now_ns);
    auto told = sockets.take(1);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0]["hello"]["client"], 0);
    EXPECT_EQ(told[1]["machine"], "gone");
    EXPECT_EQ(told[1]["reason"], "no machine here");
    command(1, 5, "AbortAll");
    told = sockets.take(1);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0]["outcome"]["progress"], "REFUSED");
    is_up = true;
    go(500);
    told = sockets.take(1);
    ASSERT_GE(told.size(), 2U);
    EXPECT_EQ(told[0]["machine"], "up");
    EXPECT_GT(told[0]["client"], 0);
    EXPECT_EQ(told[1]["full"], true);
}

TEST_F(ScreensTest, ALeaseCountsFromWhenItWasAskedFor) {
    go(10);
    open(1);
    double sent_ms = 5000;
    const auto lease = [&](int id, double late_ms, bool renewal) {
        now_ns += static_cast<std::int64_t>(late_ms * 1e6);
        say(1,
            R"({"id":)" + std::to_string(id) + R"(,"sent":)" + std::to_string(sent_ms) +
                R"(,"command":{"message":"JogContinuous","is_joint":false,"index":0,"velocity":5,"lease_ms":100)" +
                (renewal ? R"(,"is_renewal":true}})" : "}}"));
        now_ns += 30 * MS - static_cast<std::int64_t>(late_ms * 1e6);
        sent_ms += 30;
        for (const auto &delivery : task.cycle()) {
            if (const auto *jog = std::get_if<messages::JogContinuous>(&delivery.command)) {
                return jog->lease_ms;
            }
        }
        return 0;
    };
    EXPECT_EQ(lease(1, 0, false), 100);
    EXPECT_EQ(lease(2, 0, true), 100);
    EXPECT_NEAR(lease(3, 25, true), 75, 1);
    EXPECT_NEAR(lease(4, 79, true), 21, 1);
    EXPECT_EQ(lease(5, 85, true), 0) << "too little is left: it is rejected";
    EXPECT_EQ(lease(6, 0, true), 100);
    bool refused = false;
    for (const Json &one : sockets.take(1)) {
        refused |=
            one.contains("outcome") && one["outcome"]["id"] == 5 && one["outcome"]["progress"] == "REFUSED";
    }
    EXPECT_TRUE(refused);
}

TEST(Lateness, FollowsClocksThatDriftApart) {
    Lateness lateness;
    // The sender's clock loses 100 parts per million, for an hour.
    double worst_ms = 0;
    for (std::int64_t ms = 0; ms < 3600000; ms += 100) {
        worst_ms = std::max(worst_ms, lateness.of(static_cast<double>(ms) * 0.9999, ms * MS));
    }
    EXPECT_LT(worst_ms, 1.0);
    EXPECT_NEAR(lateness.of(3600000 * 0.9999, 3600050 * MS), 50, 1.0);
}

}  // namespace
}  // namespace mw::screen
