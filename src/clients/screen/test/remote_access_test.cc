// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the settings of `millwright ui` and its INI file for other computers and for questions (J1, J2, J3).
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "clients/screen/access/remote_access.hh"
#include "clients/screen/hal/dialog_facts.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

class UiDoor : public testing::Test {
  protected:
    UiDoor() : folder((fs::temp_directory_path() / ("mw_door_" + std::to_string(::getpid()))).string()) {}
    ~UiDoor() override { fs::remove_all(folder); }
    std::string failure(const DoorWords &words) const {
        const auto door = remote_door(words, folder);
        return door.has_value() ? "" : door.error().str();
    }
    std::string folder;
};

TEST_F(UiDoor, NobodyComesInWithoutAWord) {
    const auto none = remote_door({}, folder);
    ASSERT_TRUE(none.has_value());
    EXPECT_FALSE(none->has_value());
    EXPECT_FALSE(fs::exists(folder));
    EXPECT_NE(failure({.listen = "", .names = {}, .unprotected = "view"}), "");
    EXPECT_NE(failure({.listen = "", .names = {"mill"}, .unprotected = ""}), "");
}

TEST_F(UiDoor, AddressesAndPortsAreReadAndTlsIsTheRule) {
    struct Row {
        const char *words, *address;
        int port;
    };
    for (const Row &row : {Row{"192.168.1.5", "192.168.1.5", 8851}, Row{"0.0.0.0:9000", "0.0.0.0", 9000},
                           Row{"[::1]:9000", "::1", 9000}, Row{"::", "::", 8851}, Row{"[::]", "::", 8851}}) {
        const auto door = remote_door({.listen = row.words, .names = {"Mill"}, .unprotected = ""}, folder);
        ASSERT_TRUE(door.has_value()) << door.error().str();
        EXPECT_EQ((*door)->address, row.address);
        EXPECT_EQ((*door)->port, row.port);
        EXPECT_EQ((*door)->names.back(), "mill");
        EXPECT_TRUE((*door)->tls.has_value());
        EXPECT_EQ((*door)->access.protection(), Protection::TLS);
        EXPECT_EQ((*door)->access.role_of({}, 1), Role::NOBODY);
    }
    for (const char *bad : {"1.2.3.4:x", "1.2.3.4:70000", "[::1", "[::1]x"}) {
        EXPECT_NE(failure({.listen = bad, .names = {}, .unprotected = ""}), "") << bad;
    }
}

TEST_F(UiDoor, WithoutProtectionTheRoleIsNamed) {
    const auto door = remote_door({.listen = "0.0.0.0", .names = {}, .unprotected = "view"}, folder);
    ASSERT_TRUE(door.has_value());
    EXPECT_FALSE((*door)->tls.has_value());
    EXPECT_EQ((*door)->access.role_of({}, 1), Role::VIEW);
    EXPECT_NE(door_text(**door, 8851, folder).find("WITHOUT PROTECTION"), std::string::npos);
    EXPECT_NE(failure({.listen = "0.0.0.0", .names = {}, .unprotected = "boss"}), "");
    EXPECT_FALSE(fs::exists(folder));
}

std::vector<DialogFacts> facts_of(const std::string &display, std::vector<std::string> &told) {
    diagnostics::Sink sink([&told](const diagnostics::Diagnostic &one) { told.push_back(one.str()); });
    const auto ini = ini::IniFile::parse("[DISPLAY]\n" + display, "m.ini", sink);
    return dialog_facts(ini, sink);
}

TEST(UiDialogs, MessagesAreReadInTheirOrder) {
    std::vector<std::string> told;
    const auto all = facts_of(
        "MESSAGE_BOLDTEXT = B\nMESSAGE_TEXT = one\nMESSAGE_TYPE = okdialog status\n"
        "MESSAGE_PINNAME = a-b\nMESSAGE_TEXT = two\nMESSAGE_TYPE = yesnodialog\nMESSAGE_PINNAME = c\n"
        "MULTIMESSAGE_ID = V\nMULTIMESSAGE_V_NUMBER = 1\nMULTIMESSAGE_V_TYPE = nonedialog\n"
        "MULTIMESSAGE_V_TITLE = t\nMULTIMESSAGE_V_TEXT = x\nMULTIMESSAGE_V_DETAILS = d\n"
        "MULTIMESSAGE_V_ICON = INFO\nMULTIMESSAGE_V_NUMBER = 3\nMULTIMESSAGE_V_TYPE = status\n",
        told);
    EXPECT_TRUE(told.empty()) << told[0];
    ASSERT_EQ(all.size(), 4U);
    EXPECT_EQ(all[0].id, "a-b");
    EXPECT_EQ(all[0].title, "B");
    EXPECT_TRUE(all[0].kind.isOk && all[0].kind.isStatus && !all[0].kind.isYesNo);
    EXPECT_TRUE(all[1].kind.isYesNo);
    EXPECT_EQ(all[2].number, 1);
    EXPECT_EQ(all[2].details, "d");
    EXPECT_TRUE(all[2].kind.isLasting);
    EXPECT_EQ(all[3].number, 3);
}

TEST(UiDialogs, WhatIsWrongIsToldWithItsLine) {
    for (const char *bad :
         {"MESSAGE_TEXT = one\n", "MESSAGE_TEXT = a\nMESSAGE_TYPE = window\nMESSAGE_PINNAME = a\n",
          "MESSAGE_TEXT = a\nMESSAGE_TYPE = status\nMESSAGE_PINNAME = a b\n",
          "MULTIMESSAGE_ID = V\nMULTIMESSAGE_V_TEXT = x\n",
          "MULTIMESSAGE_ID = V\nMULTIMESSAGE_V_NUMBER = 0\nMULTIMESSAGE_V_TYPE = colour\n"}) {
        std::vector<std::string> told;
        EXPECT_TRUE(facts_of(bad, told).empty()) << bad;
        ASSERT_FALSE(told.empty()) << bad;
        EXPECT_TRUE(told[0].starts_with("m.ini:")) << told[0];
    }
}

}  // namespace
}  // namespace mw::screen
