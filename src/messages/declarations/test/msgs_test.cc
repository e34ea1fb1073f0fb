// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of the declarations: numbers, names, documentation, lookups, ranges, the reference page.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/reference.hh"
#include "messages/declarations/status.hh"

namespace mw::messages {
namespace {

std::vector<const Declaration *> all_declarations() {
    std::vector<const Declaration *> all(command_declarations().begin(), command_declarations().end());
    all.insert(all.end(), status_declarations().begin(), status_declarations().end());
    return all;
}

TEST(Messages, NumbersAndNamesAreUnique) {
    std::set<int> numbers;
    std::set<std::string> names;
    for (const Declaration *d : all_declarations()) {
        EXPECT_TRUE(names.insert(d->name).second) << d->name;
        EXPECT_TRUE(d->number == 0 || numbers.insert(d->number).second) << d->name << ' ' << d->number;
    }
    EXPECT_GE(numbers.size(), 80U);
}

TEST(Messages, EveryFieldIsDocumentedWithASnakeCaseNameOnce) {
    for (const Declaration *d : all_declarations()) {
        EXPECT_NE(std::string(d->doc), "") << d->name;
        std::set<std::string> names;
        for (const Field &field : d->fields) {
            const std::string name = field.name;
            EXPECT_TRUE(names.insert(name).second) << d->name << '.' << name;
            EXPECT_NE(std::string(field.doc), "") << d->name << '.' << name;
            EXPECT_TRUE(std::all_of(name.begin(), name.end(), [](char c) {
                return c == '_' || std::islower(static_cast<unsigned char>(c)) != 0 ||
                       std::isdigit(static_cast<unsigned char>(c)) != 0;
            })) << name;
        }
    }
}

TEST(Messages, EveryStructInsideAStatusIsListed) {
    const auto listed = status_declarations();
    for (const Declaration *d : listed) {
        for (const Field &field : d->fields) {
            const Declaration *parts = field.type.parts;
            EXPECT_TRUE(parts == nullptr || std::find(listed.begin(), listed.end(), parts) != listed.end())
                << d->name << '.' << field.name;
        }
    }
}

TEST(Messages, AreFoundByNumberAndName) {
    for (const Declaration *d : command_declarations()) {
        EXPECT_EQ(find_declaration(d->number), d);
        EXPECT_EQ(find_declaration(d->name), d);
        const auto made = make_command(d->number);
        ASSERT_TRUE(made.has_value());
        EXPECT_EQ(object(*made).declaration, d);
    }
    EXPECT_EQ(find_declaration("JogStop")->number, 136);
    EXPECT_EQ(find_declaration(199), &DECLARATION<AxisStatus>);
    EXPECT_EQ(find_declaration(0), nullptr) << "parts without a number are found by name only";
    EXPECT_EQ(find_declaration(""), nullptr);
    EXPECT_EQ(find_declaration(4711), nullptr);
    EXPECT_EQ(make_command("Jig").error().message, "there is no command 'Jig'");
    EXPECT_EQ(make_command(4711).error().message, "there is no command 4711");
    EXPECT_FALSE(make_command(1999).has_value()) << "a status is no command";
}

TEST(Messages, AValueOutOfRangeIsNamedWithFieldAndRange) {
    const auto refused = [](const Command &command) {
        const auto status = check(command);
        return status.has_value() ? std::string("allowed") : status.error().message;
    };
    EXPECT_EQ(refused(JogStop{true, 16}), "JogStop: index is 16, allowed is 0 to 15");
    EXPECT_EQ(refused(JogStop{true, -1}), "JogStop: index is -1, allowed is 0 to 15");
    EXPECT_EQ(refused(JogStop{true, 15}), "allowed");
    EXPECT_EQ(refused(SetFeedOverride{-0.5}),
              "SetFeedOverride: factor is -0.5, allowed is at least 0 [1.0 is 100 %]");
    EXPECT_EQ(refused(SetFeedOverride{std::nan("")}),
              "SetFeedOverride: factor is nan, allowed is at least 0 [1.0 is 100 %]");
    EXPECT_EQ(refused(SpindleOn{0, std::numeric_limits<double>::infinity()}),
              "SpindleOn: speed_rpm is inf, allowed is a finite number [rev/min]");
    EXPECT_EQ(refused(Mdi{std::string(1024, 'x')}),
              "Mdi: line is 1024 bytes long, allowed is 0 to 1023 bytes");
    EXPECT_EQ(refused(OpenProgram{std::string("a\0b", 3)}),
              "OpenProgram: path is a text with a zero byte, allowed is a text without one");
    EXPECT_EQ(refused(OpenProgram{""}), "OpenProgram: path is 0 bytes long, allowed is 1 to 1023 bytes");
    EXPECT_EQ(refused(SetState{static_cast<State>(9)}), "SetState: state is 9, allowed is one of its names");
    RigidTapMove move;
    move.end[geometry::AXIS_W] = std::nan("");
    EXPECT_NE(refused(move), "allowed");
}

TEST(Messages, EveryCommandIsAllowedWithItsOwnDefaultsUnlessItNeedsAText) {
    for (const Declaration *d : command_declarations()) {
        const bool has_text = std::any_of(d->fields.begin(), d->fields.end(), [](const Field &field) {
            return field.type.kind == Kind::TEXT && field.range.min > 0;
        });
        EXPECT_EQ(check(*make_command(d->number)).has_value(), !has_text) << d->name;
    }
}

TEST(Messages, TheReferencePageHasEachCommandAndField) {
    const std::string page = reference_page();
    for (const Declaration *d : command_declarations()) {
        EXPECT_NE(page.find(d->name), std::string::npos) << d->name;
        for (const Field &field : d->fields) {
            EXPECT_NE(page.find("`" + std::string(field.name) + "`"), std::string::npos)
                << d->name << ' ' << field.name;
        }
    }
}

TEST(Messages, TenMegabytesOfNestedJsonAreNoMessage) {
    constexpr std::size_t SIZE = 10'000'000;
    const std::string open(SIZE, '[');
    std::string objects;
    while (objects.size() < SIZE) {
        objects += R"({"a":)";
    }
    const std::string start = R"({"message":"JogStop","index":)";
    const std::string closed = std::string(SIZE / 2, '[') + std::string(SIZE / 2, ']');
    for (const std::string &text : {open, objects, start + open, start + objects, start + closed + "}",
                                    start + '"' + std::string(SIZE, 'x')}) {
        EXPECT_EQ(json_name(text).error().message, "this is no JSON object") << text.substr(0, 40);
    }
}

TEST(Messages, WhatIsWaitedForIsToldInWords) {
    EXPECT_EQ(waiting_text({WaitFor::DIGITAL_INPUT, 3}), "pin motion.digital-in-03");
    EXPECT_EQ(waiting_text({WaitFor::SPINDLE_ORIENTED, 1}), "pin spindle.1.is-oriented");
    EXPECT_EQ(waiting_text({}), "");
    for (const Name &name : NAMES<WaitFor>) {
        const auto what = static_cast<WaitFor>(name.value);
        EXPECT_EQ(waiting_text({what, 0}).empty(), what == WaitFor::NOTHING) << name.name;
    }
}

TEST(FixedText, IsCutBetweenCharactersAndSaysSo) {
    FixedText<4> text;
    EXPECT_TRUE(text.assign("abcd"));
    EXPECT_EQ(text.str(), "abcd");
    EXPECT_FALSE(text.assign("abc\xc3\xa4"));  // the letter has two bytes
    EXPECT_EQ(text.str(), "abc");
    EXPECT_FALSE(text.assign("abcde"));
    EXPECT_EQ(text.str(), "abcd");
}

}  // namespace
}  // namespace mw::messages
