// SPDX-License-Identifier: GPL-2.0-or-later
// Slows down pieces that a trial has rejected, and keeps the list of them.
#pragma once

#include <array>

#include "trajectory/timing/speed_profile.hh"
#include "trajectory/trial/verdict.hh"

namespace mw::trajectory {

/// What can be done about a cause.
struct Means {
    double most_dwell_s = 0;  ///< that a stop among the pieces may still become longer
    double rising_s = 0;      ///< what the pieces take to come to speed
    bool isAnyCurved = false;
};

/// Longer dwells at stops, then slower curves, then anything. Speeds and accelerations are scaled in the
/// path; the caller renews the profile of the changed pieces. Some hundred kilobytes, so never on a stack.
class Easing {
  public:
    /// Planning starts again.
    void begin() noexcept;
    Means means_against(const PathView &view, const Cause &cause) const noexcept;
    /// Makes dwells longer, if that costs less time than less acceleration would.
    bool lengthen_stands(PlannedPath &path, const PathLimits &limits, const Cause &cause, const Means &means,
                         double excess) const noexcept;
    /// The attempt before has made accelerations along the path less, and that was not what failed: takes it
    /// back. The last piece that it changed, 0: none.
    Sequence take_back_gentleness(PlannedPath &path, const Verdict &verdict) noexcept;
    /// Less speed and acceleration on the pieces of the cause.
    void slow_down(PlannedPath &path, const Workspace &workspace, const Cause &cause, const Means &means,
                   const Verdict &verdict) noexcept;
    /// Takes back what the last `slow_down` did to speeds and accelerations.
    void undo(PlannedPath &path, const Workspace &workspace) noexcept;
    /// Takes back all since `begin`: it did not help. The pieces that it may have changed, 0: none.
    Cause take_back(PlannedPath &path) noexcept;

  private:
    /// What is left of a piece's speed and acceleration by this planning.
    struct Eased {
        Sequence piece = 0;
        std::uint64_t planning = 0;  ///< the factors are of this one
        double speed = 1, acceleration = 1;
        /// Part of the acceleration along the path that is left, with rejected attempts counted.
        double gentle = 1;
    };
    /// Accelerations along the path alone.
    struct Gentleness {
        Sequence low = 0, high = 0;  ///< pieces; 0: none
        double factor = 1;
    };
    struct Step {
        Sequence low = 0, high = 0;
        double speed = 1, acceleration = 1;
        bool isEverything = false;  ///< not curves alone
    };
    Eased &eased(Sequence piece) noexcept;
    double gentle_of(Sequence piece) const noexcept;
    bool hasHelped(const Verdict &verdict) const noexcept;
    bool canBeGentler(const Cause &cause, double factor) const noexcept;
    void ease_piece(PlannedPath &path, Sequence piece, double speed, double acceleration) noexcept;
    void apply(PlannedPath &path, const Workspace &workspace, const Step &step) noexcept;

    std::array<Eased, PIECE_CAPACITY> eased_{};
    std::uint64_t planning_ = 0;
    double excess_ = UNLIMITED;  ///< of the attempt before
    std::uint64_t tick_ = 0;     ///< where it failed
    Gentleness gentle_;          ///< of it
    Step step_;                  ///< of it
};

}  // namespace mw::trajectory
