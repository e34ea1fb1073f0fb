// SPDX-License-Identifier: GPL-2.0-or-later
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "clients/nml/message/wire_table.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/status_list.hh"

namespace mw::nml {

/// A message that a program adds.
struct Greeting {
    std::string text;
};
struct Nameless {};
struct SecondMdi {};

}  // namespace mw::nml

namespace mw::messages {
template <>
inline constexpr auto DECLARED<nml::Greeting> =
    declare("Greeting", 4001, "says hello",
            field<&nml::Greeting::text>("text", "what is said", unit::NONE, range(0, 100)));
template <>
inline constexpr auto DECLARED<nml::Nameless> = declare("Nameless", 0, "has no number");
template <>
inline constexpr auto DECLARED<nml::SecondMdi> = declare("SecondMdi", 509, "has Mdi's number");
}  // namespace mw::messages

namespace mw::nml {
namespace {

TEST(NmlVocabulary, HasEveryDocumentedMessageWithItsNameAndNumber) {
    const Vocabulary vocabulary = Vocabulary::standard();
    std::ifstream list(MW_SOURCE_DIR "/src/clients/nml/message/test/legacy_messages.txt");
    std::string line;
    std::set<int> seen;
    while (std::getline(list, line)) {
        std::istringstream words(line);
        std::string name;
        int number = 0;
        if (line.starts_with('#') || !(words >> name >> number)) {
            continue;
        }
        const MessageKind *kind = vocabulary.find(number);
        ASSERT_NE(kind, nullptr) << line;
        EXPECT_EQ(kind->name(), name);
        EXPECT_EQ(vocabulary.find(std::string_view(name)), kind);
        EXPECT_EQ(vocabulary.find(std::string_view(kind->declaration->name)), kind);
        const bool is_status = name.ends_with("_STAT_TYPE");
        EXPECT_EQ(kind->base, is_status ? Base::STATUS : Base::COMMAND) << name;
        EXPECT_EQ(kind->convert == nullptr && kind->rejection == nullptr, is_status) << name;
        seen.insert(number);
    }
    EXPECT_EQ(seen.size(), 146U);
    for (const auto &[number, kind] : vocabulary.kinds()) {
        EXPECT_TRUE(seen.contains(number) || number >= messages::FIRST_OWN_NUMBER) << kind.name();
    }
}

TEST(NmlVocabulary, MessagesAreMadeWithTheHeadOfTheirClass) {
    const Vocabulary vocabulary = Vocabulary::standard();
    Message jog = *vocabulary.make(124), status = *vocabulary.make(1999);
    ASSERT_NE(jog.get<messages::JogContinuous>(), nullptr);
    EXPECT_EQ(jog.get<messages::Mdi>(), nullptr);
    ASSERT_NE(jog.command_head(), nullptr);
    EXPECT_EQ(jog.status_head(), nullptr);
    ASSERT_NE(status.status_head(), nullptr);
    EXPECT_EQ(status.status_head()->state, CommandState::UNKNOWN);
    EXPECT_EQ(vocabulary.make(4711).error().message, "there is no message 4711");
    EXPECT_EQ(vocabulary.find(""), nullptr);
}

TEST(NmlVocabulary, AProgramAddsAMessageByItsDeclarationAlone) {
    Vocabulary vocabulary = Vocabulary::standard();
    ASSERT_TRUE(vocabulary.add<Greeting>(Base::PLAIN).has_value());
    Message message = *vocabulary.make(4001);
    message.get<Greeting>()->text = "hello";
    EXPECT_EQ(message.command_head(), nullptr);
    EXPECT_STREQ(message.kind().name(), "Greeting");
    EXPECT_EQ(vocabulary.add<Greeting>(Base::PLAIN).error().message,
              "Greeting (4001) cannot be added: there is Greeting (4001)");
    EXPECT_EQ(vocabulary.add<Nameless>(Base::PLAIN).error().message,
              "Nameless has no number and cannot be a message");
    EXPECT_EQ(vocabulary.add<SecondMdi>(Base::PLAIN).error().message,
              "SecondMdi (509) cannot be added: there is Mdi (509)");
}

TEST(NmlVocabulary, NumbersOfCommandStatesAreThoseThatClientsCompare) {
    EXPECT_EQ(static_cast<int>(CommandState::DONE), 1);
    EXPECT_EQ(static_cast<int>(CommandState::EXECUTING), 2);
    EXPECT_EQ(static_cast<int>(CommandState::ERROR), 3);
}

std::string command_of(std::string_view name) {
    const Vocabulary vocabulary = Vocabulary::standard();
    const auto command = Message(*vocabulary.find(name)).command();
    return command.has_value() ? messages::to_text(*command) : command.error().message;
}

TEST(NmlVocabulary, OtherNamesAreTheSameCommandOfTheMachine) {
    EXPECT_EQ(command_of("EMC_TRAJ_ENABLE_TYPE"), "SetState state=ON");
    EXPECT_EQ(command_of("EMC_TRAJ_DISABLE_TYPE"), "SetState state=OFF");
    EXPECT_EQ(command_of("EMC_AUX_ESTOP_ON_TYPE"), "SetState state=ESTOP");
    EXPECT_EQ(command_of("EMC_AUX_ESTOP_OFF_TYPE"), "SetState state=ESTOP_RESET");
    EXPECT_EQ(command_of("EMC_AUX_ESTOP_RESET_TYPE"), "SetState state=ESTOP_RESET");
    EXPECT_EQ(command_of("EMC_TRAJ_PAUSE_TYPE"), "PauseProgram");
    EXPECT_EQ(command_of("EMC_TRAJ_STEP_TYPE"), "StepProgram");
    EXPECT_EQ(command_of("EMC_TRAJ_RESUME_TYPE"), "ResumeProgram");
    for (const char *name : {"EMC_TASK_ABORT_TYPE", "EMC_ABORT_TYPE", "EMC_TRAJ_ABORT_TYPE",
                             "EMC_MOTION_ABORT_TYPE", "EMC_TOOL_ABORT_TYPE", "EMC_IO_ABORT_TYPE"}) {
        EXPECT_EQ(command_of(name), "AbortAll") << name;
    }
}

TEST(NmlVocabulary, AnAbortOfAJointStopsItsJog) {
    const Vocabulary vocabulary = Vocabulary::standard();
    Message abort = *vocabulary.make(120);
    const messages::Object body = abort.view().body;
    ASSERT_EQ(body.declaration->fields.size(), 1U);
    *static_cast<int *>(body.declaration->fields[0].at(body.data)) = 3;
    const auto command = abort.command();
    ASSERT_TRUE(command.has_value());
    const auto *stop = std::get_if<messages::JogStop>(&*command);
    ASSERT_NE(stop, nullptr);
    EXPECT_TRUE(stop->isJoint);
    EXPECT_EQ(stop->index, 3);
}

TEST(NmlVocabulary, WhatTheMachineHasNoCommandForIsRejectedWithTheReason) {
    EXPECT_EQ(command_of("EMC_TRAJ_LINEAR_MOVE_TYPE"),
              "only programs contain this: send it as G-code, by Mdi");
    EXPECT_EQ(command_of("EMC_JOINT_SET_MAX_VELOCITY_TYPE"),
              "this is a setting of the INI file and cannot change while the machine runs");
    EXPECT_EQ(command_of("EMC_TASK_INIT_TYPE"), "the machine does this itself when it starts and ends");
    EXPECT_NE(command_of("EMC_EXEC_PLUGIN_CALL_TYPE").find("PYTHON_TASK"), std::string::npos);
    EXPECT_NE(command_of("EMC_IO_PLUGIN_CALL_TYPE").find("PYTHON_TASK"), std::string::npos);
    EXPECT_NE(command_of("EMC_SYSTEM_CMD_TYPE").find("M100 to M199"), std::string::npos);
    EXPECT_EQ(command_of("EMC_STAT_TYPE"), "EMC_STAT_TYPE is no command of this machine");
}

TEST(NmlVocabulary, EveryCommandOfTheMachineCanBeSent) {
    const Vocabulary vocabulary = Vocabulary::standard();
    for (const messages::Declaration *d : messages::command_declarations()) {
        const MessageKind *kind = vocabulary.find(d->number);
        ASSERT_NE(kind, nullptr) << d->name;
        EXPECT_EQ(kind->declaration, d);
        EXPECT_EQ(messages::object(*Message(*kind).command()).declaration, d);
    }
}

TEST(NmlVocabulary, ThePageOfMessagesHasEachMessageWithItsTreatment) {
    const std::string page = nml_reference_page();
    const Vocabulary vocabulary = Vocabulary::standard();
    for (const auto &[number, kind] : vocabulary.kinds()) {
        EXPECT_NE(page.find(fmt::format("| {} | {} |", number, kind.wire_name)), std::string::npos);
    }
    EXPECT_NE(page.find("| 505 | EMC_TASK_SET_STATE_TYPE | command | `SetState` |"), std::string::npos);
    EXPECT_NE(page.find("| 120 | EMC_JOINT_ABORT_TYPE | command | `JogStop` |"), std::string::npos);
    EXPECT_NE(page.find("| 213 | EMC_TRAJ_ENABLE_TYPE | command | `SetState state=ON` |"), std::string::npos);
    EXPECT_NE(page.find("| 220 | EMC_TRAJ_LINEAR_MOVE_TYPE | command | rejected: "), std::string::npos);
}

}  // namespace
}  // namespace mw::nml
