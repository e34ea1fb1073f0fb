// SPDX-License-Identifier: GPL-2.0-or-later
// The limits of the axes that a path is made for, and the mean that makes its jerk limited.
#pragma once

#include "traj/geometry/limits.hh"
#include "traj/geometry/move_request.hh"

namespace mw::traj {

/// The length of the mean belongs to a path, from its begin to the next; the limits may change on the way.
class PathLimits {
  public:
    explicit PathLimits(double period_s) noexcept;

    /// Holds for moves added from now on; jerk limits from the next `begin` on.
    void set(const Limits &limits) noexcept;
    /// A path begins with a move of this tolerance; 0: none is kept.
    void begin(double tolerance) noexcept;

    /// A path that begins with `tolerance` would have the same mean.
    bool isCurrent(double tolerance) const noexcept {
        return filter_length(wanted_, period_s_, tolerance) == filter_;
    }
    /// The mean is not much too long for moves of this tolerance; 0: any suits.
    bool suits(double tolerance) const noexcept;
    /// What a path of such moves is made for; 0: any suits.
    double path_tolerance(const MoveRequest &request) const noexcept;
    /// What the mean may take of a move for which the program gives no tolerance.
    double free_tolerance(const Primitive &primitive) const noexcept;

    const Limits &wanted() const noexcept { return wanted_; }
    /// The highest of all that were set since the path began.
    const Limits &highest() const noexcept { return highest_; }
    /// As wanted, with accelerations that the mean can build up.
    const Limits &fitted() const noexcept { return fitted_; }
    std::uint64_t filter() const noexcept { return filter_; }
    bool isFiltered() const noexcept { return filter_ > 1; }
    /// The time of the mean, tau; 0 without jerk limits.
    double filter_s() const noexcept { return filter_s_; }
    double period_s() const noexcept { return period_s_; }

  private:
    double period_s_;
    Limits wanted_, highest_, fitted_;
    std::uint64_t filter_ = 1;      ///< samples of the mean that is commanded; 1: no jerk limits
    double filter_s_ = 0;           ///< the same in time
    double nominal_tolerance_ = 0;  ///< of moves without one on a path with jerk limits, at least
};

}  // namespace mw::traj
