// SPDX-License-Identifier: GPL-2.0-or-later
// The limits of the axes that a path is made for, and the moving average that limits its jerk.
#pragma once

#include "trajectory/path/limits.hh"
#include "trajectory/path/move_request.hh"

namespace mw::trajectory {

/// The averaging time belongs to a path, until the next one begins; the limits may change meanwhile.
class PathLimits {
  public:
    explicit PathLimits(double period_s) noexcept;

    /// Holds for moves added from now on; jerk limits from the next `begin` on.
    void set(const Limits &limits) noexcept;
    /// A path begins with a move of this request.
    void begin(const PathDemand &demand) noexcept;

    /// A path that begins with such a move would have the same mean.
    bool isCurrent(const PathDemand &demand) const noexcept {
        return filter_length(wanted_, period_s_, demand) == filter_;
    }
    /// True if the averaging time is not much too long for the tolerance of such moves, nor much too short
    /// for moves of rotary axes on a path that began without them.
    bool suits(const PathDemand &demand) const noexcept;
    /// What a path that begins with such a move, from `start` to `end`, is made for.
    PathDemand demand_of(const MoveRequest &request, const Pose &start, const Pose &end) const noexcept;
    /// Maximum deviation of the moving average on a move without a programmed tolerance.
    double free_tolerance(const Primitive &primitive) const noexcept;

    const Limits &wanted() const noexcept { return wanted_; }
    /// The highest of all that were set since the path began.
    const Limits &highest() const noexcept { return highest_; }
    /// The wanted limits, with accelerations that the moving average can build up.
    const Limits &fitted() const noexcept { return fitted_; }
    std::uint64_t filter() const noexcept { return filter_; }
    bool isFiltered() const noexcept { return filter_ > 1; }
    /// The averaging time, tau; 0 without jerk limits.
    double filter_s() const noexcept { return filter_s_; }
    double period_s() const noexcept { return period_s_; }

  private:
    double period_s_;
    Limits wanted_, highest_, fitted_;
    std::uint64_t filter_ = 1;      ///< samples of the commanded moving average; 1: no jerk limits
    double filter_s_ = 0;           ///< the same in time
    bool isTurning_ = false;        ///< the path was begun with rotary axes
    double nominal_tolerance_ = 0;  ///< of moves without one on a path with jerk limits, at least
};

}  // namespace mw::trajectory
