// SPDX-License-Identifier: GPL-2.0-or-later
// Cutter compensation in isolation: moves in, moves of the tool centre out.
#include <numbers>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

/// Moves between points in the plane XY.
class Path {
  public:
    explicit Path(CompSide side, double radius) { comp.turn_on(side, G(41, 1), radius, 0); }

    bool line_to(double x, double y) { return go(x, y, false); }
    bool rapid_to(double x, double y) { return go(x, y, true); }
    bool arc_to(double x, double y, double centre_x, double centre_y, int rotation) {
        Pose end = position;
        end[geometry::AXIS_X] = x;
        end[geometry::AXIS_Y] = y;
        const bool done = comp.move_along_arc({position, Plane::XY, LengthUnits::MM},
                                              {end, centre_x, centre_y, rotation}, canon, fault);
        position = end;
        return done;
    }
    /// Ends of all moves, in the plane.
    std::vector<Point> ends() {
        class Ends final : public Canon {
          public:
            std::vector<Point> points;
            void begin_block(const BlockRef &) override {}
            void take(const CanonCall &call) override {
                std::visit(
                    [this]<class Call>(const Call &one) {
                        if constexpr (OneOf<Call, StraightFeed, StraightTraverse, ArcFeed>) {
                            points.push_back({one.end[geometry::AXIS_X], one.end[geometry::AXIS_Y]});
                        }
                    },
                    call);
            }
        };
        Ends out;
        canon.flush(out);
        return out.points;
    }

    Compensation comp;
    CanonQueue canon;
    Fault fault;
    Pose position;

  private:
    bool go(double x, double y, bool rapid) {
        Pose end = position;
        end[geometry::AXIS_X] = x;
        end[geometry::AXIS_Y] = y;
        const bool done =
            comp.move_straight({position, Plane::XY, LengthUnits::MM}, rapid, end, canon, fault);
        position = end;
        return done;
    }
};

void expect_ends(Path &path, const std::vector<Point> &wanted) {
    const std::vector<Point> found = path.ends();
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].x, wanted[i].x, 1e-9) << i;
        EXPECT_NEAR(found[i].y, wanted[i].y, 1e-9) << i;
    }
}

TEST(CompensationAlone, TheEntryEndsBesideTheContour) {
    Path path(CompSide::LEFT, 1.0);
    EXPECT_FALSE(path.comp.hasMoved());
    ASSERT_TRUE(path.line_to(10, 0));
    EXPECT_TRUE(path.comp.hasMoved());
    expect_ends(path, {{10, 1}});
}

TEST(CompensationAlone, AnEntryShorterThanTheRadiusIsRefused) {
    Path path(CompSide::LEFT, 2.0);
    EXPECT_FALSE(path.line_to(1.5, 0));
    EXPECT_EQ(path.fault.message,
              "Length of cutter compensation entry move is not greater than the tool radius");
}

TEST(CompensationAlone, AConcaveCornerShortensTheMoveThatWaits) {
    Path path(CompSide::LEFT, 1.0);
    ASSERT_TRUE(path.line_to(10, 0));
    ASSERT_TRUE(path.line_to(20, 0));
    ASSERT_TRUE(path.line_to(20, 10));
    expect_ends(path, {{10, 1}, {19, 1}, {19, 10}});
}

TEST(CompensationAlone, AConvexCornerIsPassedOnAnArcAboutIt) {
    Path path(CompSide::RIGHT, 1.0);
    ASSERT_TRUE(path.line_to(10, 0));
    ASSERT_TRUE(path.line_to(10, 10));
    expect_ends(path, {{10, -1}, {11, 0}, {11, 10}});
}

TEST(CompensationAlone, ARapidMoveGoesAroundACornerOutsideOfItsCircle) {
    Path path(CompSide::RIGHT, 1.0);
    ASSERT_TRUE(path.rapid_to(10, 0));
    ASSERT_TRUE(path.rapid_to(10, 10));
    const std::vector<Point> ends = path.ends();
    ASSERT_GT(ends.size(), 3U);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        EXPECT_GE(distance(ends[i], {10, 0}), 1.0 - 1e-9) << i;
    }
}

TEST(CompensationAlone, ArcsKeepTheirCentreAndLoseOrGainTheRadius) {
    Path inside(CompSide::LEFT, 1.0), outside(CompSide::RIGHT, 1.0);
    for (Path *path : {&inside, &outside}) {
        ASSERT_TRUE(path->line_to(10, 0));
        ASSERT_TRUE(path->arc_to(15, 5, 10, 5, 1));
    }
    expect_ends(inside, {{10, 1}, {14, 5}});
    expect_ends(outside, {{10, -1}, {16, 5}});
}

