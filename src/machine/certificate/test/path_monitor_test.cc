// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "machine/certificate/path_monitor.hh"
#include "machine/certificate/test/poses.hh"

namespace mw::machine {
namespace {

motion::TraceSample sample(const geometry::Pose &p, std::uint8_t pose_kind = 0) {
    motion::TraceSample s;
    s.carte_pos_cmd = p;
    s.path_id = 1;
    s.pose_kind = pose_kind;
    return s;
}

TEST(PathMonitor, AnotherPoseOfJointsThatStandIsNoMotion) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    for (double x = 0; x <= 1; x += 0.25) {
        monitor.on_sample(sample(at(x, 0)), false);
    }
    for (double y = 0; y <= 5; y += 0.25) {
        monitor.on_sample(sample(at(101, y), 1), false);
    }
    EXPECT_NEAR(monitor.figures().peak_velocity[0], 250, 1e-9);
    EXPECT_NEAR(monitor.figures().peak_velocity[1], 250, 1e-9);
}

TEST(PathMonitor, MovesOfRotaryAxesAloneAreDegreesAndNoLength) {
    PathMonitor monitor(1000000);
    motion::Line line;
    line.terms.isRapid = true;
    line.end = at(0, 0, 0, 90);
    monitor.on_move(at(0, 0), line);
    line.end = at(10, 0, 0, 45);  // if X moves, the length is that of X alone
    monitor.on_move(at(0, 0, 0, 90), line);
    line.terms.isRapid = false;
    line.end = at(10, 0, 0, 15);
    monitor.on_move(at(10, 0, 0, 45), line);
    EXPECT_NEAR(monitor.figures().rapid_length, 10.0, 1e-12);
    EXPECT_NEAR(monitor.figures().rapid_angle_deg, 90.0, 1e-12);
    EXPECT_NEAR(monitor.figures().cutting_length, 0.0, 1e-12);
    EXPECT_NEAR(monitor.figures().cutting_angle_deg, 30.0, 1e-12);
}

TEST(PathMonitor, PeaksComeFromDifferences) {
    PathMonitor monitor(1000000);
    monitor.start(at(0, 0));
    monitor.on_sample(sample(at(0.001, 0)), false);
    monitor.on_sample(sample(at(0.003, 0)), false);
    EXPECT_NEAR(monitor.figures().peak_velocity[0], 2.0, 1e-9);
    EXPECT_NEAR(monitor.figures().peak_acceleration[0], 1000.0, 1e-6);
}

}  // namespace
}  // namespace mw::machine
