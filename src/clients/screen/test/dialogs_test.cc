// SPDX-License-Identifier: GPL-2.0-or-later
// Tests questions of HAL to the operator (J2).
#include "clients/screen/hal/dialogs.hh"
#include "components/test/bench.hh"

namespace mw::screen {
namespace {

class DialogsTest : public testing::Test {
  protected:
    DialogsTest() { EXPECT_TRUE(dialogs.begin(bench.hal()).has_value()); }
    void set(const std::string &pin, double value) { bench.set("screen." + pin, value); }
    double get(const std::string &pin) { return bench.get("screen." + pin); }

    components::test::Bench bench{""};
    Dialogs dialogs{{{"door", 0, {.isOk = true}, "Door", "Close the door", "", ""},
                     {"probe", 0, {.isYesNo = true, .isStatus = true}, "", "Is the probe in?", "", ""},
                     {"hot", 0, {.isLasting = true}, "", "Spindle is hot", "", ""},
                     {"oil", 0, {.isStatus = true}, "Oil", "is low", "", ""},
                     {"vfd", 1, {.isOk = true}, "", "Overload", "", ""},
                     {"vfd", 3, {.isOk = true, .isStatus = true}, "", "Overheat", "", ""}}};
};

using Places = std::vector<std::size_t>;

TEST_F(DialogsTest, AnOkDialogAsksUntilAPersonClosesIt) {
    EXPECT_EQ(dialogs.look(), Places{});
    set("door", 1);
    EXPECT_EQ(dialogs.look(), Places{0});
    EXPECT_EQ(get("door-waiting"), 1);
    EXPECT_EQ(dialogs.look(), Places{0});
    EXPECT_TRUE(dialogs.answer("door", 0, true));
    EXPECT_EQ(get("door"), 0);
    EXPECT_EQ(get("door-waiting"), 0);
    EXPECT_EQ(get("door-response"), 1);
    EXPECT_EQ(dialogs.look(), Places{});
    EXPECT_FALSE(dialogs.answer("door", 0, true));
    set("door", 1);
    EXPECT_EQ(dialogs.look(), Places{0});
    EXPECT_EQ(get("door-response"), 0);
}

TEST_F(DialogsTest, AQuestionIsTakenBackByItsPin) {
    set("door", 1);
    dialogs.look();
    set("door", 0);
    EXPECT_EQ(dialogs.look(), Places{});
    EXPECT_EQ(get("door-waiting"), 0);
    EXPECT_FALSE(dialogs.answer("door", 0, true));
}

TEST_F(DialogsTest, YesAndNoAreToldToHal) {
    for (const bool is_yes : {false, true}) {
        set("probe", 1);
        EXPECT_EQ(dialogs.look(), Places{1});
        EXPECT_EQ(dialogs.take_notes(), std::vector<std::string>{"Is the probe in?"});
        EXPECT_TRUE(dialogs.answer("probe", 0, is_yes));
        EXPECT_EQ(get("probe-response"), is_yes ? 1 : 0);
        dialogs.look();
    }
}

TEST_F(DialogsTest, WhatLastsHasNoAnswer) {
    set("hot", 1);
    EXPECT_EQ(dialogs.look(), Places{2});
    EXPECT_EQ(get("hot-waiting"), 0);
    EXPECT_FALSE(dialogs.answer("hot", 0, true));
    set("hot", 0);
    EXPECT_EQ(dialogs.look(), Places{});
}

TEST_F(DialogsTest, ANoteIsToldOnceForEachTime) {
    for (int i = 0; i < 2; ++i) {
        set("oil", 1);
        EXPECT_EQ(dialogs.look(), Places{});
        EXPECT_EQ(dialogs.take_notes(), std::vector<std::string>{"Oil: is low"});
        EXPECT_EQ(get("oil"), 0);
        dialogs.look();
        EXPECT_TRUE(dialogs.take_notes().empty());
    }
}

TEST_F(DialogsTest, ANumberChoosesItsText) {
    set("vfd", 3);
    EXPECT_EQ(dialogs.look(), Places{5});
    EXPECT_EQ(dialogs.take_notes(), std::vector<std::string>{"Overheat"});
    EXPECT_FALSE(dialogs.answer("vfd", 1, true));  // answer to a text that is no longer shown
    set("vfd", 1);
    EXPECT_EQ(dialogs.look(), Places{4});
    EXPECT_TRUE(dialogs.answer("vfd", 1, true));
    EXPECT_EQ(get("vfd"), 0);
    set("vfd", 7);
    EXPECT_EQ(dialogs.look(), Places{});
}

TEST_F(DialogsTest, ANumberWithoutATextIsReportedAndReset) {
    set("vfd", 1);
    EXPECT_EQ(dialogs.look(), Places{4});
    set("vfd", 2);
    EXPECT_EQ(dialogs.look(), Places{});
    EXPECT_EQ(
        dialogs.take_notes(),
        std::vector<std::string>{"screen.vfd is 2, and [DISPLAY] has no MULTIMESSAGE with this number"});
    EXPECT_EQ(get("vfd"), 0);
    EXPECT_EQ(get("vfd-waiting"), 0);
    EXPECT_FALSE(dialogs.answer("vfd", 1, true));
    EXPECT_EQ(dialogs.look(), Places{});
    EXPECT_TRUE(dialogs.take_notes().empty());
    set("vfd", 1);
    EXPECT_EQ(dialogs.look(), Places{4});
}

TEST_F(DialogsTest, WhoKeepsThePinSetAsksOnce) {
    set("door", 1);
    dialogs.look();
    EXPECT_TRUE(dialogs.answer("door", 0, true));
    set("door", 1);  // set before the next check, as its writer does in each cycle
    EXPECT_EQ(dialogs.look(), Places{});
    set("door", 0);
    dialogs.look();
    set("door", 1);
    EXPECT_EQ(dialogs.look(), Places{0});
}

TEST_F(DialogsTest, ASecondScreenSaysThatThePinsAreTaken) {
    Dialogs other({{"door", 0, {.isOk = true}, "", "x", "", ""}});
    const auto begun = other.begin(bench.hal());
    ASSERT_FALSE(begun.has_value());
    EXPECT_NE(begun.error().str().find("screen"), std::string::npos);
}

}  // namespace
}  // namespace mw::screen
