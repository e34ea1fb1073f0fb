// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are not axes, sample by sample: speed, acceleration and jerk within their limits.
#pragma once

#include <array>

#include "traj/geometry/conditions.hh"

namespace mw::traj {

class JointTrial {
  public:
    void begin() noexcept { tick_ = 0; }
    /// The joints at `pose`, which is commanded at `tick`, are within their limits; differences are taken
    /// with the samples of the ticks just before.
    bool isSound(const Conditions &conditions, const Pose &pose, std::uint64_t tick) noexcept;
    /// How much of its limits the last sample uses, as what accelerations ask for: speeds by their squares. 1
    /// or less where it is sound or there are no joints for it.
    double excess() const noexcept { return excess_; }

  private:
    std::array<std::array<double, MAX_JOINTS>, 4> joints_{};  ///< of the last samples, by tick
    std::uint64_t tick_ = 0;
    double excess_ = 0;
    std::uint64_t samples_ = 0;  ///< before the last one, without a gap
};

}  // namespace mw::traj
