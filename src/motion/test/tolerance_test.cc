// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits a path is planned for its tolerance. A program that changes to a much smaller tolerance
// gets a new path for it, from a stop.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

constexpr double V = 100, A = 2000, J = 10000;

/// Time [s] of a coarse line and back, then a circle of chords within 0.01.
double run_program(double first_tolerance) {
    MotionRig rig("XYZ", V, A);
    std::vector<testing::AxisLimit> limits;
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::AXIS_MAX_JERK, j, J);
        rig.set(Parameter::JOINT_MAX_JERK, j, J);
        limits.push_back({V, A, J});
    }
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.ready();
    testing::LimitChecker checker(limits, MotionRig::T);
    geometry::Pose at;
    at[0] = 20;
    rig.line(at, 80, PathMode::BLEND, first_tolerance);
    at[0] = 0;
    rig.line(at, 80, PathMode::BLEND, first_tolerance);
    for (int i = 1; i <= 120; ++i) {
        const double angle = 2 * std::numbers::pi * i / 120;
        at[0] = 5 * std::sin(angle);
        at[1] = 5 * (1 - std::cos(angle));
        rig.line(at, 80, PathMode::BLEND, 0.01);
    }
    const CommandId flush = rig.send_path(Flush{});
    int cycles = 0;
    while (!rig.isDone(flush) && ++cycles < 60000) {
        rig.step();
        double p[3];
        for (std::size_t j = 0; j < 3; ++j) {
            p[j] = rig.out->joint[j].motor_pos_cmd;
        }
        checker.sample(p);
    }
    EXPECT_TRUE(rig.isDone(flush));
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    return cycles * MotionRig::T;
}

TEST(Tolerance, AReducedToleranceCausesAStopAndNotSlowerCurves) {
    const double alone = run_program(0.01);
    EXPECT_LT(run_program(1.0), alone + 0.2);
}

TEST(Tolerance, AReducedToleranceKeepsSingleSteps) {
    MotionRig rig("XYZ", V, A);
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::AXIS_MAX_JERK, j, J);
        rig.set(Parameter::JOINT_MAX_JERK, j, J);
    }
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.ready();
    rig.send(Pause{});
    rig.step(2);
    for (int i = 1; i <= 3; ++i) {
        geometry::Pose at;
        at[0] = 10.0 * i;
        rig.line(at, 50, PathMode::BLEND, std::pow(0.01, i));
    }
    rig.send_path(Flush{});
    for (int i = 1; i <= 3; ++i) {
        rig.send(StepOnce{});
        rig.step(2000);
        EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 10.0 * i, 1e-9);
        EXPECT_TRUE(rig.status().isPaused || i == 3);
    }
}

}  // namespace
}  // namespace mw::motion
