// SPDX-License-Identifier: GPL-2.0-or-later
// Clients and task's side of the mailbox on one segment, in one process.
#include <gtest/gtest.h>

#include "messages/client/client.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::client {
namespace {

using mailbox::CommandServer;
using messages::Progress;

constexpr std::int64_t S = 1000000000;

/// A task with the results that the test sets.
class ClientTest : public testing::Test {
  protected:
    Client made(Role role = Role::OPERATOR) {
        auto client = Client::join(memory.segment(), role);
        EXPECT_TRUE(client.has_value());
        return std::move(*client);
    }
    /// Runs one cycle; each delivery is DONE unless the test keeps it.
    std::vector<CommandServer::Delivery> cycle() {
        now_ns += S / 1000;
        auto taken = desk.take(now_ns);
        for (const auto &delivery : taken) {
            if (!keeping) {
                desk.tell(delivery.serial, Progress::DONE, "");
            }
        }
        desk.publish(*status);
        return taken;
    }

    mailbox::Memory memory = mailbox::Memory::in_process();
    CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    bool keeping = false;
};

TEST_F(ClientTest, CommandsOfAllClientsComeInTheOrderOfOneCount) {
    Client a = made(), b = made();
    EXPECT_NE(a.id(), b.id());
    EXPECT_EQ(*a.post(messages::Mdi{"a1"}), 1U);
    EXPECT_EQ(*b.post(messages::Mdi{"b1"}), 2U);
    EXPECT_EQ(*a.post(messages::Mdi{"a2"}), 3U);
    const auto taken = cycle();
    ASSERT_EQ(taken.size(), 3U);
    EXPECT_EQ(std::get<messages::Mdi>(taken[1].command).line, "b1");
    EXPECT_EQ(taken[1].client, b.id());
    EXPECT_EQ(taken[2].serial, 3U);
    EXPECT_TRUE(cycle().empty());
}

TEST_F(ClientTest, EachCommandEndsWithItsOutcomeAndReason) {
    Client a = made();
    keeping = true;
    const auto first = *a.post(messages::RunProgram{}), second = *a.post(messages::PauseProgram{});
    EXPECT_EQ(a.outcome(first).progress, Progress::STARTED) << "not taken yet";
    cycle();
    EXPECT_EQ(a.outcome(first).progress, Progress::STARTED);
    desk.tell(second, Progress::REFUSED, "no program is running");
    EXPECT_EQ(a.outcome(first).progress, Progress::STARTED);
    EXPECT_EQ(a.outcome(second).progress, Progress::REFUSED);
    EXPECT_EQ(a.outcome(second).reason, "no program is running");
    desk.tell(first, Progress::FAILED, "emergency stop");
    desk.tell(first, Progress::DONE, "");
    EXPECT_EQ(a.outcome(first).progress, Progress::FAILED) << "an end is final";
}

TEST_F(ClientTest, WhatAnAttendedClientHasBegunIsAbortedWhenItLeavesAndNothingElse) {
    const auto aborts = [this] {
        const auto taken = cycle();
        return std::count_if(taken.begin(), taken.end(), [](const CommandServer::Delivery &d) {
            return std::holds_alternative<messages::AbortAll>(d.command) && d.serial > 0;
        });
    };
    keeping = true;
    for (const Role role : {Role::ATTENDED, Role::OPERATOR, Role::PANEL}) {
        std::optional<Client> client = made(role);
        ASSERT_TRUE(client->post(messages::RunProgram{}).has_value());
        EXPECT_EQ(aborts(), 0);
        client.reset();
        EXPECT_EQ(aborts(), role == Role::ATTENDED ? 1 : 0);
        EXPECT_EQ(aborts(), 0) << "once";
    }
    std::optional<Client> watcher = made(Role::ATTENDED);
    const auto run = *watcher->post(messages::RunProgram{});
    cycle();
    desk.tell(run, Progress::DONE, "");
    watcher.reset();
    EXPECT_EQ(aborts(), 0) << "its program has ended; another's may run";
}

TEST_F(ClientTest, TheStopForAnAttendedClientComesAfterWhatItPostedLast) {
    std::optional<Client> client = made(Role::ATTENDED);
    keeping = true;
    ASSERT_TRUE(client->post(messages::RunProgram{}).has_value());
    client.reset();
    const auto taken = cycle();
    ASSERT_EQ(taken.size(), 2U);
    EXPECT_TRUE(std::holds_alternative<messages::RunProgram>(taken[0].command));
    EXPECT_TRUE(std::holds_alternative<messages::AbortAll>(taken[1].command));
}

TEST_F(ClientTest, AMachineSaysWhatItIs) {
    Client client = made();
    EXPECT_TRUE(client.identity().ini.empty()) << "not ready yet";
    memory.segment().identity.write({messages::FixedText<1023>("/m/mill.ini"), true});
    EXPECT_EQ(client.identity().ini, "/m/mill.ini");
    EXPECT_TRUE(client.identity().isLasting);
    EXPECT_TRUE(client.isMachineAlive());
}

TEST_F(ClientTest, ACommandUnderWayIsRememberedHoweverManyComeAfterIt) {
    Client a = made(), b = made();
    keeping = true;
    const auto run = *a.post(messages::RunProgram{});
    const auto early = *a.post(messages::Null{});
    cycle();
    desk.tell(early, Progress::DONE, "");
    keeping = false;
    for (int i = 0; i < 300; ++i) {
        ASSERT_TRUE(a.post(messages::Null{}).has_value());
        ASSERT_TRUE(b.post(messages::Null{}).has_value());
        cycle();
    }
    EXPECT_EQ(a.outcome(run).progress, Progress::STARTED);
    desk.tell(run, Progress::DONE, "");
    EXPECT_EQ(a.outcome(run).progress, Progress::DONE);
    EXPECT_EQ(a.outcome(early).progress, Progress::REFUSED);
    EXPECT_NE(a.outcome(early).reason.find("no longer stored"), std::string::npos);
}

TEST_F(ClientTest, AStopIsTakenHoweverManyCommandsAreUnderWay) {
    Client a = made();
    keeping = true;
    for (int i = 0; i < mailbox::MAX_OUTCOMES; ++i) {
        ASSERT_TRUE(a.post(messages::Null{}).has_value());
        ASSERT_EQ(cycle().size(), 1U);
    }
    ASSERT_TRUE(a.post(messages::Null{}).has_value());
    EXPECT_TRUE(cycle().empty()) << "no slot is left for its outcome";
    ASSERT_TRUE(a.post(messages::AbortAll{}).has_value());
    const auto taken = cycle();
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<messages::AbortAll>(taken[0].command));
}

