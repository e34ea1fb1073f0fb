// SPDX-License-Identifier: GPL-2.0-or-later
#include <memory>

#include <gtest/gtest.h>

#include "trajectory/follow/mean_filter.hh"

namespace mw::trajectory {
namespace {

TEST(MeanFilter, IsTheMeanOfTheLastSamplesAndBeforeThemOfTheOrigin) {
    auto history = std::make_unique<LeaderHistory>();
    MeanFilter filter;
    Pose origin;
    origin[0] = 100;
    filter.reset(origin, 4, 10);
    const auto push = [&](std::uint64_t tick, double x) {
        (*history)[tick % HISTORY_CAPACITY].pose[0] = x;
        return filter.push(*history, tick)[0];
    };
    EXPECT_EQ(push(10, 104), 101);
    EXPECT_EQ(push(11, 104), 102);
    EXPECT_EQ(push(12, 104), 103);
    EXPECT_EQ(push(13, 104), 104);
    EXPECT_EQ(push(14, 104), 104);
    EXPECT_EQ(push(15, 108), 105);
}

TEST(MeanFilter, GathersNoRoundingOverALongRun) {
    auto history = std::make_unique<LeaderHistory>();
    MeanFilter filter;
    filter.reset(Pose{}, 7, 1);
    double mean = 0;
    for (std::uint64_t tick = 1; tick < 2000000; ++tick) {
        const double x = tick < 1999900 ? 1000.0 / 3.0 * static_cast<double>(tick % 97) : 0.1;
        (*history)[tick % HISTORY_CAPACITY].pose[0] = x;
        mean = filter.push(*history, tick)[0];
    }
    EXPECT_NEAR(mean, 0.1, 1e-16);
}

}  // namespace
}  // namespace mw::trajectory
