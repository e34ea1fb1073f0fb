// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "machine/certificate/path_deviation.hh"
#include "machine/certificate/test/poses.hh"
#include "tests/support/deviation.hh"

namespace mw::machine {
namespace {

using geometry::PathMode;
using geometry::Pose;

/// A path of lines, and samples along it.
class PathDeviationTest : public ::testing::Test {
  protected:
    ProgrammedMove move(const Pose &end) {
        ProgrammedMove move;
        move.id = ++id_;
        move.piece.start = end_;
        move.piece.end = end;
        move.mode = mode_;
        move.tolerance = tolerance_;
        move.source.line = static_cast<int>(id_);
        end_ = end;
        return move;
    }
    void lines(const std::vector<Pose> &ends) {
        for (const Pose &end : ends) {
            path_.on_move(move(end));
        }
    }
    void sample(const Pose &p, std::uint64_t id = 1) {
        path_.on_sample(p, id, 1000000 * count_++);
        last_ = p;
    }
    /// Adds samples on a line from the last sample to `end`.
    void drive(const Pose &end, int steps = 100, std::uint64_t id = 1) {
        const Pose from = last_;
        for (int i = 1; i <= steps; ++i) {
            sample(from + (end - from) * (static_cast<double>(i) / steps), id);
        }
    }
    double largest() const { return path_.deviations().largest.distance(); }

