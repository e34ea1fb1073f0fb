// SPDX-License-Identifier: GPL-2.0-or-later
// Slows down pieces that a trial has rejected, and keeps the list of them.
#pragma once

#include <array>

#include "trajectory/timing/speed_profile.hh"
#include "trajectory/trial/verdict.hh"

namespace mw::trajectory {

/// Speeds and accelerations are scaled in the path; the caller renews the profile of the changed pieces. Some
/// hundred kilobytes, so never on a stack.
class Easing {
  public:
    /// Planning starts again.
    void begin() noexcept { ++planning_; }
    /// Less speed and acceleration on the pieces of the cause.
    void slow_down(PlannedPath &path, const Cause &cause) noexcept;
    /// Takes back what the last `slow_down` did.
    void undo(PlannedPath &path) noexcept;
    /// Takes back all since `begin`: it did not help. The pieces that it may have changed, 0: none.
    Cause take_back(PlannedPath &path) noexcept;

  private:
    /// What is left of a piece's speed and acceleration by this planning.
    struct Eased {
        Sequence piece = 0;
        std::uint64_t planning = 0;  ///< the factors are of this one
        double speed = 1, acceleration = 1;
    };
    void ease(PlannedPath &path, Sequence piece, double speed, double acceleration) noexcept;

    std::array<Eased, PIECE_CAPACITY> eased_{};
    std::uint64_t planning_ = 0;
    Cause last_;  ///< of the last `slow_down`
};

}  // namespace mw::trajectory
