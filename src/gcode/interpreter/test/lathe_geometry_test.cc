// SPDX-License-Identifier: GPL-2.0-or-later
// Offset profiles, and the side of their material.
#include <random>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/lathe/lathe_layers.hh"
#include "gcode/interpreter/codes/lathe/lathe_offset.hh"
#include "tests/support/stock/contour.hh"

namespace mw::gcode::detail {
namespace {

constexpr double TOLERANCE = 0.001;

ProfileSegment line(Point from, Point to) {
    ProfileSegment one;
    one.start = from;
    one.end = to;
    return one;
}

/// A profile from (-1, 30) to the first point and through the other points.
Profile through(const std::vector<Point> &points) {
    Profile profile{line({-1, 30}, points.front())};
    for (std::size_t i = 1; i < points.size(); ++i) {
        profile.push_back(line(points[i - 1], points[i]));
    }
    return profile;
}

void expect_points(const Profile &profile, const std::vector<Point> &points) {
    ASSERT_EQ(profile.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(profile[i].end.x, points[i].x, 1e-9) << i;
        EXPECT_NEAR(profile[i].end.y, points[i].y, 1e-9) << i;
    }
}

TEST(LatheOffset, GoesAroundConvexCornersAndCutsOffConcaveOnes) {
    const Profile step = through({{0, 5}, {10, 5}, {10, 9}, {20, 9}});
    expect_points(offset_profile(step, 1.0, TOLERANCE), {{0, 6}, {9, 6}, {9, 9}, {10, 10}, {20, 10}});
}

TEST(LatheOffset, SkipsAGrooveNarrowerThanTheCircles) {
    const Profile groove = through({{0, 9}, {10, 9}, {10, 4}, {11, 4}, {11, 9}, {20, 9}});
    const Profile edge = offset_profile(groove, 2.0, TOLERANCE);
    for (const ProfileSegment &piece : edge) {
        EXPECT_GT(piece.end.y, 10.9);  // the circles around both rims intersect at 9 + sqrt(4 - 0.25)
    }
    EXPECT_NEAR(edge.back().end.x, 20.0, 1e-9);
}

TEST(LatheOffset, ALowStepAtTheEndShadowsWhatLiesBeforeIt) {
    const Profile edge = offset_profile(through({{0, 5}, {10, 5}, {10, 5.5}}), 2.0, TOLERANCE);
    EXPECT_NEAR(edge.back().end.x, 10.0, 1e-9);
    EXPECT_NEAR(edge.back().end.y, 7.5, 1e-9);
}

TEST(LatheOffset, AFallingBeginningIsReachedInFrontOfTheMaterial) {
    const Profile edge = offset_profile(through({{0, 9}, {4, 5}, {10, 5}, {10, 9}}), 1.0, TOLERANCE);
    EXPECT_NEAR(edge.front().end.x, 0.0, 1e-9);
    EXPECT_NEAR(edge.front().end.y, 10.0, 1e-9);
}

TEST(LatheOffset, OfNothingIsTheProfile) {
    const Profile step = through({{0, 5}, {10, 5}, {10, 9}});
    expect_points(offset_profile(step, 0.0, TOLERANCE), {{0, 5}, {10, 5}, {10, 9}});
}

TEST(LatheOffset, IsAsFarFromAnyProfileAsItHasToBeAndNoFurther) {
    constexpr unsigned SEED = 77;
    std::mt19937 random(SEED);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int round = 0; round < 500; ++round) {
        std::vector<Point> points{{0, number(2, 10)}};
        testing::Contour contour;
        const int count = static_cast<int>(number(2, 12));
        for (int i = 0; i < count; ++i) {
            const Point from = points.back();
            const Point to{from.x + (number(0, 1) < 0.2 ? 0.0 : number(0.05, 4)), number(1, 12)};
            points.push_back(to);
            contour.strokes.push_back({{from.x, from.y}, {to.x, to.y}, false, {}, false});
        }
        const double by = number(0.01, 3);
        const Profile edge = offset_profile(through(points), by, TOLERANCE);
        Point before = edge.front().end;
        for (std::size_t i = 1; i < edge.size(); ++i) {
            EXPECT_LT(distance(edge[i].start, before), 1e-6) << "round " << round << " piece " << i;
            before = edge[i].end;
            const bool inside = edge[i].start.x > 0.0 && edge[i].end.x < points.back().x;
            const double off = contour.distance({edge[i].end.x, edge[i].end.y});
            if (inside) {
                EXPECT_GT(off, by - 1e-6) << "round " << round << " piece " << i;
                EXPECT_LT(off, by + TOLERANCE) << "round " << round << " piece " << i;
            }
        }
    }
}

TEST(LatheFrame, MaterialIsOnTheSideWhereTheStartIsNot) {
    // (Z, X): a step down to the chuck, from outside and from inside.
    const auto across = [](Point start, std::vector<Point> points) {
        Profile profile = through(points);
        profile.front().start = start;
        const CutFrame frame = frame_of(profile, false);
        return frame.side_clear ? frame.across : 0.0;
    };
    EXPECT_EQ(across({2, 20}, {{0, 10}, {-10, 10}, {-12, 5}}), 1.0);
    EXPECT_EQ(across({2, 2}, {{0, 10}, {-10, 10}, {-12, 15}}), -1.0);
    EXPECT_EQ(across({2, 10}, {{0, 10}, {-10, 10}, {-12, 5}}), 1.0);
    EXPECT_EQ(across({2, 10}, {{0, 10}, {-10, 10}, {-12, 15}}), -1.0);
    EXPECT_EQ(across({2, 10}, {{0, 10}, {-10, 12}, {-12, 5}}), 0.0);
}

TEST(LatheProfile, ArcsOfRoundedNumbersMayTouchAShoulder) {
    ProfileSegment arc;
    arc.isArc = true;
    arc.start = {0, 5};
    arc.centre = {2, 5.0002};  // starts by going back 1e-8
    arc.end = {4, 5.0002};
    arc.turn = -1;
    Profile profile{line({-1, 30}, {0, 5}), arc};
    EXPECT_TRUE(isMonotonic(profile, TOLERANCE));
    straighten(profile);
    for (std::size_t i = 1; i < profile.size(); ++i) {
        EXPECT_LE(profile[i].start.x, profile[i].end.x);
        EXPECT_EQ(profile[i].start, profile[i - 1].end);
    }
    arc.centre = {2, 6};
    EXPECT_FALSE(isMonotonic({line({-1, 30}, {0, 5}), arc}, TOLERANCE));
}

TEST(LatheLayers, NoneIsDeeperThanTheIncrementFromTheStartDown) {
    RoughingPlan plan;
    plan.increment = 4.0;
    plan.retract = 1.0;
    const auto moves = rough_moves(through({{0, 20}, {10, 20}, {10, 30}}), plan);
    ASSERT_TRUE(moves);
    std::vector<double> levels;
    for (const ProfileMove &move : *moves) {
        if (!move.isRapid && !move.isArc && std::fabs(move.end.x - 10.0) < 1e-9) {
            levels.push_back(move.end.y);
        }
    }
    EXPECT_EQ(levels, (std::vector<double>{30, 26, 22, 20, 30}));
}

}  // namespace
}  // namespace mw::gcode::detail