    PathDeviation path_;
    PathMode mode_ = PathMode::BLEND;
    double tolerance_ = 0.1;
    std::uint64_t id_ = 0;
    std::int64_t count_ = 0;
    Pose end_, last_;
};

TEST_F(PathDeviationTest, AnExactRunHasNone) {
    mode_ = PathMode::EXACT_STOP;
    lines({at(10, 0), at(5, 0), at(5, 5)});
    for (const Pose &end : {at(10, 0), at(5, 0), at(5, 5)}) {
        drive(end);
    }
    path_.complete();
    EXPECT_LT(largest(), 1e-12);
}

TEST_F(PathDeviationTest, ACornerThatIsCutIsMeasuredAtTheCorner) {
    lines({at(10, 0), at(10, 10)});
    drive(at(9.5, 0));
    drive(at(10, 0.5), 50);
    drive(at(10, 10));
    path_.complete();
    const Deviations found = path_.deviations();
    EXPECT_NEAR(found.largest.distance(), 0.5 * std::sqrt(0.5), 1e-9);
    EXPECT_EQ(found.largest.source.line, 1);
    EXPECT_NEAR(geometry::norm(found.largest.position - at(10, 0)), 0, 1e-12);
    EXPECT_NEAR(found.tightest.ratio(), 5 * std::sqrt(0.5), 1e-8);
    EXPECT_EQ(found.exact.distance(), 0);
}

TEST_F(PathDeviationTest, OrderCounts) {
    // A triangle: driven in the opposite direction it has the same distance from the path at each sample.
    lines({at(10, 0), at(5, 8), at(0, 0)});
    drive(at(5, 8));
    drive(at(10, 0));
    drive(at(0, 0));
    path_.complete();
    EXPECT_GT(largest(), 2);
}

TEST_F(PathDeviationTest, APartThatIsLeftOutCounts) {
    // Out and back on the same line: the samples stay near the path but omit this part.
    lines({at(10, 0), at(10, 3), at(10, 0), at(20, 0)});
    drive(at(20, 0), 500);
    path_.complete();
    EXPECT_NEAR(largest(), 3, 0.4);
}

TEST_F(PathDeviationTest, AReversalThatStopsShortIsMeasured) {
    lines({at(10, 0), at(0, 0)});
    drive(at(9, 0), 90);
    drive(at(0, 0), 90);
    path_.complete();
    EXPECT_NEAR(largest(), 1, 0.13);
    EXPECT_GE(largest(), 1 - 1e-9);
}

TEST_F(PathDeviationTest, AnEndThatIsNotReachedCounts) {
    lines({at(10, 0)});
    drive(at(9.75, 0));
    EXPECT_LT(largest(), 1e-12);
    path_.complete();
    EXPECT_NEAR(largest(), 0.25, 1e-12);
}

TEST_F(PathDeviationTest, ToleranceIsThatOfThePlace) {
    tolerance_ = 0.5;
    lines({at(10, 0)});
    tolerance_ = 0.01;
    lines({at(20, 0)});
    mode_ = PathMode::EXACT_PATH;
    lines({at(30, 0)});
    drive(at(5, 0));
    drive(at(5.5, 0.2), 10);
    drive(at(6, 0), 10);
    drive(at(14, 0));
    drive(at(15, 0.02), 10);
    drive(at(16, 0), 10);
    drive(at(24, 0));
    drive(at(25, 1e-5), 10);
    drive(at(26, 0), 10);
    drive(at(30, 0));
    path_.complete();
    const Deviations found = path_.deviations();
    EXPECT_NEAR(found.largest.distance(), 0.2, 1e-12);
    EXPECT_EQ(found.largest.source.line, 1);
    EXPECT_NEAR(found.tightest.ratio(), 2, 1e-9);
    EXPECT_EQ(found.tightest.source.line, 2);
    EXPECT_NEAR(found.tightest.position.x(), 15, 1e-12);
    EXPECT_NEAR(found.exact.distance(), 1e-5, 1e-12);
    EXPECT_EQ(found.exact.source.line, 3);
    EXPECT_NEAR(found.exact.ratio(), 10, 1e-6);
}

TEST_F(PathDeviationTest, LengthsAndDegreesAreComparedEachForItself) {
    lines({at(10, 0, 0, 90)});
    drive(at(5, 0, 0, 45));
    drive(at(5.05, 0.03, 0, 45.45 + 0.04), 1);
    drive(at(10, 0, 0, 90));
    path_.complete();
    const Deviation found = path_.deviations().largest;
    EXPECT_NEAR(found.distance(), 0.03, 2e-4);
    EXPECT_LE(found.angular, found.linear + 1e-9);
}

TEST_F(PathDeviationTest, AnArcOfManyRevolutionsIsFollowed) {
    ProgrammedMove helix = move(at(5, 0, -10));
    helix.piece.start = at(5, 0);
    helix.piece.normal = at(0, 0, 1);
    helix.piece.angle_rad = 20 * std::numbers::pi;
    path_.on_move(helix);
    for (int i = 0; i <= 20000; ++i) {
        const double f = i / 20000.0, angle = f * helix.piece.angle_rad;
        const double r = i == 7000 ? 5.02 : 5.0;
        sample(at(r * std::cos(angle), r * std::sin(angle), -10 * f));
    }
    path_.complete();
    EXPECT_NEAR(largest(), 0.02, 1e-9);
    EXPECT_EQ(path_.deviations().largest.time_ns, 7000000000);
}

TEST_F(PathDeviationTest, AProbeThatTripsEndsItsMoveThere) {
    lines({at(0, 0, -10)});
    drive(at(0, 0, -4));
    end_ = at(0, 0, -4);
    lines({at(0, 0, 0), at(5, 0, 0)});
    drive(at(0, 0, 0), 100, 2);
    drive(at(5, 0, 0), 100, 3);
    path_.complete();
    EXPECT_LT(largest(), 1e-12);
}

TEST_F(PathDeviationTest, RigidTappingIsNotMeasured) {
    lines({at(10, 0)});
    ProgrammedMove tap = move(at(10, 0));
    tap.isMeasured = false;
    path_.on_move(tap);
    lines({at(20, 0)});
    drive(at(10, 0));
    drive(at(10, 0, -5), 100, 2);
    drive(at(10, 0), 100, 2);
    drive(at(20, 0), 100, 3);
    path_.complete();
    EXPECT_LT(largest(), 1e-12);
    EXPECT_EQ(path_.source().line, 3);
}

/// Random paths of short lines with samples beside them, compared with the bisection of
/// tests/support/deviation.hh.
TEST_F(PathDeviationTest, RandomPathsAgreeWithTheOtherJudge) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int round = 0; round < 8; ++round) {
        PathDeviation path;
        std::vector<Pose> corners{at(0, 0)}, driven{at(0, 0)};
        const double turn = 0.2 + 0.4 * round, off = 0.03 + 0.01 * round;
        double heading = 0;
        for (int i = 0; i < 20; ++i) {
            heading += turn * unit(random);
            const double length = 0.6 + 0.5 * unit(random);
            corners.push_back(corners.back() + at(length * std::cos(heading), length * std::sin(heading)));
        }
        for (std::size_t i = 1; i < corners.size(); ++i) {
            ProgrammedMove move;
            move.id = i;
            move.piece.start = corners[i - 1];
            move.piece.end = corners[i];
            path.on_move(move);
            const Pose target = corners[i] + at(off * unit(random), off * unit(random));
            const Pose from = driven.back();
            for (int k = 1; k <= 20; ++k) {
                driven.push_back(from + (target - from) * (k / 20.0));
            }
        }
        for (const Pose &p : driven) {
            path.on_sample(p, 1, 0);
        }
        path.complete();
        constexpr double STEP = 0.01;
        const double other = testing::deviation_in_order(driven, corners, STEP, 0.4);
        EXPECT_NEAR(path.deviations().largest.distance(), other, 0.02 * other + 2 * STEP) << round;
    }
}

}  // namespace
}  // namespace mw::machine
