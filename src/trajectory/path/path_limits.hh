// SPDX-License-Identifier: GPL-2.0-or-later
// The limits of the axes that moves are made for.
#pragma once

#include "trajectory/path/limits.hh"

namespace mw::trajectory {

class PathLimits {
  public:
    explicit PathLimits(double period_s) noexcept;

    /// Holds for moves added from now on.
    void set(const Limits &limits) noexcept;
    /// Maximum deviation of the curve on a move without a programmed tolerance, at `speed` along its
    /// parameter (0: as fast as the limits allow).
    double free_tolerance(const Primitive &primitive, double speed) const noexcept;

    const Limits &wanted() const noexcept { return wanted_; }
    double period_s() const noexcept { return period_s_; }

  private:
    double period_s_;
    Limits wanted_;
    double nominal_tolerance_ = 0;  ///< of moves without one on a path with jerk limits, at least
};

}  // namespace mw::trajectory
