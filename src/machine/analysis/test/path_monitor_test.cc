// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "machine/analysis/path_monitor.hh"

namespace mw::machine {
namespace {

geometry::Pose at(double x, double y, double z = 0, double a = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    p[3] = a;
    return p;
}

motion::TraceSample sample(const geometry::Pose &p, motion::CommandId id = 1) {
    motion::TraceSample s;
    s.carte_pos_cmd = p;
    s.path_id = id;
    return s;
}

TEST(PathMonitor, ANearestPointOnAHelixIsFoundInTheRightTurn) {
    ProgrammedPiece helix;
    helix.start = at(10, 0, 0);
    helix.end = at(10, 0, 4);
    helix.centre = at(0, 0);
    helix.normal = at(0, 0, 1);
    helix.angle_rad = 4 * std::numbers::pi;
    const Nearest found = PieceShape(helix).nearest(at(0, 10.5, 2.5));
    EXPECT_NEAR(found.fraction, 0.625, 1e-9);
    EXPECT_NEAR(found.linear, 0.5, 1e-9);
    EXPECT_NEAR(feed_length(helix), std::hypot(40 * std::numbers::pi, 4), 1e-9);
}

TEST(PathMonitor, DeviationIsMeasuredInOrder) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    motion::CommandId id = 0;
    for (const auto &end : {at(10, 0), at(5, 0), at(5, 5)}) {
        line.end = end;
        monitor.on_move(++id, line);
    }
    for (double x = 0; x <= 10; x += 0.25) {
        monitor.on_sample(sample(at(x, 0)));
    }
    EXPECT_NEAR(monitor.figures().deviation_linear, 0.0, 1e-12);
    for (double x = 10; x >= 5.25; x -= 0.25) {
        monitor.on_sample(sample(at(x, 0), 2));
    }
    monitor.on_sample(sample(at(5.1, 0.1), 2));
    EXPECT_NEAR(monitor.figures().deviation_linear, 0.1, 1e-9);
    EXPECT_NEAR(monitor.figures().cutting_length, 20.0, 1e-12);
}

TEST(PathMonitor, AnotherPoseOfJointsThatStandIsNoMotion) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    line.end = at(1, 0);
    monitor.on_move(1, line);
    for (double x = 0; x <= 1; x += 0.25) {
        monitor.on_sample(sample(at(x, 0)));
    }
    const auto switched = [](double y) {
        motion::TraceSample s = sample(at(101, y), 2);
        s.pose_kind = 1;
        return s;
    };
    monitor.on_sample(switched(0));
    line.end = at(101, 5);
    monitor.on_move(2, line);
    for (double y = 0; y <= 5; y += 0.25) {
        monitor.on_sample(switched(y));
    }
    EXPECT_NEAR(monitor.figures().peak_velocity[0], 250, 1e-9);
    EXPECT_NEAR(monitor.figures().peak_velocity[1], 250, 1e-9);
    EXPECT_NEAR(monitor.figures().deviation_linear, 0, 1e-9);
    EXPECT_NEAR(monitor.figures().cutting_length, 6, 1e-9);
}

TEST(PathMonitor, MovesOfRotaryAxesAloneAreDegreesAndNoLength) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    line.terms.isRapid = true;
    line.end = at(0, 0, 0, 90);
    monitor.on_move(1, line);
    line.end = at(10, 0, 0, 45);  // with X the length is that of X
    monitor.on_move(2, line);
    line.terms.isRapid = false;
    line.end = at(10, 0, 0, 15);
    monitor.on_move(3, line);
    EXPECT_NEAR(monitor.figures().rapid_length, 10.0, 1e-12);
    EXPECT_NEAR(monitor.figures().rapid_angle_deg, 90.0, 1e-12);
    EXPECT_NEAR(monitor.figures().cutting_length, 0.0, 1e-12);
    EXPECT_NEAR(monitor.figures().cutting_angle_deg, 30.0, 1e-12);
}

TEST(PathMonitor, LinesThatThePlannerHasJoinedAreAllLookedAt) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    for (int i = 1; i <= 100; ++i) {
        line.end = at(0.1 * i, std::sin(0.1 * i));
        monitor.on_move(static_cast<motion::CommandId>(i), line);
    }
    // One move replaces ten lines, and the commanded position is 0.35 behind the reference.
    for (int i = 0; i <= 1000; ++i) {
        const double x = 0.01 * i;
        const int leader = std::min(100, i / 10 + 4);
        const double y0 = std::sin(0.1 * std::floor(x / 0.1 + 1e-9));
        const double y1 = std::sin(0.1 * (std::floor(x / 0.1 + 1e-9) + 1));
        const double part = x / 0.1 - std::floor(x / 0.1 + 1e-9);
        monitor.on_sample(
            sample(at(x, y0 + (y1 - y0) * part), static_cast<motion::CommandId>((leader + 9) / 10 * 10)));
    }
    EXPECT_NEAR(monitor.figures().deviation_linear, 0.0, 1e-9);
    monitor.on_sample(sample(at(9.95, std::sin(10.0) - 1), 100));
    EXPECT_GT(monitor.figures().deviation_linear, 0.5);
}

TEST(PathMonitor, AWayBackOverTheSameLineIsLeftAgain) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    motion::CommandId id = 0;
    for (const auto &end : {at(10, 0), at(0, 0), at(0, 10)}) {
        line.end = end;
        monitor.on_move(++id, line);
    }
    for (int i = 0; i <= 100; ++i) {
        monitor.on_sample(sample(at(0.1 * i, 0), 1));
    }
    for (int i = 99; i >= 0; --i) {
        monitor.on_sample(sample(at(0.1 * i, 0), 2));
    }
    for (int i = 0; i <= 100; ++i) {
        monitor.on_sample(sample(at(0, 0.1 * i), 3));
    }
    EXPECT_NEAR(monitor.figures().deviation_linear, 0.0, 1e-9);
}

TEST(PathMonitor, AnglesAreAGroupOfTheirOwn) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    motion::Line line;
    line.end = at(10, 0, 0, 90);
    monitor.on_move(1, line);
    monitor.on_sample(sample(at(5, 0, 0, 46)));
    EXPECT_LT(monitor.figures().deviation_linear, 0.12);
    EXPECT_GT(monitor.figures().deviation_angular, 0.01);
    EXPECT_LT(monitor.figures().deviation_angular, 1.0);
}

TEST(PathMonitor, PeaksComeFromDifferences) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    monitor.on_sample(sample(at(0.001, 0)));
    monitor.on_sample(sample(at(0.003, 0)));
    EXPECT_NEAR(monitor.figures().peak_velocity[0], 2.0, 1e-9);
    EXPECT_NEAR(monitor.figures().peak_acceleration[0], 1000.0, 1e-6);
}

}  // namespace
}  // namespace mw::machine
