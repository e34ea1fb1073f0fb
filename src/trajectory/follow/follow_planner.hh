// SPDX-License-Identifier: GPL-2.0-or-later
// Motion of one coordinate that follows a commanded position. If the command is within the limits, the
// coordinate equals it without lag. If the command jumps, is too fast or leaves the range, the coordinate
// catches up within its own limits.
#pragma once

#include "trajectory/follow/axis_motion.hh"

namespace mw::trajectory {

struct FollowLimits {
    double velocity = 0, acceleration = 0;
    double jerk = 0;           ///< [unit/s^3]; 0: no jerk limit
    double low = 0, high = 0;  ///< range of the position; from inside, the coordinate does not leave it
};

/// Call all functions in the servo thread only.
class FollowPlanner {
  public:
    double position() const noexcept { return motion_.position; }
    double velocity() const noexcept { return velocity_; }  ///< velocity of the last cycle [unit/s]
    bool isAtRest() const noexcept { return velocity_ == 0.0 && motion_.isAtRest(); }

    /// Sets the position to `at`, at standstill.
    void reset(double at) noexcept;
    /// Shifts the position and the command by `by`, because the origin has moved.
    void shift(double by) noexcept;
    /// Follows the command `wanted`, a finite number, for one cycle of `dt` [s].
    void follow(double wanted, const FollowLimits &limits, double dt) noexcept;
    /// Brakes for one cycle of `dt` [s].
    void brake(const FollowLimits &limits, double dt) noexcept;

  private:
    /// The commanded position, with its velocity and acceleration in this cycle.
    struct Wanted {
        double commanded, velocity, acceleration;
    };
    Wanted wanted_at(double commanded, const FollowLimits &limits, double dt) const noexcept;
    bool take(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept;
    bool pursue(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept;
    void record(double before, double dt) noexcept;

    AxisMotion motion_;
    /// Velocity and acceleration, from differences of the last samples.
    double velocity_ = 0, acceleration_ = 0;
    double wanted_ = 0, wanted_velocity_ = 0;  ///< command of the last cycle
};

}  // namespace mw::trajectory
