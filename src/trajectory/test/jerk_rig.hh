// SPDX-License-Identifier: GPL-2.0-or-later
// Planner and executor with jerk limits, and moves to feed them.
#pragma once

#include <numbers>

#include <gtest/gtest.h>

#include "trajectory/test/path_rig.hh"

namespace mw::trajectory::test {

inline constexpr double V = 100, A = 1000, J = 50000;

inline Limits jerk_limits() {
    Limits l;
    l.velocity.fill(V);
    l.acceleration.fill(A);
    l.jerk.fill(J);
    l.velocity[XYZ_NORM] = UNLIMITED;
    l.acceleration[XYZ_NORM] = UNLIMITED;
    l.jerk[XYZ_NORM] = UNLIMITED;
    l.isJerkLimited = true;
    return l;
}

inline Pose at(double x, double y = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    return p;
}

inline MoveRequest request(geometry::PathMode join, double tolerance = 0) {
    MoveRequest r;
    r.tag.requested_velocity = 80;
    r.join = join;
    r.tolerance = tolerance;
    return r;
}

/// From the origin to 2 radius in Y.
inline Primitive half_circle(double radius) {
    ArcShape shape;
    shape.centre = at(0, radius);
    shape.normal[2] = 1;
    shape.angle_rad = std::numbers::pi;
    Primitive arc;
    EXPECT_EQ(make_arc(Pose{}, at(0, 2 * radius), shape, arc), ArcFault::NONE);
    return arc;
}

/// The planner with the moving average, which drives machines whose joints are not axes.
struct AveragedRig : Rig {
    AveragedRig() : Rig(Pose{}, PlannerSettings{.third_order = false}) {}
};

struct JerkRig : AveragedRig {
    JerkRig() {
        planner.set_limits(jerk_limits());
        planner.begin(Pose{}, executor.snapshot());
    }
    void expect_within() const {
        auto checker = make_checker(jerk_limits(), T);
        for (const Pose &p : samples) {
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
};

}  // namespace mw::trajectory::test