TEST_F(ClientTest, AStopCanBePostedThoughTheQueueOfItsClientIsFull) {
    Client a = made(), b = made();
    for (std::uint32_t i = 0; i < mailbox::MAX_POSTED; ++i) {
        ASSERT_TRUE(a.post(messages::JogContinuous{true, 1, 5}).has_value());
    }
    ASSERT_FALSE(a.post(messages::JogContinuous{true, 1, 5}).has_value()) << "the queue is full";
    const std::vector<messages::Command> stops = {
        messages::JogStop{true, 1}, messages::PauseProgram{}, messages::AbortAll{},
        messages::SetState{messages::State::OFF}, messages::SetState{messages::State::ESTOP}};
    std::vector<Serial> serials;
    for (const messages::Command &stop : stops) {
        const auto posted = a.post(stop);
        ASSERT_TRUE(posted.has_value()) << posted.error().str();
        EXPECT_EQ(a.outcome(*posted).progress, Progress::STARTED);
        serials.push_back(*posted);
    }
    const auto after = b.post(messages::Null{});
    const auto taken = cycle();
    ASSERT_EQ(taken.size(), mailbox::MAX_POSTED + stops.size() + 1);
    for (std::size_t i = 0; i < stops.size(); ++i) {
        EXPECT_EQ(taken[mailbox::MAX_POSTED + i].serial, serials[i]) << "after what was posted before it";
        EXPECT_EQ(taken[mailbox::MAX_POSTED + i].command.index(), stops[i].index());
        EXPECT_EQ(a.outcome(serials[i]).progress, Progress::DONE);
    }
    EXPECT_EQ(taken.back().serial, *after);
    EXPECT_TRUE(cycle().empty()) << "each once";
}

