// SPDX-License-Identifier: GPL-2.0-or-later
// Places that are commanded, sample by sample: speed, acceleration and jerk within their limits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "trajectory/path/conditions.hh"

namespace mw::trajectory {

/// Of so many joints or axes.
struct TriedLimits {
    std::size_t count = 0;
    const double *velocity = nullptr, *acceleration = nullptr, *jerk = nullptr;
    bool hasNorm = false;  ///< after those of each dwell, those of the norm of the first three
    double period_s = 0;
    bool isJerkLimited = false;
    double size =
        0;  ///< of the positions in the calculation, where that is larger than their own: for rounding
};

class LimitTrial {
  public:
    void begin() noexcept { tick_ = 0; }
    /// Where the places of a tick go.
    double *places(std::uint64_t tick) noexcept { return places_[tick % places_.size()].data(); }
    /// The places of `tick` are within the limits; differences are taken with the samples of the ticks just
    /// before.
    bool isSound(const TriedLimits &limits, std::uint64_t tick) noexcept;
    /// The places of `tick` are none.
    void forget() noexcept { excess_ = 0; }
    /// Use of the limits by the last sample, as accelerations: speeds by their squares. 1 or less where it is
    /// within the limits or has no joint positions.
    double excess() const noexcept { return excess_; }

  private:
    struct Differences {
        double velocity = 0, acceleration = 0, jerk = 0;  ///< a cycle, a cycle^2, a cycle^3
    };
    static constexpr std::size_t MOST = std::max<std::size_t>(MAX_JOINTS, geometry::AXIS_COUNT);

    Differences differences(std::size_t i, std::uint64_t tick) const noexcept;
    bool keeps(const TriedLimits &limits, std::size_t i, const Differences &used, double rounding) noexcept;

    std::array<std::array<double, MOST>, 4> places_{};  ///< of the last samples, by tick
    std::uint64_t tick_ = 0;
    double excess_ = 0;
    std::uint64_t samples_ = 0;  ///< before the last one, without a gap
};

}  // namespace mw::trajectory
