// SPDX-License-Identifier: GPL-2.0-or-later
// One coordinate that moves to a target which may change at any time, as do its limits: velocity,
// acceleration and, where set, jerk. Each cycle follows the fastest motion from the present state, so all
// samples keep the limits.
#pragma once

#include "trajectory/path/limited_motion.hh"

namespace mw::trajectory {

/// All functions: servo thread.
class AxisMotion {
  public:
    double position = 0;
    double velocity = 0;
    double acceleration = 0;  ///< 0 without a jerk limit
    double target = 0;
    double max_velocity = 0;      ///< of this move [unit/s]
    double max_acceleration = 0;  ///< [unit/s^2]
    double max_jerk = 0;          ///< 0: none [unit/s^3]

    bool isAtRest() const noexcept { return velocity == 0.0 && acceleration == 0.0 && position == target; }

    /// Stays at `at`, at rest.
    void reset(double at) noexcept {
        position = target = at;
        velocity = acceleration = 0;
        isBraking_ = false;
    }
    /// The position becomes `at` because its zero has moved; the target moves by `shift`.
    void renumber(double at, double shift) noexcept {
        position = at;
        target += shift;
        brake_target_ += shift;
    }
    /// Brakes. The target becomes the place where it stops, and follows the limits until then. May be called
    /// in every cycle.
    void stop() noexcept;
    /// Advances by `dt` [s].
    void step(double dt) noexcept;

    /// The fastest stop from here, relative to the position; the same for a stop that has begun.
    SpeedChange stopping() const noexcept;
    /// The position after the time `t` [s] of the stop that stopping() has returned.
    double stop_position(const SpeedChange &stop, double t) const noexcept;
    /// Where that ends.
    double rest() const noexcept;
    /// Extends `low` to `high` by the places of its stop.
    void add_stop(double &low, double &high) const noexcept;
    /// The same by all places that it can reach on its way to the target or to a stop.
    void add_reach(double &low, double &high) const noexcept;

  private:
    void brake(double dt) noexcept;
    void step_with_jerk(double dt) noexcept;
    void step_without_jerk(double dt) noexcept;
    void end_at(double place) noexcept;

    /// It brakes with its present limits, until it gets another target than `brake_target_`.
    bool isBraking_ = false;
    double brake_target_ = 0;
};

}  // namespace mw::trajectory