TEST_F(ClientTest, AFloodOfStopsIsTakenAndEachHasItsOutcome) {
    Client a = made();
    std::vector<Serial> aborts;
    for (int i = 0; i < 60; ++i) {
        const auto abort = a.post(messages::AbortAll{}), stop = a.post(messages::JogStop{false, i % 9});
        ASSERT_TRUE(abort.has_value() && stop.has_value());
        aborts.push_back(*abort);
    }
    EXPECT_EQ(a.outcome(aborts[30]).progress, Progress::STARTED);
    const auto taken = cycle();
    EXPECT_GE(
        std::count_if(taken.begin(), taken.end(),
                      [](const auto &d) { return std::holds_alternative<messages::AbortAll>(d.command); }),
        1);
    EXPECT_GE(taken.back().serial, aborts.back()) << "the last stop counts";
    // The last MAX_OUTCOMES outcomes of all commands are stored; half of them were aborts.
    for (std::size_t i = aborts.size() - mailbox::MAX_OUTCOMES / 2; i < aborts.size(); ++i) {
        EXPECT_EQ(a.outcome(aborts[i]).progress, Progress::DONE) << i;
    }
}

TEST_F(ClientTest, AStopOfAClientThatLeavesIsTakenAndItsPlaceIsClean) {
    {
        Client a = made();
        for (std::uint32_t i = 0; i < mailbox::MAX_POSTED; ++i) {
            ASSERT_TRUE(a.post(messages::Null{}).has_value());
        }
        ASSERT_TRUE(a.post(messages::AbortAll{}).has_value());
    }
    const auto taken = cycle();
    ASSERT_EQ(taken.size(), mailbox::MAX_POSTED + 1);
    EXPECT_TRUE(std::holds_alternative<messages::AbortAll>(taken.back().command));
    Client next = made();
    EXPECT_TRUE(cycle().empty());
}

TEST_F(ClientTest, WhatTheDeskRefusesIsTheLastCommandOfTheStatusToo) {
    Client a = made(), b = made();
    ASSERT_TRUE(a.post(messages::ClaimOperation{1}).has_value());
    cycle();
    const auto refused = *b.post(messages::RunProgram{});
    cycle();
    EXPECT_EQ(status->last_command, refused);
    EXPECT_EQ(status->last_progress, Progress::REFUSED);
    keeping = true;
    const auto kept = *a.post(messages::RunProgram{}), last = *a.post(messages::Null{});
    cycle();
    EXPECT_EQ(status->last_command, last);
    EXPECT_EQ(status->last_progress, Progress::STARTED);
    desk.tell(kept, Progress::FAILED, "");
    desk.tell(last, Progress::DONE, "");
    cycle();
    EXPECT_EQ(status->last_command, last);
    EXPECT_EQ(status->last_progress, Progress::DONE);
}

TEST_F(ClientTest, WhatIsOutOfRangeOrTooMuchIsRefusedWhereItIsPosted) {
    Client a = made();
    EXPECT_EQ(a.post(messages::JogStop{true, 99}).error().message,
              "JogStop: index is 99, allowed is 0 to 15");
    for (std::uint32_t i = 0; i < mailbox::MAX_POSTED; ++i) {
        ASSERT_TRUE(a.post(messages::Null{}).has_value());
    }
    EXPECT_FALSE(a.post(messages::Null{}).has_value());
    EXPECT_EQ(cycle().size(), mailbox::MAX_POSTED);
    EXPECT_TRUE(a.post(messages::Mdi{std::string(messages::MAX_TEXT, 'x')}).has_value());
}

TEST_F(ClientTest, BytesThatAreNoCommandAreRefusedAndHurtNobody) {
    Client a = made(), b = made();
    mailbox::Slot &slot = memory.segment().slots[mailbox::RESERVED_CLIENTS];
    mailbox::Posted bad;
    bad.serial = memory.segment().serials.fetch_add(1) + 1;
    bad.size = 0xffffffff;
    bad.bytes.fill('x');
    slot.posted.push(bad);
    bad.serial = 1000000;
    slot.posted.push(bad);
    const auto good = *b.post(messages::Null{});
    EXPECT_EQ(cycle().size(), 1U);
    EXPECT_EQ(b.outcome(good).progress, Progress::DONE);
    EXPECT_EQ(a.outcome(1).progress, Progress::REFUSED);
    EXPECT_NE(a.outcome(1).reason.find("no message of Millwright"), std::string::npos);
}

