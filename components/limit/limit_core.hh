// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of value, rate and rate of rate, without HAL. All are realtime-safe.
#pragma once

#include <cmath>

namespace mw::limit {

/// `value` clamped to `low` and `high`; `high` wins when they cross.
inline double between(double value, double low, double high) noexcept {
    const double at_least = value < low ? low : value;
    return at_least > high ? high : at_least;
}

/// The maximum speed for this period from which braking by `accel * dt` in every later period stops within
/// `distance`. Exact for motion in steps of `dt`: with the speeds w, w-1, w-2... (in units of accel*dt) the
/// distance is (n+1)w - n(n+1)/2 with n = floor(w); this is solved for w. Without acceleration nothing can
/// stop.
inline double stoppable_speed(double distance, double accel, double dt) noexcept {
    const double unit = accel * dt * dt;
    if (distance <= 0.0 || !(unit > 0.0)) {
        return 0.0;
    }
    const double u = distance / unit;
    const double n = std::floor(0.5 * (std::sqrt(1.0 + 8.0 * u) - 1.0));
    return (u + 0.5 * n * (n + 1.0)) / (n + 1.0) * accel * dt;
}

/// Keeps position, velocity and acceleration within limits, and follows the input without lag where the
/// limits allow it. Every period uses the full acceleration, up or down, except at the maximum speed and at
/// the end of a movement: within END_PART of the input, of min or of max, or within END_UNITS of the change
/// that one period can make.
struct Limit3 {
    struct Bounds {
        double min = -1e20;
        double max = 1e20;
        double max_vel = 1e20;    ///< [units/s]
        double max_accel = 1e20;  ///< [units/s^2]
    };

    static constexpr double END_PART = 0.000999;
    /// In units of max_accel * dt^2: the range in which full steps alone cannot reach the target.
    static constexpr double END_UNITS = 1.0;

    double out = 0.0;
    double velocity = 0.0;  ///< of `out` [units/s]
    double last_target = 0.0;

    /// Moves `out` towards `target` for one period of `dt` seconds. `smooth_steps`: the end of the movement
    /// takes about this many periods minus one (0 to 2: one period).
    void run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept;
    void load(double value) noexcept;

  private:
    /// The largest changes in one period.
    struct Reach {
        double dt;
        double accel;
        double step;  ///< change of speed
        double max_vel;
        unsigned smooth_steps;
    };

    static double part_at_end(double distance, const Reach &reach) noexcept;
    double approach(double distance, double goal_velocity, const Reach &reach) const noexcept;
    double hold_before(double limit, double side, double wanted, const Reach &reach) const noexcept;
    bool isAtEnd(double remaining, double speed, const Reach &reach) const noexcept;
};

inline void Limit3::load(double value) noexcept {
    out = value;
    velocity = 0.0;
    last_target = value;
}

/// Whether a period at `speed` ends so close to a target `remaining` away that any speed is allowed.
inline bool Limit3::isAtEnd(double remaining, double speed, const Reach &reach) const noexcept {
    const double near = END_PART * std::fabs(out + speed * reach.dt);
    return remaining <= near || remaining <= END_UNITS * reach.step * reach.dt;
}

/// The speed with which the output can still stop at a fixed target `distance` (not negative) ahead.
inline double Limit3::part_at_end(double distance, const Reach &reach) noexcept {
    const double speed = stoppable_speed(distance, reach.accel, reach.dt);
    // The last part of the movement, less than the change of speed in one period, may be spread over more
    // periods.
    const bool is_last_part = speed <= reach.step && reach.smooth_steps > 2;
    return is_last_part ? distance / ((reach.smooth_steps - 1) * reach.dt) : speed;
}

/// The next speed towards a target at `distance`, where the target moves with `goal_velocity`.
inline double Limit3::approach(double distance, double goal_velocity, const Reach &reach) const noexcept {
    const double side = distance < 0.0 ? -1.0 : 1.0;
    const double way = side * distance;
    const double speed = side * velocity;
    const double landing = part_at_end(way, reach);
    const double exact = between(side * goal_velocity + landing, -reach.max_vel, reach.max_vel);
    const bool reachable = std::fabs(exact - speed) <= reach.step;
    if (reachable && isAtEnd(way - landing * reach.dt, side * exact, reach)) {
        return side * exact;
    }
    const double faster = between(speed + reach.step, -reach.max_vel, reach.max_vel);
    return side * (faster <= exact ? faster : speed - reach.step);
}

/// `wanted`, or less if the output could not stop before `limit`; the limit is the upper (side 1) or the
/// lower (-1) one.
inline double Limit3::hold_before(double limit, double side, double wanted,
                                  const Reach &reach) const noexcept {
    const double room = side * (limit - out);
    if (!(room >= 0.0)) {
        return wanted;  // The output is outside because the limit has moved; the target is inside.
    }
    const double fastest = stoppable_speed(room, reach.accel, reach.dt);
    if (side * wanted <= fastest) {
        return wanted;
    }
    const double slower = side * velocity - reach.step;
    const bool landing_possible =
        slower <= fastest && isAtEnd(room - fastest * reach.dt, side * fastest, reach);
    return side * (landing_possible ? fastest : slower);
}

inline void Limit3::run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept {
    const double low = bounds.min > bounds.max ? bounds.max : bounds.min;
    const double goal = between(target, low, bounds.max);
    // A target that moves no faster than the permitted speed of the output is followed relative to its
    // motion; a target that jumps counts as standing still.
    const double accel = bounds.max_accel > 0.0 ? bounds.max_accel : 0.0;
    const Reach reach{dt, accel, accel * dt, bounds.max_vel > 0.0 ? bounds.max_vel : 0.0, smooth_steps};
    double goal_velocity = (goal - last_target) / dt;
    last_target = goal;
    if (std::fabs(goal_velocity) > reach.max_vel) {
        goal_velocity = 0.0;
    }
    const double free = approach(goal - goal_velocity * dt - out, goal_velocity, reach);
    const double below = hold_before(bounds.max, 1.0, free, reach);
    const double wanted = hold_before(low, -1.0, below, reach);
    velocity = between(wanted, velocity - reach.step, velocity + reach.step);
    // Braking started before the limits were reached. This removes rounding errors, or stops the output when
    // maxa has become too small for the speed.
    const bool was_inside = out >= low && out <= bounds.max;
    const double next = out + velocity * dt;
    out = was_inside ? between(next, low, bounds.max) : next;
}

}  // namespace mw::limit
