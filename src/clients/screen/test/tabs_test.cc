// SPDX-License-Identifier: GPL-2.0-or-later
// Tests user panels, and programs that wait for the screen's pins (J1, J2).
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/facts/tabs.hh"
#include "clients/screen/hal/postgui.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

class UiTabs : public testing::Test {
  protected:
    UiTabs() : folder(fs::temp_directory_path() / ("mw_tabs_" + std::to_string(::getpid()))) {
        fs::create_directories(folder);
    }
    ~UiTabs() override { fs::remove_all(folder); }
    ini::IniFile ini(const std::string &text) {
        diagnostics::Sink sink([this](const diagnostics::Diagnostic &one) { told.push_back(one.str()); });
        return ini::IniFile::parse(text, (folder / "m.ini").string(), sink);
    }
    std::vector<Tab> tabs(const std::string &display) {
        diagnostics::Sink sink([this](const diagnostics::Diagnostic &one) { told.push_back(one.str()); });
        return tabs_of(ini("[DISPLAY]\n" + display), sink);
    }

    fs::path folder;
    std::vector<std::string> told;
};

TEST_F(UiTabs, PagesPanelsAndProgramsAreToldApart) {
    std::ofstream(folder / "p.json")
        << R"({"parts":[{"kind":"lamp","label":"On","name":"motion.motion-enabled"},
        {"kind":"button","label":"Go","name":"a.b"}]})";
    const auto all =
        tabs("EMBED_TAB_NAME = Camera\nEMBED_TAB_COMMAND = http://192.168.1.9/video\n"
             "EMBED_TAB_NAME = Shop\nEMBED_TAB_COMMAND = panel p.json\nEMBED_TAB_LOCATION = right\n"
             "EMBED_TAB_NAME = Old\nEMBED_TAB_COMMAND = gladevcp -x {XID} old.ui\n");
    EXPECT_TRUE(told.empty()) << told[0];
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].kind, Tab::Kind::FRAME);
    EXPECT_EQ(all[0].location, "right");  // the first location belongs to the first tab
    EXPECT_EQ(all[1].kind, Tab::Kind::PANEL);
    EXPECT_EQ(tab_programs(all), std::vector<std::string>{"gladevcp  old.ui"});
}

TEST_F(UiTabs, WhatIsWrongIsToldWithItsLine) {
    std::ofstream(folder / "bad.json") << R"({"parts":[{"kind":"window","label":"x","name":"y"}]})";
    for (const char *bad : {"EMBED_TAB_NAME = a\n", "EMBED_TAB_COMMAND = a\n",
                            "EMBED_TAB_NAME = a\nEMBED_TAB_COMMAND = panel gone.json\n",
                            "EMBED_TAB_NAME = a\nEMBED_TAB_COMMAND = panel bad.json\n"}) {
        told.clear();
        EXPECT_TRUE(tabs(bad).empty()) << bad;
        ASSERT_EQ(told.size(), 1U) << bad;
        EXPECT_NE(told[0].find("m.ini:"), std::string::npos) << told[0];
    }
}

TEST_F(UiTabs, WhatWaitsForTheScreenRunsInItsOrder) {
    const auto commands = postgui_commands(ini("[HAL]\nPOSTGUI_HALFILE = a.hal\nPOSTGUI_HALCMD = setp x 1\n"
                                               "POSTGUI_HALFILE = b.tcl one\n"),
                                           "/bin");
    ASSERT_EQ(commands.size(), 3U);
    const std::string path = (folder / "m.ini").string();
    EXPECT_EQ(commands[0], (std::vector<std::string>{"/bin/halcmd", "-i", path, "-f", "a.hal"}));
    EXPECT_EQ(commands[1], (std::vector<std::string>{"/bin/haltcl", "-i", path, "b.tcl", "one"}));
    EXPECT_EQ(commands[2], (std::vector<std::string>{"/bin/halcmd", "setp", "x", "1"}));
}

TEST_F(UiTabs, AFailureIsNotedAndTheNextIsRun) {
    const std::string mark = (folder / "mark").string();
    const auto notes =
        run_postgui({{"/bin/false"}, {"/no/such/program"}, {"/usr/bin/touch", "mark"}}, folder.string());
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[0].find("/bin/false: exit status 1"), std::string::npos) << notes[0];
    EXPECT_TRUE(fs::exists(mark));  // in the folder of the INI file
}

}  // namespace
}  // namespace mw::screen
