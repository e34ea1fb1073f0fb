// SPDX-License-Identifier: GPL-2.0-or-later
// A part of the campaign of random turning jobs; lathe_campaign runs all of it.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "lathe_campaign.hh"

namespace mw::gcode::test {
namespace {

TEST(LatheCampaign, CutsNothingButTheStockAboveTheAllowanceAndAllOfThat) {
    constexpr unsigned FIRST = 1, COUNT = 400;
    unsigned refused = 0;
    for (unsigned seed = FIRST; seed < FIRST + COUNT; ++seed) {
        const testing::LatheJob job = testing::make_lathe_job(seed);
        const LatheVerdict verdict = run_lathe_job(job);
        EXPECT_EQ(verdict.fault, "") << "seed " << seed << '\n' << job.program;
        const bool easy = job.isMonotonic && job.largest_allowance() <= 0.5;
        EXPECT_TRUE(verdict.refusal.empty() || !easy) << "seed " << seed << ": " << verdict.refusal << '\n'
                                                      << job.program;
        refused += verdict.refusal.empty() ? 0 : 1;
    }
    EXPECT_LE(refused * 50, COUNT) << "more than 2 percent rejected";
}

/// An arc that ends vertically, followed by a wall down from its end: rounded numbers shift the fold slightly
/// to the wrong side.
TEST(LatheCampaign, APeakOfAnArcAndAWallKeepsItsAllowanceAllAround) {
    const testing::LatheJob job = testing::make_lathe_job(19588);
    const LatheVerdict verdict = run_lathe_job(job);
    EXPECT_EQ(verdict.refusal, "") << job.program;
    EXPECT_EQ(verdict.fault, "") << job.program;
}

/// The lathe program in configs/sim makes the part that its comments describe.
TEST(LatheProgram, LathePartIsRoughedInLayersFinishedAndParted) {
    std::ifstream file(MW_SOURCE_DIR "/nc_files/lathe_part.ngc");
    std::ostringstream text;
    text << file.rdbuf();
    testing::LatheJob job;
    job.program = text.str();
    for (const char *cycle : {"\nG71 ", "\nG70 ", "\nG0 Z-30\n"}) {
        const std::size_t at = job.program.find(cycle);
        ASSERT_NE(at, std::string::npos) << cycle;
        job.program.insert(at, "\nG4 P0");
    }
    job.start = {-2, 23};
    job.contour.strokes = {{{-1, 0}, {0, 0}, false, {}, false},        {{0, 0}, {0, 6}, false, {}, false},
                           {{0, 6}, {4, 10}, true, {4, 6}, false},     {{4, 10}, {20, 10}, false, {}, false},
                           {{20, 10}, {24, 14}, true, {20, 14}, true}, {{24, 14}, {24, 18}, false, {}, false},
                           {{24, 18}, {26, 20}, false, {}, false},     {{26, 20}, {30, 20}, false, {}, false},
                           {{30, 20}, {30, 23}, false, {}, false}};
    job.cycles = {{"71", 0.4, 1.5, false, false}, {"70", 0.0, 0.4, false, true}};
    const LatheVerdict verdict = run_lathe_job(job);
    EXPECT_EQ(verdict.refusal, "");
    EXPECT_EQ(verdict.fault, "");
    ASSERT_EQ(verdict.last_places.size(), 3u);
    EXPECT_EQ(verdict.last_places[2].h, 0.0) << "parted to the middle";
    EXPECT_EQ(verdict.last_places[2].u, 30.0);
}

}  // namespace
}  // namespace mw::gcode::test
