// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the picture of screens: the position of nine coordinates in it, and the path behind the tool.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "clients/python/linuxcnc/logged_path.hh"
#include "clients/python/linuxcnc/view_geometry.hh"

namespace mw::python {
namespace {

void expect_near(const Vertex &seen, const Vertex &wanted) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_NEAR(seen[i], wanted[i], 1e-9) << i;
    }
}

geometry::Pose pose(std::initializer_list<double> values) {
    geometry::Pose made;
    int axis = 0;
    for (const double value : values) {
        made[axis++] = value;
    }
    return made;
}

TEST(ViewGeometryTest, LettersMoveAndTurnInTheirOrder) {
    const RotationCentre machine;
    expect_near(vertex_of("XYZ", pose({1, 2, 3}), machine), {1, 2, 3});
    expect_near(vertex_of("-Y X-Z", pose({1, 2, 3}), machine), {1, -2, -3});
    expect_near(vertex_of("XYZUVW", pose({1, 2, 3, 0, 0, 0, 10, 20, 30}), machine), {11, 22, 33});
    expect_near(vertex_of("XYZA", pose({0, 0, 10, 90}), machine), {0, -10, 0});
    expect_near(vertex_of("AXYZ", pose({0, 0, 10, 90}), machine), {0, 0, 10});
    expect_near(vertex_of("XYZB", pose({0, 0, 10, 0, 90}), machine), {-10, 0, 0});
    expect_near(vertex_of("XYZC", pose({10, 0, 0, 0, 0, 90}), machine), {0, 10, 0});
}

TEST(ViewGeometryTest, TheCentreOfRotationsIsThatOfTheMachineOrOfTheWorkPiece) {
    ViewGeometry view;
    view.place_origin({1, 2, 3});
    view.choose("XYZA", false);
    expect_near(vertex_of("XYZA", pose({0, 0, 10, 90}), view.centre()), {0, -10, 0});
    // the machine has no B
    expect_near(vertex_of("XYZB", pose({0, 0, 10, 0, 90}), view.centre()), {0, 0, 10});
    view.choose("XYZA", true);
    expect_near(vertex_of("XYZA", pose({0, 2, 3, 77}), view.centre()), {0, 2, 3});
    expect_near(vertex_of("XYZA", pose({0, 0, 10, 0}), view.centre()), {0, 0, 10});
    expect_near(vertex_of("XYZA", pose({0, 0, 10, 90}), view.centre()), {0, -5, 1});
}

LoggedPoint at(double x, double y, std::uint8_t colour = 1) {
    LoggedPoint point;
    point.x = static_cast<float>(x);
    point.y = static_cast<float>(y);
    point.colour = point.other_colour = {colour, 0, 0, 255};
    return point;
}

TEST(LoggedPathTest, AStraightLineIsTwoPointsAndEachCornerStays) {
    LoggedPath path;
    for (int i = 0; i <= 1000; ++i) {
        path.add(at(i * 0.01, 0));
    }
    EXPECT_EQ(path.points().size(), 2U);
    for (int i = 1; i <= 1000; ++i) {
        path.add(at(10, i * 0.01));
    }
    for (int i = 1; i <= 500; ++i) {
        path.add(at(10, 10 - i * 0.01));  // back along the same line
    }
    path.add(at(10, 5));  // stopped
    ASSERT_EQ(path.points().size(), 4U);
    EXPECT_EQ(path.points()[1].x, 10.0F);
    EXPECT_EQ(path.points()[2].y, 10.0F);
    EXPECT_EQ(path.points()[3].y, 5.0F);
}

TEST(LoggedPathTest, AnArcOfAnyFinenessStaysAnArc) {
    for (const int samples : {50, 1000, 20000}) {
        LoggedPath path;
        for (int i = 0; i <= samples; ++i) {
            const double angle = 2 * std::numbers::pi * i / samples;
            path.add(at(20 * std::cos(angle), 20 * std::sin(angle)));
        }
        // The middle of each line is near the circle, too.
        const auto &points = path.points();
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double x = (points[i - 1].x + points[i].x) / 2, y = (points[i - 1].y + points[i].y) / 2;
            EXPECT_NEAR(std::hypot(x, y), 20, 0.05) << samples;
        }
        EXPECT_LT(points.size(), 300U) << samples;
    }
}

TEST(LoggedPathTest, ANewColourBeginsWhereTheOldOneEnds) {
    LoggedPath path;
    path.add(at(0, 0, 1));
    path.add(at(1, 0, 1));
    path.add(at(2, 0, 2));
    ASSERT_EQ(path.points().size(), 4U);
    EXPECT_EQ(path.points()[2].x, 1.0F);
    EXPECT_EQ(path.points()[2].colour[0], 2);
    EXPECT_EQ(path.points()[3].x, 2.0F);
}

}  // namespace
}  // namespace mw::python
