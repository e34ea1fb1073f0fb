// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated spindle without inertia: turns as commanded, with an index at every whole turn. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::plants {

class Spindle {
  public:
    /// Turns for `dt` seconds at `turns_per_second`, or not at all where that is no number. With
    /// `isIndexEnabled` the position is set back at the next whole turn, to what is past it; the return value
    /// says that this happened.
    bool run(double turns_per_second, bool isIndexEnabled, double dt) noexcept {
        if (!std::isfinite(turns_per_second)) {
            return false;
        }
        const double before = angle_;
        angle_ += turns_per_second * dt;
        const double turn = turns_per_second >= 0.0 ? std::floor(angle_) : std::ceil(angle_);
        const bool hasPassed = turns_per_second >= 0.0 ? turn > std::floor(before) : turn < std::ceil(before);
        const bool hasIndex = isIndexEnabled && hasPassed;
        if (hasIndex) {
            zero_ = turn;
        }
        return hasIndex;
    }

    /// Since the last index that was asked for [turns].
    double position() const noexcept { return angle_ - zero_; }

  private:
    double angle_ = 0.0;
    double zero_ = 0.0;
};

}  // namespace mw::plants
