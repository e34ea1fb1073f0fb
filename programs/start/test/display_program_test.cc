// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the programs that [DISPLAY]DISPLAY starts (J1).
#include <gtest/gtest.h>

#include "base/own_place.hh"
#include "programs/start/display_program.hh"

namespace mw::programs {
namespace {

TEST(DisplayProgram, MillwrightIsOurOwnScreen) {
    const auto words = DisplayProgram::words("millwright --port 0", "/configs/mill.ini");
    ASSERT_TRUE(words.has_value());
    EXPECT_EQ(*words, (std::vector<std::string>{program_folder() + "/millwright", "ui", "/configs/mill.ini",
                                                "--open", "--display", "--port", "0"}));
}

TEST(DisplayProgram, OthersGetTheFileByTheirOption) {
    const auto words = DisplayProgram::words("sh -x", "/configs/mill.ini");
    ASSERT_TRUE(words.has_value());
    ASSERT_EQ(words->size(), 4U);
    EXPECT_EQ((*words)[1], "-ini");
    EXPECT_EQ((*words)[3], "-x");
    EXPECT_FALSE(DisplayProgram::words("no-such-display-program", "/configs/mill.ini").has_value());
}

}  // namespace
}  // namespace mw::programs
