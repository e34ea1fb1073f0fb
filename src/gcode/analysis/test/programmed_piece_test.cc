// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "gcode/analysis/programmed_piece.hh"

namespace mw::gcode {
namespace {

geometry::Pose at(double x, double y, double z = 0, double a = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    p[3] = a;
    return p;
}

/// The smallest distance among closely spaced points of the piece.
double searched(const PieceShape &shape, const geometry::Pose &p, double from) {
    constexpr int STEPS = 20000;
    double least = 1e300;
    for (int i = 0; i <= STEPS; ++i) {
        const geometry::Pose d = p - shape.point_at(from + (1 - from) * i / STEPS);
        least = std::min(least, std::max(geometry::norm_linear(d), geometry::norm_abc(d)));
    }
    return least;
}

TEST(ProgrammedPiece, FeedLengthIsThatOfTheHelix) {
    ProgrammedPiece helix;
    helix.start = at(10, 0, 0);
    helix.end = at(10, 0, 4);
    helix.normal = at(0, 0, 1);
    helix.angle_rad = 4 * std::numbers::pi;
    EXPECT_NEAR(feed_length(helix), std::hypot(40 * std::numbers::pi, 4), 1e-9);
}

TEST(ProgrammedPiece, PartsOfAnArcAreTheArc) {
    ProgrammedPiece helix;
    helix.start = at(10, 0, 0, 5);
    helix.end = at(0, 10.1, 4, 25);  // the radius grows
    helix.normal = at(0, 0, 2);      // the normal may have any length
    helix.angle_rad = 4.5 * std::numbers::pi;
    const PieceShape whole(helix);
    const geometry::Pose end = whole.point_at(1);
    EXPECT_NEAR(geometry::norm(end - helix.end), 0, 1e-12);
    for (int i = 0; i < 18; ++i) {
        const PieceShape part(whole.part_of(i, 18));
        for (const double f : {0.0, 0.3, 1.0}) {
            const geometry::Pose d = part.point_at(f) - whole.point_at((i + f) / 18);
            // the growth is relative to the radius at its start
            EXPECT_NEAR(geometry::norm(d), 0, 1e-3) << i << ' ' << f;
        }
    }
}

TEST(ProgrammedPiece, NearestPointIsThatOfAFineSearch) {
    ProgrammedPiece line;
    line.start = at(0, 0, 0, 0);
    line.end = at(10, 0, 0, 90);
    ProgrammedPiece helix;
    helix.start = at(3, 0, 0, 0);
    helix.end = at(0, 3, 5, 3);
    helix.normal = at(0, 0, 1);
    helix.angle_rad = std::numbers::pi / 2;
    ProgrammedPiece clockwise;
    clockwise.start = at(0, 3, 0);
    clockwise.end = at(3, 0, 0);
    clockwise.normal = at(0, 0, 1);
    clockwise.angle_rad = -std::numbers::pi / 2;
    for (const ProgrammedPiece &piece : {line, helix, clockwise}) {
        const PieceShape shape(piece);
        for (const double f : {-0.1, 0.0, 0.2, 0.5, 0.77, 1.0, 1.1}) {
            for (const auto &aside : {at(0, 0), at(0.3, 0.2, 0.1, 0), at(-0.01, 0.02, 0.1, 1.5)}) {
                for (const double from : {0.0, 0.4}) {
                    const geometry::Pose p = shape.point_at(f) + aside;
                    const Nearest found = shape.nearest(p, from);
                    EXPECT_GE(found.fraction, from);
                    EXPECT_LE(found.fraction, 1);
                    // at most half a step from the nearest point
                    const double other = searched(shape, p, from);
                    EXPECT_LE(found.distance(), other + 1e-9) << f;
                    EXPECT_GE(found.distance(), other - 3e-3) << f;
                }
            }
        }
    }
}

TEST(ProgrammedPiece, ArcsInUvwAreThere) {
    ProgrammedPiece arc;
    arc.isInUvw = true;
    arc.start[geometry::AXIS_U] = 2;
    arc.end[geometry::AXIS_V] = 2;
    arc.normal[geometry::AXIS_W] = 1;
    arc.angle_rad = std::numbers::pi / 2;
    const PieceShape shape(arc);
    EXPECT_NEAR(shape.point_at(0.5)[geometry::AXIS_U], std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(shape.point_at(0.5)[geometry::AXIS_V], std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(feed_length(arc), std::numbers::pi, 1e-12);
    geometry::Pose p = shape.point_at(0.25);
    p[geometry::AXIS_W] = 0.5;
    EXPECT_NEAR(shape.nearest(p).linear, 0.5, 1e-12);
    EXPECT_NEAR(shape.nearest(p).fraction, 0.25, 1e-12);
}

}  // namespace
}  // namespace mw::gcode
