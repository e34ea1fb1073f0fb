// SPDX-License-Identifier: GPL-2.0-or-later
// Runs planner and executor in virtual time, with random programs.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "tests/support/limit_checker.hh"
#include "trajectory/follow/executor.hh"
#include "trajectory/planner.hh"

namespace mw::trajectory::test {

struct Rig {
    static constexpr double T = 1e-3;
    std::unique_ptr<PathStore> store = std::make_unique_for_overwrite<PathStore>();
    Executor executor{*store, T};
    Planner planner;
    std::uint64_t cycle = 0;
    std::vector<Pose> samples;
    int planner_period = 5;
    bool isPlannerAlive = true;

    explicit Rig(const Pose &start, SpeedChooser *chooser = nullptr)
        : Rig(start, PlannerSettings{.chooser = chooser}) {}
    Rig(const Pose &start, const PlannerSettings &settings) : planner(*store, settings) {
        executor.set_position(start);
        executor.step(cycle);
        planner.begin(start, executor.snapshot());
        samples.push_back(start);
    }
    void step() {
        ++cycle;
        samples.push_back(executor.step(cycle).position);
        if (isPlannerAlive && cycle % static_cast<std::uint64_t>(planner_period) == 0) {
            planner.update(executor.snapshot());
        }
    }
    /// Runs until the path is complete. False if that takes longer than `max_s` [s].
    bool run(double max_s) {
        planner.release_end();
        for (int i = 0; i < max_s / T; ++i) {
            step();
            if (executor.isAtRest() && executor.snapshot().done_move >= planner.last_move()) {
                return true;
            }
        }
        return false;
    }
};

inline testing::LimitChecker make_checker(const Limits &limits, double period) {
    std::vector<testing::AxisLimit> axes;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        axes.push_back(
            {limits.velocity[i], limits.acceleration[i], limits.isJerkLimited ? limits.jerk[i] : 1e300});
    }
    return {axes, period};
}

}  // namespace mw::trajectory::test
