// SPDX-License-Identifier: GPL-2.0-or-later
// Back along the path that was commanded, and forward again: negative adaptive feed, reverse run.
// What was commanded at speed 1 within V, A, J keeps them at speed r with changes of r by alpha and j as long
// as r <= 1, A r^2 + V alpha <= A and J r^3 + 3 A r alpha + V j <= J in every coordinate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/raw_array.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::trajectory {

/// Some megabytes, so never on a stack. All methods: servo thread only; bounded, no allocation.
class Retrace {
  public:
    static constexpr std::uint64_t CAPACITY = 32768;  ///< samples that can be gone back
    static constexpr double HIGHEST_RATE = 0.75;      ///< of the speed that was commanded

    /// How a sample uses limits: the largest ratios over all coordinates, 0 where nothing limits.
    struct Use {
        double v_over_a = 0;  ///< speed over the limit of acceleration [s]
        double v_over_j = 0;  ///< speed over the limit of jerk [s^2]
        double a_over_j = 0;  ///< acceleration over the limit of jerk [s]
    };

    /// A sample of the path itself; ones that stand are kept only as far as needed. True when it is time to
    /// say by include() what this one and those since the last time use.
    bool record(const geometry::Pose &pose) noexcept;
    void include(const Use &use) noexcept;
    void clear() noexcept;
    bool isEmpty() const noexcept { return count_ == 0; }
    /// There is something to go back along.
    bool hasWay() const noexcept { return count_ > 2 * STANDING; }
    /// Nothing has been recorded for some samples but standing: one may go back from here.
    bool isReady() const noexcept { return standing_ >= STANDING && hasWay(); }
    /// True while the machine is behind the point where it left the path.
    bool isAway() const noexcept { return isAway_; }
    bool isMoving() const noexcept { return isAway_ && !way_.isAtRest(); }
    /// Stops at once. Only at a speed at which this exceeds no limit.
    void stand() noexcept { way_.reset(way_.position); }
    /// Advances by one period: back, forward, or to standstill; `rate` from 0 to HIGHEST_RATE.
    geometry::Pose step(double dt, int direction, double rate) noexcept;

  private:
    static constexpr std::uint64_t STANDING = 4;
    static constexpr std::uint64_t BLOCK = 64;

    const geometry::Pose &sample(std::int64_t back) const noexcept;
    geometry::Pose pose_at(double samples) const noexcept;
    void start() noexcept;
    Use most_between(std::int64_t newest, std::int64_t oldest) const noexcept;
    void stop(double dt) noexcept;

    RawArray<geometry::Pose, CAPACITY> samples_;
    std::array<Use, CAPACITY / BLOCK> blocks_{};
    std::uint64_t count_ = 0;  ///< recorded since clear()
    std::uint64_t standing_ = 0;
    bool isAway_ = false;
    double change_ = 0;  ///< of the rate, that all samples allow [1/s]
    AxisMotion way_;     ///< recorded time from where the path was left: 0 and below [s]
};

}  // namespace mw::trajectory
