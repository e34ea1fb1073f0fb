// SPDX-License-Identifier: GPL-2.0-or-later
// Arcs that must be followed exactly: the mean is taken of the leader's place on the arc, not of its pose.
// The leader stands before and after for the time of the mean. Realtime-safe.
#pragma once

#include <array>
#include <optional>

#include "trajectory/path_store.hh"

namespace mw::trajectory {

class ArcMean {
  public:
    /// The mean leaves the arc where it is.
    void leave() noexcept {
        primitive_ = 0;
        seen_ = 0;
    }
    /// With the leader at `x` of `piece` (null: on none) at this tick: what is commanded, the mean over
    /// `filter` samples of its places; nothing where no arc is under way.
    std::optional<Pose> follow(const PathStore &store, const Piece *piece, double x, std::uint64_t tick,
                               std::uint64_t filter) noexcept;

  private:
    Sequence primitive_ = 0;  ///< of which the mean place is commanded, 0: none
    /// When it began to move on it, and the last time that it did; where it stood before.
    std::uint64_t first_ = 0, last_ = 0;
    double before_ = 0;
    Sequence seen_ = 0;  ///< the arc where the leader is, 0: none, and its place on it
    double seen_s_ = 0;
    std::array<double, HISTORY_CAPACITY> places_{};
};

}  // namespace mw::trajectory
