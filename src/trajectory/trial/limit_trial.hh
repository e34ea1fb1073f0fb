// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are commanded, sample by sample: speed and acceleration within their limits.
#pragma once

#include <array>
#include <cstdint>

#include "trajectory/path/conditions.hh"

namespace mw::trajectory {

struct TriedLimits {
    std::size_t count = 0;  ///< of joints
    const double *velocity = nullptr, *acceleration = nullptr;
    double period_s = 0;
};

class LimitTrial {
  public:
    void begin() noexcept { tick_ = 0; }
    /// Where the places of a tick go.
    double *places(std::uint64_t tick) noexcept { return places_[tick % places_.size()].data(); }
    /// The places of `tick` are within the limits; differences are taken with the samples of the ticks just
    /// before.
    bool isSound(const TriedLimits &limits, std::uint64_t tick) noexcept;

  private:
    std::array<std::array<double, MAX_JOINTS>, 3> places_{};  ///< of the last samples, by tick
    std::uint64_t tick_ = 0;
    std::uint64_t samples_ = 0;  ///< before the last one, without a gap
};

}  // namespace mw::trajectory
