// SPDX-License-Identifier: GPL-2.0-or-later
// One coordinate that follows a place which somebody else moves. While that keeps the limits it is there
// without lag; where it steps, runs away or leaves the range, the coordinate catches up within its own
// limits. Positions are samples: speed and acceleration are their differences, and braking ends on a sample.
#pragma once

#include <array>
#include <cstdint>

namespace mw::trajectory {

struct FollowLimits {
    double velocity = 0, acceleration = 0;
    double jerk = 0;           ///< 0: none; with one the place is followed half of 2 a / j later
    double low = 0, high = 0;  ///< range; never left from inside
};

/// All functions: servo thread.
class FollowPlanner {
  public:
    double position() const noexcept { return position_; }
    double velocity() const noexcept { return velocity_; }  ///< of the last cycle [unit/s]
    bool isAtRest() const noexcept { return velocity_ == 0.0 && still_ >= length_; }

    /// Stands at `at`; the limits hold from here.
    void reset(double at, const FollowLimits &limits, double dt) noexcept;
    /// One period on the way to `wanted`, a number.
    void follow(double wanted, const FollowLimits &limits, double dt) noexcept;
    /// One period on the way to standing still.
    void brake(const FollowLimits &limits, double dt) noexcept;

  private:
    static constexpr std::uint32_t MOST_SAMPLES = 400;
    double acceleration_of(const FollowLimits &limits, double dt) const noexcept;
    void lead(double speed, const FollowLimits &limits, double dt) noexcept;
    void take(double dt) noexcept;

    double position_ = 0, velocity_ = 0;
    double leader_ = 0, leader_speed_ = 0;    ///< before the jerk limit
    double wanted_ = 0;                       ///< in the last cycle
    std::array<double, MOST_SAMPLES> way_{};  ///< of the leader, the last samples; their mean is commanded
    std::uint32_t length_ = 1, next_ = 0, still_ = 0;
};

}  // namespace mw::trajectory
