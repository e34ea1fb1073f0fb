// SPDX-License-Identifier: GPL-2.0-or-later
// Seconds to nanoseconds, at the ends of the range.
#include <limits>

#include <gtest/gtest.h>

#include "base/duration.hh"

namespace mw {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

TEST(Duration, IsRoundedToTheNearestNanosecond) {
    EXPECT_EQ(to_ns(0), 0);
    EXPECT_EQ(to_ns(1.5), 1'500'000'000);
    EXPECT_EQ(to_ns(1.0000000004), 1'000'000'000);
    EXPECT_EQ(to_ns(1.0000000006), 1'000'000'001);
    EXPECT_EQ(to_ns(-0.25), -250'000'000);
}

TEST(Duration, NeverLeavesItsRange) {
    constexpr std::int64_t YEAR_NS = 365LL * 24 * 3600 * NS_PER_SECOND;
    EXPECT_GT(LONGEST_DURATION_NS, 70 * YEAR_NS);
    for (const double seconds : {1e10, 9223372037.0, 1e18, 1e300, INFINITE}) {
        EXPECT_EQ(to_ns(seconds), LONGEST_DURATION_NS) << seconds;
        EXPECT_EQ(to_ns(-seconds), -LONGEST_DURATION_NS) << seconds;
    }
    EXPECT_EQ(to_ns(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Duration, TheLongestOneCanBeAddedToAnyTime) {
    constexpr std::int64_t YEAR_NS = 365LL * 24 * 3600 * NS_PER_SECOND;
    EXPECT_GT(200 * YEAR_NS + LONGEST_DURATION_NS, 0) << "the year 2170 by a clock that counts from 1970";
}

}  // namespace
}  // namespace mw
