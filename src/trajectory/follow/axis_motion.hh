// SPDX-License-Identifier: GPL-2.0-or-later
// Motion of one coordinate to a target. The target and the limits of velocity, acceleration and optionally
// jerk may change in every cycle. Each cycle follows the fastest motion from the current state, so all
// samples are within the limits.
#pragma once

#include "trajectory/path/limited_motion.hh"

namespace mw::trajectory {

/// Call all functions in the servo thread only.
class AxisMotion {
  public:
    double position = 0;
    double velocity = 0;
    double acceleration = 0;  ///< [unit/s^2]; 0 without a jerk limit
    double target = 0;
    double max_velocity = 0;      ///< maximum velocity of this move [unit/s]
    double max_acceleration = 0;  ///< [unit/s^2]
    double max_jerk = 0;          ///< [unit/s^3]; 0: no jerk limit

    bool isAtRest() const noexcept { return velocity == 0.0 && acceleration == 0.0 && position == target; }

    /// Sets the position to `at`, at standstill.
    void reset(double at) noexcept {
        position = target = at;
        velocity = acceleration = 0;
        isBraking_ = false;
    }
    /// Sets the position to `at` because the origin has moved. The target moves by `shift`.
    void renumber(double at, double shift) noexcept {
        position = at;
        target += shift;
        brake_target_ += shift;
    }
    /// Brakes. The target becomes the position where the motion stops, and follows changes of the limits. May
    /// be called in every cycle.
    void stop() noexcept;
    /// Advances the motion by `dt` [s].
    void step(double dt) noexcept;

    /// The fastest stop from the current state, relative to the current position. It is the same for a stop
    /// that has begun.
    SpeedChange stopping() const noexcept;
    /// Position at the time `t` [s] of the stop that stopping() has returned.
    double stop_position(const SpeedChange &stop, double t) const noexcept;
    /// Position at the end of the fastest stop.
    double rest() const noexcept;
    /// Extends the range `low` to `high` by the positions of the fastest stop.
    void add_stop(double &low, double &high) const noexcept;
    /// Extends the range by all positions that the motion can reach before it is at its target or stopped.
    void add_reach(double &low, double &high) const noexcept;

  private:
    void brake(double dt) noexcept;
    void step_with_jerk(double dt) noexcept;
    void step_without_jerk(double dt) noexcept;
    void end_at(double point) noexcept;

    /// a stop with the current limits is active, until the target differs from `brake_target_`
    bool isBraking_ = false;
    double brake_target_ = 0;
};

}  // namespace mw::trajectory
