// SPDX-License-Identifier: GPL-2.0-or-later
// A slice of the campaign of random turning jobs; the whole of it is a program of its own.
#include <gtest/gtest.h>

#include "lathe_campaign.hh"

namespace mw::interp::test {
namespace {

TEST(LatheCampaign, cuts_nothing_but_the_stock_above_the_allowance_and_all_of_that_I1) {
    constexpr unsigned FIRST = 1, COUNT = 400;
    unsigned refused = 0;
    for (unsigned seed = FIRST; seed < FIRST + COUNT; ++seed) {
        const testing::LatheJob job = testing::make_lathe_job(seed);
        const LatheVerdict verdict = run_lathe_job(job);
        EXPECT_EQ(verdict.fault, "") << "seed " << seed << '\n' << job.program;
        const bool isEasy = job.isMonotonic && job.largest_allowance() <= 0.5;
        EXPECT_TRUE(verdict.refusal.empty() || !isEasy)
            << "seed " << seed << ": " << verdict.refusal << '\n'
            << job.program;
        refused += verdict.refusal.empty() ? 0 : 1;
    }
    EXPECT_LE(refused * 50, COUNT) << "more than 2 percent refused";
}

}  // namespace
}  // namespace mw::interp::test
