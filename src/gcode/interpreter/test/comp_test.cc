// SPDX-License-Identifier: GPL-2.0-or-later
// Cutter compensation at corners, judged by the area that the tool's disc sweeps.
#include <fmt/format.h>

#include "gcode/interpreter/test/comp_judge.hh"
#include "gcode/interpreter/test/comp_pockets.hh"

namespace mw::gcode::test {
namespace {

/// A line to the origin along X, then a return path at 180 degrees less `from_reversal`, as a line (`bend` 0)
/// or as an arc of radius 5 to the left (+1) or to the right.
CompContour way_back(int side, double from_reversal_deg, int bend, double radius) {
    CompContour c;
    c.side = side;
    c.radius = radius;
    c.entry.start = {-20, side * 2.0 * radius};
    c.entry.end = {-10, 0};
    FlatPiece line;
    line.start = {-10, 0};
    const double heading = PI + from_reversal_deg * PI / 180.0;
    FlatPiece back;
    back.end = {10.0 * std::cos(heading), 10.0 * std::sin(heading)};
    if (bend != 0) {
        back.isArc = true;
        back.centre = {-5.0 * bend * std::sin(heading), 5.0 * bend * std::cos(heading)};
        back.sweep_rad = bend * 1.4;
        back.end = back.at(1.0);
    }
    c.pieces = {line, back};
    c.exit = {-20, -20};
    return c;
}

std::string run_lines(Machine &machine, const std::string &lines) {
    machine.record.lines.clear();
    machine.record.arcs.clear();
    return machine.run("G21 G17 G90 G94 F100\nG0 X-20 Y2\nG41.1 D1\nG1 X-10 Y0\n" + lines) ==
                   Step::PROGRAM_END
               ? ""
               : machine.error();
}

TEST(Compensation, CurvatureDecidesNextToAReversalWithAnArc) {
    int cut = 0, around = 0;
    for (const int side : {1, -1}) {
        for (const int bend : {1, -1}) {
            for (const double deg : {-2.4, -1.0, -0.1, -1e-4, 0.0, 1e-4, 0.1, 1.0, 2.4}) {
                SCOPED_TRACE(fmt::format("side {}, bend {}, {} degrees", side, bend, deg));
                const CompVerdict v = judge_contour(way_back(side, deg, bend, 0.5));
                EXPECT_EQ(v.fault, "");
                EXPECT_EQ(v.refused, "");
                (bend == side ? around : cut) += 1;
            }
        }
    }
    EXPECT_EQ(cut, around);
}

TEST(Compensation, ArcsThatLeadStraightBackAreJudgedByTheirCurvatures) {
    for (const int side : {1, -1}) {
        for (const int first : {1, -1}) {
            for (const double second : {2.0, 4.0, 20.0, -2.0, -4.0, -20.0}) {
                CompContour c = way_back(side, 0.0, 0, 0.5);
                FlatPiece &in = c.pieces[0], &back = c.pieces[1];
                in.isArc = back.isArc = true;
                in.centre = {0, 8.5 * first};
                in.sweep_rad = first * 0.9;
                in.start = {-8.5 * std::sin(0.9), 8.5 * first * (1.0 - std::cos(0.9))};
                back.centre = {0, -second};
                back.sweep_rad = std::copysign(1.4 * std::fmin(1.0, 6.0 / std::fabs(second)), second);
                back.end = back.at(1.0);
                const double heading = in.heading(0);
                c.entry.end = in.start;
                c.entry.start = {in.start.x - 3.0 * std::cos(heading), in.start.y - 3.0 * std::sin(heading)};
                c.exit = back.beside(1.0, side * 4.0);
                SCOPED_TRACE(fmt::format("side {}, {} and {}", side, 8.5 * first, second));
                const CompVerdict v = judge_contour(c);
                EXPECT_EQ(v.fault, "");
                EXPECT_EQ(v.refused, "");
            }
        }
    }
}

TEST(Compensation, NotchBetweenTwoLinesIsRefused) {
    for (const double deg : {-2.0, -1.0, -0.5, -0.1}) {
        const CompVerdict v = judge_contour(way_back(1, deg, 0, 0.5));
        EXPECT_NE(v.refused, "") << deg;
    }
    EXPECT_EQ(judge_contour(way_back(1, 0.0, 0, 0.5)).refused, "") << "exactly back is around the end";
    EXPECT_EQ(judge_contour(way_back(1, 1.0, 0, 0.5)).refused, "") << "the notch is on the other side";
}

TEST(Compensation, ErrorsNameTheKindOfMove) {
    Machine machine;
    EXPECT_NE(run_lines(machine, "G1 X0 Y0\nG1 X-10 Y0.1\n")
                  .find("Straight feed in concave corner cannot be "
                        "reached by the tool without gouging"),
              std::string::npos);
    Machine other;
    EXPECT_NE(
        run_lines(other, "G1 X0 Y0\nG1 Y0.1\nG2 X1 Y1.1 I1\n").find(" in concave corner cannot be reached"),
        std::string::npos);
}

double swept(const ArcMove &arc) {
    return std::fabs(arc.angle_rad);
}

TEST(Compensation, WholeCircleBehindANearlyStraightCornerStaysWhole) {
    for (const double deg : {-2.0, -1.0, -1e-5, 0.0, 1e-5, 1.0, 2.0}) {
        for (const int rotation : {2, 3}) {
            Machine machine;
            const double a = deg * PI / 180.0, sign = rotation == 3 ? 1.0 : -1.0;
            const std::string circle = fmt::format("G{} X0 Y0 I{:.9f} J{:.9f}\n", rotation,
                                                   -sign * 5.0 * std::sin(a), sign * 5.0 * std::cos(a));
            ASSERT_EQ(run_lines(machine, "G1 X0 Y0\n" + circle + "G1 X10 Y0\n"), "") << deg;
            ASSERT_FALSE(machine.record.arcs.empty());
            EXPECT_NEAR(swept(machine.record.arcs[0]), 2.0 * PI, 0.02) << deg << ' ' << rotation;
        }
    }
}

TEST(Compensation, ArcThatTheToolDoesNotReachIsNotDrivenTheLongWayRound) {
    Machine machine;
    const double h = 0.04;
    const std::string arc =
        fmt::format("G3 X{:.9f} Y{:.9f} I{:.9f} J{:.9f}\n", 0.6 * (std::sin(0.02 + h) - std::sin(h)),
                    0.6 * (std::cos(h) - std::cos(0.02 + h)), -0.6 * std::sin(h), 0.6 * std::cos(h));
    const std::string error = run_lines(machine, "G1 X0 Y0\n" + arc + "G1 X5 Y5\n");
    EXPECT_NE(error.find("Arc move in concave corner"), std::string::npos) << error;
}

TEST(Compensation, PolygonOfFlatCornersThatIsTighterThanTheToolIsRefused) {
    Machine machine;
    std::string lines = "G1 X0 Y0\n";
    double x = 0, y = 0;
    for (int i = 1; i <= 8; ++i) {
        x += 0.012 * std::cos(0.04 * i);
        y += 0.012 * std::sin(0.04 * i);
        lines += fmt::format("G1 X{:.6f} Y{:.6f}\n", x, y);
    }
    EXPECT_NE(run_lines(machine, lines + "G1 X10 Y5\n").find("Straight feed in concave corner"),
              std::string::npos);
}

TEST(Compensation, RapidMoveAroundACornerKeepsOffIt) {
    Machine machine;
    ASSERT_EQ(run_lines(machine, "G0 X0 Y0\nG0 X0 Y-10\nG1 X10\n"), "");
    const FlatPath corner{{{-10, 0}, {0, 0}, false, {}, 0}, {{0, 0}, {0, -10}, false, {}, 0}};
    FlatPath way;
    FlatPoint at;
    for (const LineMove &move : machine.record.lines) {
        const FlatPoint to{move.end[geometry::AXIS_X], move.end[geometry::AXIS_Y]};
        if (move.settings.isRapid && !way.empty()) {
            way.push_back({at, to, false, {}, 0});
        } else {
            way = {{to, to, false, {}, 0}};
        }
        at = to;
        if (way.size() > 4) {
            break;
        }
    }
    EXPECT_LT(testing::worst_gouge(way, corner, 0.5).depth, 1e-6);
}

TEST(Compensation, InsertedArcRunsAtTheFeedOfItsBlockUnderInverseTime) {
    Machine machine;
    ASSERT_EQ(
        machine.run("G21 G17 G90 G93\nG0 X-20 Y2\nG41.1 D1\nG1 X-10 Y0 F10\nG1 X0 Y0 F20\nG1 X0 Y-10 F30\n"
                    "G1 X10 F10\n"),
        Step::PROGRAM_END)
        << machine.error();
    ASSERT_EQ(machine.record.arcs.size(), 1U);
    EXPECT_NEAR(machine.record.arcs[0].settings.feed, 10.0 * 30.0 / 60.0, 1e-9);
}

TEST(Compensation, JudgesSeeWhatIsWrong) {
    const Pocket pocket = PocketMaker(7).make();
    Pocket other = pocket;
    other.radius = pocket.radius * 0.9;
    EXPECT_NE(judge_pocket(pocket, program_of(other)).fault.find("gouge"), std::string::npos);
    other.radius = pocket.radius * 1.3;
    EXPECT_NE(judge_pocket(pocket, program_of(other)).fault.find("left standing"), std::string::npos);
    other = pocket;
    other.layer = 2.0 * pocket.layer;
    EXPECT_NE(judge_pocket(pocket, program_of(other)).fault.find("layer"), std::string::npos);
    std::string rapid = program_of(pocket);
    rapid.replace(rapid.find("\nG1 Z") + 1, 2, "G0");  // a move down to the material is not a fault
    EXPECT_EQ(judge_pocket(pocket, rapid).fault, "");
    rapid.replace(rapid.find("G41.1") != std::string::npos ? rapid.find("\nG1 ", rapid.find("G41.1")) + 1
                                                           : rapid.find("\nG1 ", rapid.find("G42.1")) + 1,
                  2, "G0");  // from the helix to the wall
    EXPECT_NE(judge_pocket(pocket, rapid).fault.find("rapid"), std::string::npos);

    const CompContour contour = way_back(1, 120.0, 0, 0.5);
    ASSERT_EQ(judge_contour(contour).fault, "");
    CompContour wrong = contour;
    wrong.radius = 0.4;
    EXPECT_NE(judge_contour(contour, program_of(wrong)).fault.find("gouge"), std::string::npos);
    wrong.radius = 0.6;
    EXPECT_NE(judge_contour(contour, program_of(wrong)).fault.find("not cut"), std::string::npos);
    wrong = contour;
    wrong.side = -1;
    EXPECT_NE(judge_contour(contour, program_of(wrong)).fault, "");
}

TEST(Compensation, RandomPocketsLeaveTheirWallsStanding) {
    constexpr unsigned COUNT = 40, FIRST = 2000001;
    for (unsigned seed = FIRST; seed < FIRST + COUNT; ++seed) {
        EXPECT_EQ(judge_pocket(PocketMaker(seed).make()).fault, "") << "seed " << seed;
    }
}

TEST(Compensation, RandomContoursAreCutWithoutGouge) {
    constexpr unsigned COUNT = 400, FIRST = 1000001;
    unsigned refused = 0;
    for (unsigned seed = FIRST; seed < FIRST + COUNT; ++seed) {
        const CompVerdict v = judge_contour(ContourMaker(seed).make());
        EXPECT_EQ(v.fault, "") << "seed " << seed;
        refused += v.refused.empty() ? 0 : 1;
    }
    EXPECT_LE(refused, COUNT / 50);
}

}  // namespace
}  // namespace mw::gcode::test
