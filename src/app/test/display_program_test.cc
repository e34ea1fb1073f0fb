// SPDX-License-Identifier: GPL-2.0-or-later
// What [DISPLAY]DISPLAY starts (J1).
#include <gtest/gtest.h>

#include "app/display_program.hh"
#include "base/own_place.hh"

namespace mw::app {
namespace {

TEST(DisplayProgram, MillwrightIsOurOwnScreen_J1) {
    const auto words = DisplayProgram::words("millwright --port 0", "/configs/mill.ini");
    ASSERT_TRUE(words.has_value());
    EXPECT_EQ(*words, (std::vector<std::string>{program_folder() + "/millwright", "ui", "/configs/mill.ini",
                                                "--open", "--display", "--port", "0"}));
}

TEST(DisplayProgram, OthersGetTheFileByTheirOption_J1) {
    const auto words = DisplayProgram::words("sh -x", "/configs/mill.ini");
    ASSERT_TRUE(words.has_value());
    ASSERT_EQ(words->size(), 4U);
    EXPECT_EQ((*words)[1], "-ini");
    EXPECT_EQ((*words)[3], "-x");
    EXPECT_FALSE(DisplayProgram::words("no-such-display-program", "/configs/mill.ini").has_value());
}

}  // namespace
}  // namespace mw::app
