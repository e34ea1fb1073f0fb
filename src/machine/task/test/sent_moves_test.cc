// SPDX-License-Identifier: GPL-2.0-or-later
// The rest of moves that were taken back in the middle.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "machine/task/sequencer/sent_moves.hh"

namespace mw::task {
namespace {

/// A helix about Z as a curve, independent of the code under test.
struct Helix {
    double x = 0, y = 0, radius = 1, begin_rad = 0, angle_rad = 1, z = 0, rise = 0;

    geometry::Pose at(double part) const {
        geometry::Pose pose{};
        pose[geometry::AXIS_X] = x + radius * std::cos(begin_rad + part * angle_rad);
        pose[geometry::AXIS_Y] = y + radius * std::sin(begin_rad + part * angle_rad);
        pose[geometry::AXIS_Z] = z + part * rise;
        return pose;
    }
    double length() const { return std::hypot(radius * angle_rad, rise); }
    gcode::ArcMove move() const {
        gcode::ArcMove arc;
        arc.end = at(1);
        arc.centre[geometry::AXIS_X] = x;
        arc.centre[geometry::AXIS_Y] = y;
        arc.centre[geometry::AXIS_Z] = z;
        arc.normal[geometry::AXIS_Z] = 1;
        arc.angle_rad = angle_rad;
        return arc;
    }
};

TEST(RestOfArc, EndsWhereTheArcEndsAndTurnsAsFarAsIsLeft) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1), part(0.02, 0.98);
    for (int i = 0; i < 2000; ++i) {
        Helix helix{any(random) * 50, any(random) * 50, 0.5 + 20 * std::fabs(any(random)),
                    any(random) * 3,  any(random) * 15, any(random) * 9,
                    any(random) * 12};
        if (std::fabs(helix.angle_rad) < 0.05) {
            continue;
        }
        const double done = part(random);
        const auto rest = rest_of_arc(helix.move(), helix.at(0), helix.at(done), helix.length() * (1 - done));
        ASSERT_EQ(rest.size(), 1U) << "the place lies on it";
        const auto &arc = std::get<gcode::ArcMove>(rest[0]);
        EXPECT_NEAR(arc.angle_rad, helix.angle_rad * (1 - done), 1e-9 + 1e-9 * std::fabs(helix.angle_rad));
        EXPECT_EQ(arc.end, helix.move().end);
    }
}

TEST(RestOfArc, APlaceBesideItIsLedOntoItFirst) {
    const Helix helix{0, 0, 10, 0, 2, 0, 0};
    geometry::Pose beside = helix.at(0.5);
    beside[geometry::AXIS_X] *= 0.999;
    beside[geometry::AXIS_Y] *= 0.999;
    const auto rest = rest_of_arc(helix.move(), helix.at(0), beside, helix.length() / 2);
    ASSERT_EQ(rest.size(), 2U);
    const geometry::Pose on = std::get<gcode::LineMove>(rest[0]).end;
    EXPECT_NEAR(on.x(), helix.at(0.5).x(), 1e-9);
    EXPECT_NEAR(on.y(), helix.at(0.5).y(), 1e-9);
    EXPECT_NEAR(std::get<gcode::ArcMove>(rest[1]).angle_rad, 1, 1e-9);
}

class SentMovesTest : public testing::Test {
  protected:
    static Item line(double x) {
        gcode::LineMove move;
        move.end[geometry::AXIS_X] = x;
        return {{}, move};
    }
    SentMoves sent;
    motion::Status status;
};

TEST_F(SentMovesTest, WhatIsDoneStaysDoneAndTheRestComesBackInItsOrder) {
    for (int i = 1; i <= 4; ++i) {
        sent.note(static_cast<motion::CommandId>(i), line(i), {});
    }
    sent.note(5, {{}, gcode::SetDigitalOutput{1, true, true}}, {});
    status.last_path_id = 1;
    sent.follow(status);
    status.active_path_id = 3;
    geometry::Pose place{};
    place[geometry::AXIS_X] = 2.5;
    const auto rest = sent.rest(status, place);
    ASSERT_EQ(rest.size(), 3U);
    EXPECT_EQ(std::get<gcode::LineMove>(rest[0].call).end.x(), 3);
    EXPECT_EQ(std::get<gcode::LineMove>(rest[1].call).end.x(), 4);
    EXPECT_TRUE(std::holds_alternative<gcode::SetDigitalOutput>(rest[2].call));
    EXPECT_EQ(sent.why_not(status, place), "");
    status.active_path_id = 1;
    EXPECT_NE(sent.why_not(status, place), "") << "it is in a move that is done";
    place[geometry::AXIS_X] = 1;
    EXPECT_EQ(sent.why_not(status, place), "") << "at the end of it";
    status.isReverse = true;
    EXPECT_NE(sent.why_not(status, place), "");
}

TEST_F(SentMovesTest, TheLineIsOfTheMoveUnderWayAndThenOfTheLastOne) {
    for (int i = 1; i <= 3; ++i) {
        Item item = line(i);
        item.source.line = 10 * i;
        sent.note(static_cast<motion::CommandId>(i), item, {});
    }
    sent.note(4, {{.line = 40}, gcode::SetDigitalOutput{1, true, true}}, {});
    EXPECT_EQ(sent.line(), 0);
    status.queue_depth = 4;
    sent.follow(status);
    EXPECT_EQ(sent.line(), 10) << "it waits, for a spindle";
    status.active_path_id = 2;
    status.last_path_id = 1;
    status.source.line = 20;
    sent.follow(status);
    EXPECT_EQ(sent.line(), 20);
    status = {};
    status.last_path_id = 4;
    sent.follow(status);
    EXPECT_EQ(sent.line(), 30) << "its move was done between two looks";
    sent.clear_line();
    sent.follow(status);
    EXPECT_EQ(sent.line(), 0);
}

TEST_F(SentMovesTest, AMoveAfterAProbeBeginsWhereTheMachineIs) {
    geometry::Pose tripped{};
    tripped[geometry::AXIS_Z] = -4;
    EXPECT_EQ(sent.note(1, line(3), {}), geometry::Pose{});
    EXPECT_EQ(sent.note(2, {{}, gcode::ProbeMove{}}, {}).x(), 3);
    EXPECT_EQ(sent.note(3, line(4), tripped), tripped);
    EXPECT_EQ(sent.note(4, line(5), {}).x(), 4);
}

TEST_F(SentMovesTest, ThreadsAndProbesAreNotBegunInTheirMiddle) {
    Item thread = line(3);
    std::get<gcode::LineMove>(thread.call).settings.feed_per_revolution = 1;
    sent.note(1, thread, {});
    sent.note(2, {{}, gcode::ProbeMove{}}, {});
    status.active_path_id = 1;
    EXPECT_NE(sent.why_not(status, {}).find("spindle"), std::string::npos);
    status.active_path_id = 2;
    EXPECT_NE(sent.why_not(status, {}).find("probe"), std::string::npos);
}

}  // namespace
}  // namespace mw::task
