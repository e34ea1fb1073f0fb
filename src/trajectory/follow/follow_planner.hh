// SPDX-License-Identifier: GPL-2.0-or-later
// One coordinate that follows a place which somebody else moves. While that keeps the limits, the coordinate
// is there without lag; where it jumps, is too fast or leaves the range, the coordinate catches up within its
// own limits.
#pragma once

#include "trajectory/follow/axis_motion.hh"

namespace mw::trajectory {

struct FollowLimits {
    double velocity = 0, acceleration = 0;
    double jerk = 0;           ///< 0: none
    double low = 0, high = 0;  ///< range; never left from inside
};

/// All functions: servo thread.
class FollowPlanner {
  public:
    double position() const noexcept { return motion_.position; }
    double velocity() const noexcept { return velocity_; }  ///< of the last cycle [unit/s]
    bool isAtRest() const noexcept { return velocity_ == 0.0 && motion_.isAtRest(); }

    /// At rest at `at`.
    void reset(double at) noexcept;
    /// The zero of the coordinate has moved: its position and the place that it follows change by `by`.
    void shift(double by) noexcept;
    /// One period towards `wanted`, a number.
    void follow(double wanted, const FollowLimits &limits, double dt) noexcept;
    /// One period of a stop.
    void brake(const FollowLimits &limits, double dt) noexcept;

  private:
    /// The place that is followed, with its velocity and acceleration in this cycle.
    struct Wanted {
        double place, velocity, acceleration;
    };
    Wanted wanted_at(double place, const FollowLimits &limits, double dt) const noexcept;
    bool take(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept;
    bool pursue(const Wanted &wanted, const FollowLimits &limits, double dt) noexcept;
    void record(double before, double dt) noexcept;

    AxisMotion motion_;
    double velocity_ = 0, acceleration_ = 0;   ///< differences of the last samples
    double wanted_ = 0, wanted_velocity_ = 0;  ///< in the last cycle
};

}  // namespace mw::trajectory
