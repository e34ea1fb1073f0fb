// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs of lines and arcs in up to nine coordinates, with random limits, holds, overrides and
// drops. Every sample is within the limits, the path is within the tolerance and in order, and its end is
// exact. MW_CAMPAIGN_SEEDS sets the number of seeds (default 60, fewer with jerk limits), MW_CAMPAIGN_FIRST
// the first seed.
#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/test/campaign.hh"

namespace mw::trajectory::test {
namespace {

enum class Kind { RANDOM, CURVE, LONG };

/// Number of checks of each type. A campaign without checks must fail.
struct Asked {
    int programs = 0, driven = 0, ordered = 0;
};

void check(unsigned seed, bool isJerkLimited, Asked &asked, Kind kind = Kind::RANDOM, double seconds = 6.5) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, isJerkLimited);
    const Program program = kind == Kind::CURVE  ? maker.make_curve()
                            : kind == Kind::LONG ? maker.make_long(seed % 4 == 1, seconds)
                                                 : maker.make();
    ++asked.programs;
    if (program.primitives.empty()) {
        return;
    }
    ++asked.driven;
    const bool isDropped = maker.chance(kind == Kind::LONG ? 0.05 : 0.2);
    Outcome out;
    drive(maker, program, out, isDropped);
    ASSERT_TRUE(out.isFinished);
    auto checker = make_checker(program.limits, Rig::T);
    for (const Pose &sample : out.rig.samples) {
        checker.sample(sample.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LE(worst_excursion(out.rig.samples, program), 1e-9);
    const double allowed = allowed_deviation(program);
    const bool isBounded = allowed > 0;
    if (!isDropped) {
        EXPECT_EQ(out.rig.samples.back(), program.primitives.back().end);
        if (isBounded) {
            ++asked.ordered;
            EXPECT_TRUE(isWithinProgram(out.rig.samples, program, allowed));
        }
    }
}

void check_all(bool isJerkLimited, Kind kind = Kind::RANDOM, int seeds = 60) {
    const auto [first, count] = testing::campaign_seeds(seeds);
    Asked asked;
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        check(static_cast<unsigned>(first + i), isJerkLimited, asked, kind);
    }
    if (!::testing::Test::HasFailure()) {
        EXPECT_EQ(asked.programs, count);
        EXPECT_GE(2 * asked.driven, count) << "programs without a move";
        EXPECT_GE(4 * asked.ordered, count) << "programs whose path was compared with the tolerance";
    }
}

TEST(Campaign, RandomProgramsKeepLimitsToleranceAndOrder) {
    check_all(false);
}

TEST(Campaign, SeedsThatOnceFailedKeepJerkLimits) {
    for (const unsigned seed : {30U, 69U, 159U, 9127U, 50521U, 500252U}) {
        Asked asked;
        check(seed, true, asked);
        EXPECT_EQ(asked.driven, 1);
    }
}

TEST(Campaign, LongProgramsThatOnceFailedKeepJerkLimits) {
    for (const unsigned seed : {2113U, 4463U, 4893U, 6338U, 33987U, 34194U}) {
        Asked asked;
        check(seed, true, asked, Kind::LONG);
        EXPECT_EQ(asked.driven, 1);
    }
}

TEST(Campaign, AProgramThatNeedsManyPlanningAttemptsContinues) {
    Asked asked;
    check(61015998U, true, asked, Kind::LONG, 3);
    EXPECT_EQ(asked.driven, 1);
}

TEST(Campaign, AnAxisThatReversesBesideFasterOnesKeepsItsJerkLimit) {
    Asked asked;
    for (const double seconds : {3.0, 6.5}) {
        check(1031U, true, asked, Kind::LONG, seconds);
    }
    EXPECT_EQ(asked.driven, 2);
}

TEST(Campaign, RandomProgramsKeepJerkLimits) {
    check_all(true, Kind::RANDOM, 8);
}

TEST(Campaign, DenseCurvesKeepLimitsToleranceAndOrder) {
    check_all(false, Kind::CURVE);
}

TEST(Campaign, DenseCurvesKeepJerkLimits) {
    check_all(true, Kind::CURVE, 12);
}

}  // namespace
}  // namespace mw::trajectory::test