TEST_F(ClientTest, OneClientOperatesAloneAndAPanelStillWorks) {
    Client a = made(), b = made(), halui = made(Role::PANEL);
    const auto claim = *a.post(messages::ClaimOperation{1});
    EXPECT_TRUE(cycle().empty());
    EXPECT_EQ(a.outcome(claim).progress, Progress::DONE);
    ASSERT_TRUE(b.read_status().has_value());
    EXPECT_EQ(b.status().operation.holder, a.id());
    const auto refused = *b.post(messages::RunProgram{});
    ASSERT_TRUE(b.post(messages::AbortAll{}).has_value());
    ASSERT_TRUE(halui.post(messages::ResumeProgram{}).has_value());
    EXPECT_EQ(cycle().size(), 2U);
    EXPECT_EQ(b.outcome(refused).progress, Progress::REFUSED);
    EXPECT_NE(b.outcome(refused).reason.find("operates the machine alone"), std::string::npos);
    const auto given = *a.post(messages::HandOverOperation{b.id()});
    cycle();
    EXPECT_EQ(a.outcome(given).progress, Progress::DONE);
    ASSERT_TRUE(b.post(messages::RunProgram{}).has_value());
    EXPECT_EQ(cycle().size(), 1U);
    const auto nobody = *b.post(messages::HandOverOperation{4711});
    cycle();
    EXPECT_EQ(b.outcome(nobody).progress, Progress::REFUSED);
    now_ns += 2 * S;
    ASSERT_TRUE(a.post(messages::RunProgram{}).has_value());
    EXPECT_EQ(cycle().size(), 1U) << "not renewed: open to all again";
}

TEST_F(ClientTest, AClientThatLeavesGivesItsPlaceAndRightBack) {
    Client b = made();
    for (int i = 0; i < 3 * mailbox::MAX_CLIENTS; ++i) {
        Client a = made();
        ASSERT_TRUE(a.post(messages::ClaimOperation{60}).has_value());
        ASSERT_TRUE(a.post(messages::Null{}).has_value());
        const auto other = std::move(a);
        EXPECT_EQ(cycle().size(), 1U);
    }
    cycle();
    ASSERT_TRUE(b.post(messages::RunProgram{}).has_value());
    EXPECT_EQ(cycle().size(), 1U);
    std::vector<Client> many;
    for (int i = 1; i < mailbox::MAX_CLIENTS - mailbox::RESERVED_CLIENTS; ++i) {
        many.push_back(made());
    }
    EXPECT_FALSE(Client::join(memory.segment()).has_value());
    for (int i = 0; i < mailbox::RESERVED_CLIENTS; ++i) {  // servers of screens still find free slots
        auto one = Client::join(memory.segment(), Role::OPERATOR, Places::RESERVED);
        ASSERT_TRUE(one.has_value());
        ASSERT_TRUE(one->post(messages::AbortAll{}).has_value());
        EXPECT_EQ(cycle().size(), 1U);
        many.push_back(std::move(*one));
    }
    EXPECT_FALSE(Client::join(memory.segment(), Role::OPERATOR, Places::RESERVED).has_value());
}

TEST_F(ClientTest, ANewReaderGetsWhatNobodyHasReadAndThenAll) {
    desk.post(messages::MessageKind::OPERATOR_TEXT, "before anybody");
    Client a = made(), b = made();
    ASSERT_EQ(a.next_message()->text, "before anybody");
    ASSERT_EQ(b.next_message()->text, "before anybody") << "b was there before a read it";
    Client c = made();
    EXPECT_FALSE(c.next_message().has_value()) << "it had been read when c came";
    desk.post(messages::MessageKind::OPERATOR_ERROR, "an error");
    for (Client *client : {&a, &b, &c}) {
        const auto message = client->next_message();
        ASSERT_TRUE(message.has_value());
        EXPECT_EQ(message->number, 2U);
        EXPECT_EQ(message->kind, messages::MessageKind::OPERATOR_ERROR);
        EXPECT_FALSE(client->next_message().has_value());
    }
}

