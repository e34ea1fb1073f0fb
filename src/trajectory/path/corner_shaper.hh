// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits the moving average runs inside of dense curves. Their corners are therefore moved outwards
// within the tolerance, by a part of this deviation (docs/developer/planner.md).
#pragma once

#include <optional>

#include "trajectory/path/stretch.hh"

namespace mw::trajectory {

/// Follows a path corner by corner.
class CornerShaper {
  public:
    void begin() noexcept {
        shift_ = {};
        drive_ = {};
    }
    /// By what the corner between two lines, of which the second has just come, is moved; nothing where it
    /// stays.
    std::optional<Pose> shift(const Leg &a, const Leg &b, const Conditions &conditions) noexcept;

  private:
    Pose shift_, drive_;  ///< of the last corner, and what it follows
};

}  // namespace mw::trajectory
