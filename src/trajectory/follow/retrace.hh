// SPDX-License-Identifier: GPL-2.0-or-later
// Reverse run (negative adaptive feed): back along the commanded path, and forward again. Samples that were
// commanded at rate 1 within V, A, J keep these limits at the rate r, with the changes alpha and j of r, if
// r <= 1, A r^2 + V alpha <= A and J r^3 + 3 A r alpha + V j <= J in every coordinate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/raw_array.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::trajectory {

/// Its size is several megabytes: do not put it on a stack. Call all methods in the servo thread only. They
/// are bounded and do not allocate memory.
class Retrace {
  public:
    static constexpr std::uint64_t CAPACITY = 32768;  ///< maximum number of samples for reverse run
    static constexpr double HIGHEST_RATE = 0.75;      ///< maximum rate, as a fraction of the commanded speed

    /// Use of the limits by a sample: maximum ratios over all coordinates, 0 without limits.
    struct Use {
        double v_over_a = 0;  ///< speed divided by the acceleration limit [s]
        double v_over_j = 0;  ///< speed divided by the jerk limit [s^2]
        double a_over_j = 0;  ///< acceleration divided by the jerk limit [s]
    };

    /// Records a sample of the path. Of samples at standstill, only the first ones are kept. True if
    /// include() must be called now, for the use of the samples since the last call.
    bool record(const geometry::Pose &pose) noexcept;
    void include(const Use &use) noexcept;
    void clear() noexcept;
    bool isEmpty() const noexcept { return count_ == 0; }
    /// True if samples for reverse run exist.
    bool hasWay() const noexcept { return count_ > 2 * STANDING; }
    /// True if the last samples are at standstill, so reverse run can begin here.
    bool isReady() const noexcept { return standing_ >= STANDING && hasWay(); }
    /// True while the machine is not at the point where it left the path.
    bool isAway() const noexcept { return isAway_; }
    bool isMoving() const noexcept { return isAway_ && !way_.isAtRest(); }
    /// Stops in this cycle. Call it only at a speed at which this exceeds no limit.
    void stand() noexcept { way_.reset(way_.position); }
    /// Advances by one period of `dt` [s]. `direction`: below 0 back, above 0 forward, 0 stop. `rate`: 0 to
    /// HIGHEST_RATE.
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
    std::uint64_t count_ = 0;  ///< number of samples since clear()
    std::uint64_t standing_ = 0;
    bool isAway_ = false;
    double change_ = 0;  ///< maximum change of the rate that all samples allow [1/s]
    AxisMotion way_;     ///< recorded time, relative to the point where the path was left; 0 or negative [s]
};

}  // namespace mw::trajectory
