// SPDX-License-Identifier: GPL-2.0-or-later
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "clients/nml/message/sender.hh"
#include "clients/nml/message/vocabulary.hh"
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
    declare("Greeting", 4001, "", "says hello",
            field<&nml::Greeting::text>("text", "what is said", unit::NONE, range(0, 100)));
template <>
inline constexpr auto DECLARED<nml::Nameless> = declare("Nameless", 0, "", "has no number");
template <>
inline constexpr auto DECLARED<nml::SecondMdi> = declare("SecondMdi", 509, "", "has Mdi's number");
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
        const bool isStatus = name.ends_with("_STAT_TYPE");
        EXPECT_EQ(kind->base, isStatus ? Base::STATUS : Base::COMMAND) << name;
        EXPECT_EQ(sender_of(*kind->declaration) == Sender::STATUS, isStatus) << name;
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

TEST(NmlVocabulary, ThePageOfMessagesHasEachCommand) {
    const std::string page = nml_reference_page();
    for (const messages::Declaration *d : messages::command_declarations()) {
        EXPECT_NE(page.find(std::to_string(d->number)), std::string::npos) << d->name;
    }
}

}  // namespace
}  // namespace mw::nml
