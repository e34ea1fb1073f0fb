// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs of lines and arcs in up to nine coordinates, with random limits, holds, overrides and
// drops: every sample within the limits, the path within the tolerance and in order, its end exact.
// MW_CAMPAIGN_SEEDS sets how many (default 60), MW_CAMPAIGN_FIRST the first seed.
#include <cstdlib>

#include <gtest/gtest.h>

#include "traj/test/campaign.hh"

namespace mw::traj::test {
namespace {

enum class Kind { RANDOM, CURVE, LONG };

void check(unsigned seed, bool isJerkLimited, Kind kind = Kind::RANDOM) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, isJerkLimited);
    const Program program = kind == Kind::CURVE  ? maker.make_curve()
                            : kind == Kind::LONG ? maker.make_long(seed % 4 == 1, 6.5)
                                                 : maker.make();
    if (program.primitives.empty()) {
        return;
    }
    const bool isDropped = maker.chance(kind == Kind::LONG ? 0.05 : 0.2);
    Outcome out;
    drive(maker, program, out, isDropped);
    ASSERT_TRUE(out.isFinished);
    auto checker = make_checker(program.limits, Rig::T);
    double longest_step = 0;
    for (std::size_t i = 0; i < out.rig.samples.size(); ++i) {
        checker.sample(out.rig.samples[i].c.data());
        longest_step = i == 0 ? 0
                              : std::max(longest_step,
                                         testing::pose_distance(out.rig.samples[i], out.rig.samples[i - 1]));
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LE(worst_excursion(out.rig.samples, program), 1e-9);
    const Sequence last = out.rig.store->last_piece.load();
    const double allowed = allowed_deviation(program);
    const bool isBounded = allowed > 0;
    if (isBounded && last < PIECE_CAPACITY) {
        EXPECT_LE(worst_blend_deviation(out.rig, 1, last), allowed * (1 + 1e-9) + 1e-12);
    }
    if (!isDropped) {
        EXPECT_EQ(out.rig.samples.back(), program.primitives.back().end);
        if (isBounded) {
            const double near = allowed + 0.5 * longest_step;
            EXPECT_TRUE(isInOrder(out.rig.samples, program, near * 1.3 + 1e-9));
        }
    }
}

int number_from(const char *name, int preset) {
    const char *text = std::getenv(name);
    return text != nullptr ? std::atoi(text) : preset;
}

void check_all(bool isJerkLimited, Kind kind = Kind::RANDOM) {
    const int first = number_from("MW_CAMPAIGN_FIRST", 1);
    const int count = number_from("MW_CAMPAIGN_SEEDS", 60);
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        check(static_cast<unsigned>(first + i), isJerkLimited, kind);
    }
}

TEST(Campaign, RandomProgramsKeepLimitsToleranceAndOrder) {
    check_all(false);
}

TEST(Campaign, SeedsThatOnceFailedKeepJerkLimits_C13) {
    for (const unsigned seed : {30U, 69U, 159U, 9127U, 50521U, 500252U}) {
        check(seed, true);
    }
}

TEST(Campaign, LongProgramsThatOnceFailedKeepJerkLimits_C13) {
    for (const unsigned seed : {2113U, 4463U, 4893U, 6338U, 33987U, 34194U}) {
        check(seed, true, Kind::LONG);
    }
}

TEST(Campaign, RandomProgramsKeepJerkLimits_C13) {
    check_all(true);
}

TEST(Campaign, DenseCurvesKeepLimitsToleranceAndOrder_C2) {
    check_all(false, Kind::CURVE);
}

TEST(Campaign, DenseCurvesKeepJerkLimits_C13) {
    check_all(true, Kind::CURVE);
}

}  // namespace
}  // namespace mw::traj::test
