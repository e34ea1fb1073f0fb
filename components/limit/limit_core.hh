// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of value, rate and rate of rate, without HAL. All are realtime-safe.
#pragma once

#include <cmath>

namespace mw::limit {

/// `value` held between `low` and `high`; `high` wins when they cross.
inline double between(double value, double low, double high) noexcept {
    const double at_least = value < low ? low : value;
    return at_least > high ? high : at_least;
}

/// The largest speed to start a period with so that slowing down by `accel * dt` in every later period stops
/// within `distance`. Exact for a motion in steps of `dt`: with speeds w, w-1, w-2... (in units of accel*dt)
/// the way is (n+1)w - n(n+1)/2 with n = floor(w); solved for w.
inline double stoppable_speed(double distance, double accel, double dt) noexcept {
    if (distance <= 0.0) {
        return 0.0;
    }
    const double unit = accel * dt * dt;
    const double u = distance / unit;
    const double n = std::floor(0.5 * (std::sqrt(1.0 + 8.0 * u) - 1.0));
    return (u + 0.5 * n * (n + 1.0)) / (n + 1.0) * accel * dt;
}

/// Position, velocity and acceleration within limits, following an input without lag where the limits allow.
struct Limit3 {
    struct Bounds {
        double min = -1e20;
        double max = 1e20;
        double max_vel = 1e20;    ///< [units/s]
        double max_accel = 1e20;  ///< [units/s^2]
    };

    double out = 0.0;
    double velocity = 0.0;  ///< of `out` [units/s]
    double last_target = 0.0;

    /// Moves `out` towards `target` for one period of `dt` seconds.
    /// `smooth_steps`: the last bit of the way takes about this many periods less one (0 to 2: at once).
    void run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept;
    void load(double value) noexcept;
};

inline void Limit3::load(double value) noexcept {
    out = value;
    velocity = 0.0;
    last_target = value;
}

inline void Limit3::run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept {
    const double goal = between(target, bounds.min, bounds.max);
    // A goal that moves no faster than the output may is followed in its own frame; a jump counts as
    // standing.
    double goal_velocity = (goal - last_target) / dt;
    last_target = goal;
    if (std::fabs(goal_velocity) > bounds.max_vel) {
        goal_velocity = 0.0;
    }
    const double step = bounds.max_accel * dt;
    const double distance = goal - goal_velocity * dt - out;
    double relative = std::copysign(stoppable_speed(std::fabs(distance), bounds.max_accel, dt), distance);
    // The last part of the way, less than one period's change of speed, may be spread over more periods.
    const bool isLastPart = std::fabs(relative) <= step && smooth_steps > 2;
    if (isLastPart) {
        relative = distance / ((smooth_steps - 1) * dt);
    }
    const double wanted = between(goal_velocity + relative, -bounds.max_vel, bounds.max_vel);
    velocity = between(wanted, velocity - step, velocity + step);
    out += velocity * dt;
}

}  // namespace mw::limit
