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
/// the way is (n+1)w - n(n+1)/2 with n = floor(w); solved for w. Without an acceleration nothing can stop.
inline double stoppable_speed(double distance, double accel, double dt) noexcept {
    const double unit = accel * dt * dt;
    if (distance <= 0.0 || !(unit > 0.0)) {
        return 0.0;
    }
    const double u = distance / unit;
    const double n = std::floor(0.5 * (std::sqrt(1.0 + 8.0 * u) - 1.0));
    return (u + 0.5 * n * (n + 1.0)) / (n + 1.0) * accel * dt;
}

/// Position, velocity and acceleration within limits, following an input without lag where the limits allow.
/// The acceleration is the full one, up or down, in each period except at the largest speed and where the way
/// ends: within END_PART of the input, of min or of max, or within END_UNITS of what one period can change.
struct Limit3 {
    struct Bounds {
        double min = -1e20;
        double max = 1e20;
        double max_vel = 1e20;    ///< [units/s]
        double max_accel = 1e20;  ///< [units/s^2]
    };

    static constexpr double END_PART = 0.000999;
    /// In units of max_accel * dt^2: where full steps alone cannot land.
    static constexpr double END_UNITS = 1.0;

    double out = 0.0;
    double velocity = 0.0;  ///< of `out` [units/s]
    double last_target = 0.0;

    /// Moves `out` towards `target` for one period of `dt` seconds.
    /// `smooth_steps`: the last bit of the way takes about this many periods less one (0 to 2: at once).
    void run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept;
    void load(double value) noexcept;

  private:
    /// What one period can do.
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

/// Whether a period at `speed` ends so near to a place `remaining` away from its end that any speed is due.
inline bool Limit3::isAtEnd(double remaining, double speed, const Reach &reach) const noexcept {
    const double near = END_PART * std::fabs(out + speed * reach.dt);
    return remaining <= near || remaining <= END_UNITS * reach.step * reach.dt;
}

/// The speed that lands on a standing place `distance` (not negative) ahead.
inline double Limit3::part_at_end(double distance, const Reach &reach) noexcept {
    const double speed = stoppable_speed(distance, reach.accel, reach.dt);
    // The last part of the way, less than one period's change of speed, may be spread over more periods.
    const bool isLastPart = speed <= reach.step && reach.smooth_steps > 2;
    return isLastPart ? distance / ((reach.smooth_steps - 1) * reach.dt) : speed;
}

/// The next speed towards a goal that is `distance` away in its own frame and moves with `goal_velocity`.
inline double Limit3::approach(double distance, double goal_velocity, const Reach &reach) const noexcept {
    const double side = distance < 0.0 ? -1.0 : 1.0;
    const double way = side * distance;
    const double speed = side * velocity;
    const double landing = part_at_end(way, reach);
    const double exact = between(side * goal_velocity + landing, -reach.max_vel, reach.max_vel);
    const bool isReachable = std::fabs(exact - speed) <= reach.step;
    if (isReachable && isAtEnd(way - landing * reach.dt, side * exact, reach)) {
        return side * exact;
    }
    const double faster = between(speed + reach.step, -reach.max_vel, reach.max_vel);
    return side * (faster <= exact ? faster : speed - reach.step);
}

/// `wanted`, or less where it could not stop before `limit`, which is the upper (side 1) or lower (-1) one.
inline double Limit3::hold_before(double limit, double side, double wanted,
                                  const Reach &reach) const noexcept {
    const double room = side * (limit - out);
    if (!(room >= 0.0)) {
        return wanted;  // Outside, because the limit has moved: the goal leads back.
    }
    const double fastest = stoppable_speed(room, reach.accel, reach.dt);
    if (side * wanted <= fastest) {
        return wanted;
    }
    const double slower = side * velocity - reach.step;
    const bool canLand = slower <= fastest && isAtEnd(room - fastest * reach.dt, side * fastest, reach);
    return side * (canLand ? fastest : slower);
}

inline void Limit3::run(double target, const Bounds &bounds, double dt, unsigned smooth_steps) noexcept {
    const double low = bounds.min > bounds.max ? bounds.max : bounds.min;
    const double goal = between(target, low, bounds.max);
    // A goal that moves no faster than the output may is followed in its own frame; a jump counts as
    // standing.
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
    // Braking began ahead of the limits; this takes off what rounding adds, or stops where maxa has become
    // too small for the speed.
    const bool wasInside = out >= low && out <= bounds.max;
    const double next = out + velocity * dt;
    out = wasInside ? between(next, low, bounds.max) : next;
}

}  // namespace mw::limit
