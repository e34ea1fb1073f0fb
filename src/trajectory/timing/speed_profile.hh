// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum speeds: of pieces under the current overrides, and at their starts so that all later pieces keep
// their limits.
#pragma once

#include <array>

#include "trajectory/path/conditions.hh"
#include "trajectory/timing/leader_state.hh"

namespace mw::trajectory {

/// Inputs of the steps of timing and trial; not stored.
struct PathView {
    const PlannedPath &path;
    const Conditions &conditions;
};

/// Maximum speed on a piece under the current overrides [1/s].
double speed_cap(const PathView &view, Sequence piece) noexcept;
/// A point before which the path stops for now: a gate, or the end of a single block.
bool isBarrier(const PathView &view, Sequence piece) noexcept;
/// Stopped before a point that a plan must not pass.
inline bool isBeforeBarrier(const PathView &view, const LeaderState &state) noexcept {
    return state.x <= 0 && state.v <= 0 && isBarrier(view, state.piece);
}

/// The backward pass. Some hundred kilobytes, so never on a stack.
class SpeedProfile {
  public:
    void begin() noexcept { changed_from_ = 0; }
    /// From piece `from` back to the executor's piece; unless `isWhole`, only until nothing changes.
    void pass_backward(const PathView &view, Sequence from, bool isWhole) noexcept;
    /// The pieces [low, high] have other limits now.
    void renew(const PathView &view, Sequence low, Sequence high) noexcept;
    /// Speeds within pieces have changed from here on, not only those at their starts.
    void change_from(Sequence piece) noexcept { changed_from_ = piece; }
    void keep() noexcept { changed_from_ = 0; }

    /// Lowest piece whose speed at its start has changed since `keep`, 0: none.
    Sequence changed_from() const noexcept { return changed_from_; }
    /// Maximum speed at the end of a piece, squared.
    double out2(const PlannedPath &path, Sequence piece) const noexcept {
        return piece == path.last_piece() ? 0.0 : v2_in_[(piece + 1) % PIECE_CAPACITY];
    }
    /// What follows can still be kept from this state.
    bool isKept(const PlannedPath &path, const LeaderState &state) const noexcept;

  private:
    static constexpr double UNKNOWN = -1;

    std::array<double, PIECE_CAPACITY> v2_in_{};  ///< at a piece's start, squared
    Sequence known_ = 0;                          ///< pieces up to here have been passed or marked
    Sequence changed_from_ = 0;
};

}  // namespace mw::trajectory
