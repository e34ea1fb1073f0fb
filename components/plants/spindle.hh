// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated spindle without inertia: it follows the command at once and has an index at every whole
// revolution. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::plants {

class Spindle {
  public:
    /// Turns for `dt` seconds at `turns_per_second`; a speed that is not a number counts as 0. With
    /// `index_enabled` the position is reset at the next whole turn, to the part after it; the return value
    /// reports this.
    bool run(double turns_per_second, bool index_enabled, double dt) noexcept {
        if (!std::isfinite(turns_per_second)) {
            return false;
        }
        const double before = angle_;
        angle_ += turns_per_second * dt;
        const double turn = turns_per_second >= 0.0 ? std::floor(angle_) : std::ceil(angle_);
        const bool passed = turns_per_second >= 0.0 ? turn > std::floor(before) : turn < std::ceil(before);
        const bool has_index = index_enabled && passed;
        if (has_index) {
            zero_ = turn;
        }
        return has_index;
    }

    /// Since the last requested index [turns].
    double position() const noexcept { return angle_ - zero_; }

  private:
    double angle_ = 0.0;
    double zero_ = 0.0;
};

}  // namespace mw::plants
