// SPDX-License-Identifier: GPL-2.0-or-later
// The comparison trajectories must be correct themselves: tests closed forms, limits, tolerance.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/deviation.hh"
#include "tests/support/limit_checker.hh"
#include "traj/jerk_bound.hh"

namespace mw::bench {
namespace {

constexpr double V = 200, A = 1000, J = 50000;

Program program_to(std::initializer_list<Pose> ends) {
    Program p;
    p.tolerance = 0.02;
    p.max_velocity.c.fill(V);
    p.max_acceleration.c.fill(A);
    p.max_jerk.c.fill(J);
    for (const Pose &end : ends) {
        Move m;
        m.end = end;
        p.moves.push_back(m);
    }
    return p;
}

/// Time from stop to stop over `length` with limits V, A, J.
double s_curve_time(double length) {
    const double tau = A / J;
    if (length >= V * V / A + V * tau) {
        return length / V + V / A + tau;
    }
    if (length >= 2.0 * A * tau * tau) {
        const double peak = 0.5 * (-tau * A + std::sqrt(tau * tau * A * A + 4.0 * length * A));
        return length / peak + peak / A + tau;
    }
    return 4.0 * std::cbrt(length / (2.0 * J));
}

Pose at(double x, double y) {
    Pose p;
    p[0] = x;
    p[1] = y;
    return p;
}

TEST(JerkBound, LineIsTheClosedForm) {
    for (const double length : {0.05, 1.0, 20.0, 100.0}) {
        const Trajectory t = best_known_trajectory(program_to({at(length, 0)}));
        // Samples contain averages of jerk over a period, so they may be faster by about that.
        EXPECT_NEAR(t.time_s, s_curve_time(length), 1.5e-3) << length;
    }
}

TEST(JerkBound, CornerKeepsLimitsAndTolerance) {
    const Program program = program_to({at(10, 0), at(10, 10)});
    const Trajectory t = best_known_trajectory(program);
    testing::LimitChecker checker({{V, A, J}, {V, A, J}}, t.period_s);
    for (const Pose &p : t.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LT(t.time_s, 2 * s_curve_time(10) - 0.02);
    const double step = program.tolerance / 16;
    const double deviation =
        testing::deviation_in_order(t.samples, sample_path(program, step), step, 10 * program.tolerance);
    EXPECT_LE(deviation, program.tolerance + step);
    EXPECT_LT(geometry::norm(t.samples.back() - program.moves.back().end), 1e-6);
}

}  // namespace
}  // namespace mw::bench
