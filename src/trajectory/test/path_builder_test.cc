// SPDX-License-Identifier: GPL-2.0-or-later
// From moves to pieces, without timing: what lies in the path is judged by positions on it.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/path/corner.hh"
#include "trajectory/test/part_rig.hh"

namespace mw::trajectory::test {
namespace {

struct BuilderRig : Parts {
    PathBuilder builder;

    explicit BuilderRig(const Limits &limits) : Parts(limits) {
        path->begin();
        builder.begin(Pose{});
    }
    Sequence line_to(const Pose &to, const MoveRequest &request) {
        return builder.add(*path, conditions, make_line(builder.end(), to), request, true);
    }
    void release() { builder.release_end(*path, conditions); }
    const Piece &piece(Sequence n) const { return path->piece(n); }
    Pose start_of(Sequence n) const { return position_at(*store, piece(n), 0); }
    Pose end_of(Sequence n) const { return position_at(*store, piece(n), piece(n).length); }
    int stops() const {
        int count = 0;
        for (Sequence n = path->first_piece(); n <= path->last_piece(); ++n) {
            count += path->plan(n).isStopBefore ? 1 : 0;
        }
        return count;
    }
    /// Nothing missing between the pieces, and no change of direction but at stops.
    void expect_continuous() const {
        for (Sequence n = path->first_piece(); n < path->last_piece(); ++n) {
            EXPECT_LT(geometry::norm(start_of(n + 1) - end_of(n)), 1e-9) << "piece " << n;
            const Pose out = derivative_at(*store, piece(n), piece(n).length);
            const Pose in = derivative_at(*store, piece(n + 1), 0);
            if (!path->plan(n + 1).isStopBefore) {
                EXPECT_LT(geometry::norm(in - out), 1e-9) << "piece " << n;
            }
        }
    }
};

TEST(PathBuilder, AMoveLiesInThePathWhenItsEndIsKnown) {
    BuilderRig rig(even_limits(100, 1000));
    rig.line_to(at(10), asking(50, geometry::PathMode::EXACT_STOP));
    EXPECT_EQ(rig.path->last_piece(), 0U);
    EXPECT_TRUE(rig.builder.hasOpenEnd());
    rig.line_to(at(10, 10), asking(50, geometry::PathMode::EXACT_STOP));
    EXPECT_EQ(rig.path->last_piece(), 0U);
    rig.line_to(at(0, 10), asking(50, geometry::PathMode::EXACT_STOP));
    EXPECT_EQ(rig.path->last_piece(), 1U);
    rig.release();
    EXPECT_EQ(rig.path->last_piece(), 3U);
    EXPECT_FALSE(rig.builder.hasOpenEnd());
    EXPECT_EQ(rig.end_of(3), at(0, 10));
    EXPECT_EQ(rig.stops(), 2);
    EXPECT_EQ(rig.store->last_piece.load(), 3U);
}

TEST(PathBuilder, ABlendRoundsTheCornerWithinTheTolerance) {
    BuilderRig rig(even_limits(100, 1000));
    rig.line_to(at(10), asking(50, geometry::PathMode::BLEND, 0.1));
    rig.line_to(at(10, 10), asking(50, geometry::PathMode::BLEND, 0.1));
    rig.release();
    EXPECT_EQ(rig.stops(), 0);
    rig.expect_continuous();
    double nearest = 100;
    for (Sequence n = 1; n <= rig.path->last_piece(); ++n) {
        for (int i = 0; i <= 100; ++i) {
            const Pose p = position_at(*rig.store, rig.piece(n), rig.piece(n).length * i / 100);
            nearest = std::min(nearest, geometry::norm(p - at(10)));
        }
    }
    EXPECT_LE(nearest, 0.1 + 1e-9);
    EXPECT_GE(nearest, 0.03);
}

TEST(PathBuilder, RandomMovesGiveAPathWithoutGapsAndKinks) {
    std::mt19937 random(7);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    int blends = 0;
    int stops = 0;
    for (int round = 0; round < 60; ++round) {
        BuilderRig rig(even_limits(100, 1000));
        Pose end;
        for (int n = 0; n < 60; ++n) {
            Pose to = rig.builder.end();
            for (int i = 0; i < 5; ++i) {
                to[i] += real(-3, 3);
            }
            const geometry::PathMode join = n % 7 == 6     ? geometry::PathMode::EXACT_STOP
                                            : n % 11 == 10 ? geometry::PathMode::EXACT_PATH
                                                           : geometry::PathMode::BLEND;
            rig.line_to(to, asking(real(5, 90), join, real(0.01, 0.2)));
            end = to;
        }
        rig.release();
        rig.expect_continuous();
        EXPECT_EQ(rig.start_of(1), Pose{});
        EXPECT_EQ(rig.end_of(rig.path->last_piece()), end);
        for (Sequence n = 1; n <= rig.path->last_piece(); ++n) {
            EXPECT_GT(rig.piece(n).length, 0);
            EXPECT_GT(rig.path->plan(n).v_limit, 0);
            EXPECT_GT(rig.piece(n).acceleration.at(0), 0);
            blends += rig.piece(n).blend_d > 0 ? 1 : 0;
        }
        stops += rig.stops();
    }
    EXPECT_GT(blends, 500);
    EXPECT_GT(stops, 500);
}

TEST(PathBuilder, NearlyStraightLinesBecomeOneUpToSomethingThatHangsOnTheirEnd) {
    BuilderRig rig(even_limits(100, 1000));
    for (int i = 1; i <= 10; ++i) {
        rig.line_to(at(i, i % 2 == 0 ? 0 : 1e-4), asking(50, geometry::PathMode::BLEND, 0.01));
    }
    EXPECT_EQ(rig.path->last_move(), 1U);
    rig.builder.keep_end();
    rig.line_to(at(11), asking(50, geometry::PathMode::BLEND, 0.01));
    EXPECT_EQ(rig.path->last_move(), 2U);
    rig.release();
    rig.expect_continuous();
}

TEST(PathBuilder, LinesThatLeaveTheToleranceOrDifferInTheirDemandsStayMoves) {
    BuilderRig rig(even_limits(100, 1000));
    rig.line_to(at(1), asking(50, geometry::PathMode::BLEND, 0.01));
    rig.line_to(at(2, 0.1), asking(50, geometry::PathMode::BLEND, 0.01));
    EXPECT_EQ(rig.path->last_move(), 2U);
    rig.line_to(at(3, 0.2), asking(40, geometry::PathMode::BLEND, 0.01));
    EXPECT_EQ(rig.path->last_move(), 3U);
    MoveRequest gated = asking(40, geometry::PathMode::BLEND, 0.01);
    gated.isGated = true;
    rig.line_to(at(4, 0.3), gated);
    EXPECT_EQ(rig.path->last_move(), 4U);
}

TEST(PathBuilder, AGateAProbeAndAChangeToASpindleAreStops) {
    for (int kind = 0; kind < 3; ++kind) {
        BuilderRig rig(even_limits(100, 1000));
        MoveRequest second = asking(50, geometry::PathMode::BLEND, 0.1);
        second.isGated = kind == 0;
        second.tag.isProbe = kind == 1;
        second.feed_per_revolution = kind == 2 ? 0.5 : 0.0;
        rig.line_to(at(10), asking(50, geometry::PathMode::BLEND, 0.1));
        rig.line_to(at(10, 10), second);
        rig.release();
        EXPECT_EQ(rig.stops(), 1) << kind;
    }
}

TEST(PathBuilder, SaysWhenTheRingsAreFullAndNeverOverrunsThem) {
    BuilderRig rig(even_limits(100, 1000));
    Snapshot now;
    int added = 0;
    double y = 0;
    while (PathBuilder::hasRoom(*rig.path, now) && added < 100000) {
        y = y > 0 ? 0.0 : 1.0;
        rig.line_to(at(++added, y), asking(50, geometry::PathMode::BLEND, 0.1));
    }
    EXPECT_LT(added, 100000);
    EXPECT_GT(added, 2000);
    rig.release();
    EXPECT_LT(rig.path->last_piece(), PIECE_CAPACITY);
    EXPECT_EQ(rig.start_of(1), Pose{});
    now.piece = rig.path->last_piece();
    EXPECT_TRUE(PathBuilder::hasRoom(*rig.path, now));
}

TEST(PathBuilder, AnArcIsCutSoThatItsDirectionChangesLittleOnEachPiece) {
    BuilderRig rig(even_limits(100, 1000));
    Primitive arc;
    Pose normal;
    normal[2] = 1;
    ASSERT_EQ(make_arc(Pose{}, at(0, 10), {at(0, 5), normal, std::numbers::pi, false}, arc), ArcFault::NONE);
    rig.builder.add(*rig.path, rig.conditions, arc, asking(500), true);
    rig.release();
    EXPECT_GE(rig.path->last_piece(), static_cast<Sequence>(std::numbers::pi / PathTuning::ARC_CUT));
    rig.expect_continuous();
}

}  // namespace
}  // namespace mw::trajectory::test
