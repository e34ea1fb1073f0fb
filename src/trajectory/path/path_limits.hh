// SPDX-License-Identifier: GPL-2.0-or-later
// Axis limits for which moves are planned.
#pragma once

#include "trajectory/path/limits.hh"

namespace mw::trajectory {

class PathLimits {
  public:
    explicit PathLimits(double period_s) noexcept;

    /// Sets the limits for moves that are added after this call.
    void set(const Limits &limits) noexcept;
    /// Maximum deviation of the curve on a move without a programmed tolerance [unit]. `speed` is along its
    /// parameter; 0: no feed, only the limits.
    double free_tolerance(const Primitive &primitive, double speed) const noexcept;

    const Limits &wanted() const noexcept { return wanted_; }
    double period_s() const noexcept { return period_s_; }

  private:
    double period_s_;
    Limits wanted_;
    double nominal_tolerance_ = 0;  ///< minimum default deviation [unit]
};

}  // namespace mw::trajectory
