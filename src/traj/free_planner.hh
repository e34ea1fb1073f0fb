// SPDX-License-Identifier: GPL-2.0-or-later
// One coordinate that follows a target which may change at any time, within speed and acceleration.
// Each cycle evaluates the time-optimal profile from the present position and speed, so samples keep the
// limits.
#pragma once

namespace mw::traj {

struct FreePlanner {
    double position = 0;
    double velocity = 0;
    double target = 0;
    double max_velocity = 0;      ///< of this move [unit/s]
    double max_acceleration = 0;  ///< [unit/s^2]

    bool isAtRest() const noexcept { return velocity == 0.0 && position == target; }

    /// Stays at `at`, at rest.
    void reset(double at) noexcept {
        position = at;
        velocity = 0;
        target = at;
    }
    /// Brakes; ends where that leads.
    void stop() noexcept;
    /// Advances by `dt` [s]. [servo]
    void step(double dt) noexcept;
};

/// Position that braking at `acceleration` from here leads to.
double stop_position(double position, double velocity, double acceleration) noexcept;

}  // namespace mw::traj
