// SPDX-License-Identifier: GPL-2.0-or-later
// Range of the path from its driven part to its end.
#pragma once

#include "motion/interface/limits.hh"
#include "motion/planner/path_link.hh"

namespace mw::motion {

/// Two sets of moves. When the older set has been executed, the newer one replaces it, so that the range of a
/// long program does not contain old moves.
class PathWindow {
  public:
    static constexpr int MOVES_PER_LOT = 64;

    void clear() noexcept { *this = {}; }
    /// `move` is the last move before the added ones.
    void add(const TravelRange &range, trajectory::Sequence move) noexcept {
        Lot &lot = count_ == 0 ? older_ : newer_;
        widen(lot, range);
        lot.last = move + 1;
        ++count_;
    }
    /// `done`: the completed move. The corner after it may still be driven.
    void follow(trajectory::Sequence done) noexcept {
        if (!newer_.extent.isEmpty && count_ >= MOVES_PER_LOT && done > older_.last) {
            older_ = newer_;
            newer_ = {};
            count_ = 1;
        }
    }
    PathExtent extent() const noexcept {
        Lot all = older_;
        if (!newer_.extent.isEmpty) {
            widen(all, newer_.extent.range);
        }
        return all.extent;
    }

  private:
    struct Lot {
        PathExtent extent;
        trajectory::Sequence last = 0;
    };
    static void widen(Lot &lot, const TravelRange &range) noexcept {
        if (lot.extent.isEmpty) {
            lot.extent = {range, false};
        } else {
            lot.extent.range.include(range);
        }
    }

    Lot older_, newer_;
    int count_ = 0;  ///< moves since the start of the older set
};

}  // namespace mw::motion