TEST_F(ClientTest, AReaderMayReadTheLastMessagesAgain) {
    Client a = made(), b = made();
    for (int i = 1; i <= 2 * mailbox::MAX_MESSAGES; ++i) {
        desk.post(messages::MessageKind::OPERATOR_TEXT, std::to_string(i));
        static_cast<void>(a.next_message());
    }
    for (const std::uint64_t most : {std::uint64_t{3}, std::uint64_t{mailbox::MAX_MESSAGES}, UINT64_MAX}) {
        const std::uint64_t count = std::min<std::uint64_t>(most, mailbox::MAX_MESSAGES);
        b.rewind_messages(most);
        std::int64_t at_ns = 0;
        for (std::uint64_t n = 1; n <= count; ++n) {
            const auto message = b.next_message();
            ASSERT_TRUE(message.has_value());
            EXPECT_EQ(message->number, 2 * mailbox::MAX_MESSAGES - count + n);
            EXPECT_EQ(message->text, std::to_string(message->number));
            EXPECT_GT(message->at_ns, 0);
            EXPECT_GE(message->at_ns, at_ns);
            at_ns = message->at_ns;
        }
        EXPECT_FALSE(b.next_message().has_value());
    }
    EXPECT_FALSE(made().next_message().has_value()) << "another reader gets only unread messages";
}

TEST_F(ClientTest, EachStartOfTheMachineHasItsOwnNumber) {
    Client a = made();
    EXPECT_NE(a.run(), 0U);
    auto other = mailbox::Memory::in_process();
    const mailbox::CommandServer other_desk(other.segment());
    EXPECT_NE(client::Viewer(other.segment()).run(), a.run());
}

TEST_F(ClientTest, LostMessagesAreCounted) {
    Client a = made();
    const int many = 3 * mailbox::MAX_MESSAGES;
    for (int i = 1; i <= many; ++i) {
        desk.post(messages::MessageKind::OPERATOR_TEXT, "m" + std::to_string(i));
    }
    const auto told = a.next_message();
    ASSERT_TRUE(told.has_value());
    int read = 0;
    std::string last;
    while (const auto message = a.next_message()) {
        ++read;
        last = message->text;
    }
    EXPECT_EQ(told->text,
              std::to_string(many - read) + " messages were lost: they came faster than this client read");
    EXPECT_EQ(last, "m" + std::to_string(many));
    EXPECT_GE(read, mailbox::MAX_MESSAGES - 1);
}

TEST_F(ClientTest, ALongTextSaysThatItGoesOn) {
    Client a = made();
    desk.post(messages::MessageKind::OPERATOR_ERROR, std::string(5000, 'x'));
    const std::string text = a.next_message()->text;
    EXPECT_EQ(text.size(), 1023U);
    EXPECT_EQ(text.substr(1020), "...");
}

TEST_F(ClientTest, TheStatusIsThatOfTheLastCycleAndTheToolTableComesWhenItChanges) {
    Client a = made();
    const messages::MachineStatus &seen = a.status();
    EXPECT_FALSE(a.read_status().has_value()) << "before the first cycle";
    status->task.read_line = 7;
    status->joints[2].isPresent = true;
    cycle();
    ASSERT_TRUE(a.read_status().has_value());
    EXPECT_EQ(seen.task.read_line, 7);
    EXPECT_TRUE(seen.joints[2].isPresent);
    EXPECT_FALSE(a.read_tools()->has_value());
    ASSERT_TRUE(desk.publish_tools({4, {{1, 2, {}, 3, 0, 0, 0, "drill"}}}));
    const auto tools = a.read_tools();
    ASSERT_TRUE(tools.has_value() && tools->has_value());
    EXPECT_EQ((*tools)->tools[0].comment, "drill");
    EXPECT_FALSE(a.read_tools()->has_value());
    messages::ToolTable huge{5, {}};
    huge.tools.resize(2000);
    huge.tools[0].comment.assign(600000, 'x');
    EXPECT_FALSE(desk.publish_tools(huge));
}

}  // namespace
}  // namespace mw::client
