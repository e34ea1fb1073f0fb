// SPDX-License-Identifier: GPL-2.0-or-later
// A position that follows a target within a speed and an acceleration, safe against impossible inputs.
// Realtime-safe.
#pragma once

#include <cmath>

#include "trajectory/follow/axis_motion.hh"

namespace mw::components {

struct Follower {
    trajectory::AxisMotion planner;

    double position() const noexcept { return planner.position; }
    double velocity() const noexcept { return planner.velocity; }

    /// One period of movement towards `target`. A target or a limit that is NaN, and a limit of 0 or below,
    /// stops the movement: with the last valid acceleration, or at once when there was none.
    void run(double target, double max_velocity, double max_acceleration, double dt) noexcept {
        if (max_acceleration > 0.0 && std::isfinite(max_acceleration)) {
            planner.max_acceleration = max_acceleration;
        }
        const bool possible = std::isfinite(target) && max_velocity > 0.0;
        if (possible) {
            planner.target = target;
            planner.max_velocity = max_velocity;
        } else {
            planner.stop();
        }
        planner.step(dt);
    }
    void stop(double max_acceleration, double dt) noexcept { run(NAN, 0.0, max_acceleration, dt); }
    bool isMoving() const noexcept { return !planner.isAtRest(); }
};

}  // namespace mw::components