TEST(CompensationAlone, AnArcThatTheToolDoesNotFitIsRefused) {
    Path path(CompSide::LEFT, 5.0);
    ASSERT_TRUE(path.line_to(10, 0));
    EXPECT_FALSE(path.arc_to(15, 5, 10, 5, 1));
    EXPECT_EQ(path.fault.message, "Tool radius not less than arc radius with comp");
}

TEST(CompensationAlone, ACornerThatTheToolDoesNotReachIsRefused) {
    Path path(CompSide::LEFT, 3.0);
    ASSERT_TRUE(path.line_to(10, 0));
    ASSERT_TRUE(path.line_to(12, 0));
    EXPECT_FALSE(path.line_to(12, 10));
    EXPECT_TRUE(path.fault.message.find("cannot be reached by the tool without gouging") !=
                std::string::npos);
}

TEST(CompensationAlone, ACopyTakesABlockBack) {
    Path path(CompSide::LEFT, 1.0);
    ASSERT_TRUE(path.line_to(10, 0));
    const Compensation before = path.comp;
    path.canon.begin_undo();
    ASSERT_TRUE(path.line_to(10, 10));
    EXPECT_NE(path.comp, before);
    path.comp = before;
    path.canon.rollback();
    expect_ends(path, {{10, 1}});  // the failed corner must not have shortened the move
}

TEST(CompensationAlone, HoldsTheLastMoveUntilItIsOff) {
    Path path(CompSide::LEFT, 1.0);
    EXPECT_FALSE(path.comp.isHolding());
    ASSERT_TRUE(path.line_to(10, 0));
    ASSERT_TRUE(path.line_to(20, 0));
    EXPECT_TRUE(path.comp.isHolding());
    EXPECT_EQ(path.comp.held_call(), 1U);
    path.comp.turn_off();
    EXPECT_FALSE(path.comp.isHolding());
    EXPECT_TRUE(path.comp.isExit());
}

TEST(CompensationAlone, OffWithoutAMoveAsksForNoStraightExit) {
    Path path(CompSide::LEFT, 1.0);
    path.comp.turn_off();
    EXPECT_FALSE(path.comp.isOn());
    EXPECT_FALSE(path.comp.isExit());
}

TEST(CompensationAlone, ALatheToolIsLedByItsControlledPoint) {
    // Orientation 2 in the plane of Z and X: the controlled point is at (-1, -1) radii from the nose's
    // centre.
    constexpr int ORIENTATION = 2;
    Compensation comp;
    comp.turn_on(CompSide::LEFT, G(41, 1), 0.5, ORIENTATION);
    CanonQueue canon;
    Fault fault;
    const Pose from;
    Pose end;
    end[geometry::AXIS_Z] = 10;
    ASSERT_TRUE(comp.move_straight({from, Plane::XZ, LengthUnits::MM}, false, end, canon, fault));
    const Pose place = comp.compensated(end, Plane::XZ);
    EXPECT_NEAR(place[geometry::AXIS_Z], 9.5, 1e-12);
    EXPECT_NEAR(place[geometry::AXIS_X], 0.0, 1e-12);
}

CompElement straight(Point from, Point to, const CornerTool &tool) {
    CompElement one;
    one.set = true;
    one.from = from;
    one.to = to;
    one.start_direction = one.end_direction = unit(from, to);
    one.start = sum(from, side_normal(tool.side, one.start_direction), tool.radius);
    one.end = sum(to, side_normal(tool.side, one.start_direction), tool.radius);
    return one;
}

TEST(CompCorner, IsDecidedByWhereTheNextMoveTurns) {
    const CornerTool tool{CompSide::LEFT, 1.0, 0.005, 0.0005};
    const CompElement last = straight({0, 0}, {10, 0}, tool);
    const auto corner = [&](Point to) {
        return decide_corner(last, straight({10, 0}, to, tool), {10, 0}, tool);
    };
    EXPECT_EQ(corner({20, 0}).kind, CornerKind::STRAIGHT);
    EXPECT_EQ(corner({10, -10}).kind, CornerKind::AROUND);
    const Corner cut = corner({10, 10});
    ASSERT_EQ(cut.kind, CornerKind::CUT);
    EXPECT_NEAR(cut.cut.x, 9.0, 1e-12);
    EXPECT_NEAR(cut.cut.y, 1.0, 1e-12);
    EXPECT_EQ(corner({10, 0.5}).kind, CornerKind::BLOCKED);  // shorter than the tool's radius
}

TEST(CompCorner, SweepsOfArcsCountInTheirDirection) {
    CompElement arc;
    arc.isArc = true;
    EXPECT_NEAR(comp_sweep(arc, {1, 0}, {0, 1}), std::numbers::pi / 2, 1e-12);
    arc.rotation = -1;
    EXPECT_NEAR(comp_sweep(arc, {1, 0}, {0, 1}), 1.5 * std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace mw::gcode::detail
