// SPDX-License-Identifier: GPL-2.0-or-later
// Interpreter plug-ins: how they are found and rejected, and canterp, which reads canon calls.
#include <algorithm>

#include <gtest/gtest.h>

#include "gcode/interpreter/plugin.hh"
#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode::test {
namespace {

using namespace gcode;
using gcode::test::Mill, gcode::test::Recorder;

class PluginTest : public testing::Test {
  protected:
    PluginTest() : frame_(record_, mill_.units), parts_{frame_, mill_, mill_, mill_} {
        file_ =
            std::filesystem::temp_directory_path() / ("mw_canterp_" + std::to_string(::getpid()) + ".can");
        auto opened = open_plugin("canterp.so", parts_);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().str());
        plugin_ = opened ? std::move(*opened) : nullptr;
    }
    ~PluginTest() override { std::filesystem::remove(file_); }

    Step run(const std::string &text) {
        std::ofstream(file_) << text;
        EXPECT_TRUE(plugin_->begin());
        EXPECT_TRUE(plugin_->open(file_.string()));
        Step step = Step::OK;
        while (step == Step::OK || step == Step::SYNC) {
            step = plugin_->step();
        }
        return step;
    }

    Mill mill_;
    Recorder record_;
    MachineFrame frame_;
    PluginParts parts_;
    std::filesystem::path file_;
    std::unique_ptr<ProgramInterpreter> plugin_;
};

TEST_F(PluginTest, CanterpMakesTheCallsThatItReads) {
    EXPECT_EQ(run("    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
                  "    2 N..... SET_FEED_RATE(600.0000)\n\n"
                  "   xx xxxxx STRAIGHT_TRAVERSE( 1 2 3   0 0 0  0 0 0)\n"
                  "    3 N10    STRAIGHT_FEED(4.0000, 5.0000, 6.0000, 0.0000, 0.0000, 0.0000)\n"
                  "    4 N..... ARC_FEED(5.0000, 6.0000, 5.0000, 5.0000, 1, 6.0000, 0.0000, 0.0000, 0.0000)\n"
                  "    5 N..... MESSAGE(\" hi (there)\")\n"
                  "    6 N..... SELECT_TOOL(3)\n    7 N..... CHANGE_TOOL()\n    8 N..... FLOOD_ON()\n"),
              Step::FILE_END);
    ASSERT_EQ(record_.lines.size(), 2u);
    EXPECT_DOUBLE_EQ(record_.lines[1].end[2], 6.0);
    EXPECT_DOUBLE_EQ(record_.lines[1].settings.feed, 10.0);
    ASSERT_EQ(record_.arcs.size(), 1u);
    EXPECT_DOUBLE_EQ(record_.arcs[0].end[1], 6.0);
    EXPECT_EQ(record_.calls,
              (std::vector<std::string>{"message hi (there)", "select_tool 3", "change_tool", "flood_on"}));
    EXPECT_EQ(run("1 N1 COMMENT(the end)\n2 N2 PROGRAM_END()\n3 N3 FLOOD_OFF()\n"), Step::PROGRAM_END);
    EXPECT_EQ(plugin_->execute("MIST_ON()"), Step::FILE_END);
    EXPECT_EQ(record_.calls.back(), "mist_on");
}

TEST_F(PluginTest, CanterpNamesThePlaceOfWhatIsWrongAndMakesNoHalfCall) {
    for (const auto &[text, place, why] : std::initializer_list<std::array<const char *, 3>>{
             {"\n1 N1 BOGUS(1)\n", ":2:6:", "there is no canon call BOGUS"},
             {"1 N1 STRAIGHT_FEED(1, 2)\n", ":1:24:", "an argument is missing"},
             {"1 N1 DWELL(soon)\n", ":1:12:", "'soon' is not a number"},
             {"1 N1 DWELL(1 2)\n", ":1:12:", "too many arguments"},
             {"1 N1 SELECT_PLANE(CANON_PLANE_ZZ)\n", ":1:19:", "'CANON_PLANE_ZZ' is not known here"},
             {"some text\n", ":1:", "a line must be"}}) {
        EXPECT_EQ(run(text), Step::FAILED) << text;
        const std::string error = plugin_->error().str();
        EXPECT_NE(error.find(place), std::string::npos) << error;
        EXPECT_NE(error.find(why), std::string::npos) << error;
    }
    EXPECT_TRUE(record_.lines.empty());
    EXPECT_TRUE(record_.calls.empty());
}

TEST_F(PluginTest, WhatIsNoPluginIsRefused) {
    const auto missing = open_plugin("no_such_interpreter.so", parts_);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("no_such_interpreter.so was not found"), std::string::npos);
    std::ofstream(file_) << "not a shared object";
    const auto text = open_plugin(file_.string(), parts_);
    ASSERT_FALSE(text);
    EXPECT_NE(text.error().message.find("cannot load the interpreter"), std::string::npos);
    const auto library = open_plugin("/lib/x86_64-linux-gnu/libm.so.6", parts_);
    if (std::filesystem::exists("/lib/x86_64-linux-gnu/libm.so.6")) {
        ASSERT_FALSE(library);
        EXPECT_NE(library.error().message.find("is not an interpreter for this version"), std::string::npos);
    }
}

}  // namespace
}  // namespace mw::gcode::test
