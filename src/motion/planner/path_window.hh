// SPDX-License-Identifier: GPL-2.0-or-later
// How far the path leads between where it is driven and where it ends.
#pragma once

#include "motion/interface/limits.hh"
#include "motion/planner/path_link.hh"

namespace mw::motion {

/// Two lots of moves: when the older one is driven, the newer one takes its place, so that a long program is
/// not judged by what is long past.
class PathWindow {
  public:
    static constexpr int MOVES_PER_LOT = 64;

    void clear() noexcept { *this = {}; }
    /// `move` is the last one before what is added.
    void add(const TravelRange &range, trajectory::Sequence move) noexcept {
        Lot &lot = count_ == 0 ? older_ : newer_;
        widen(lot, range);
        lot.last = move + 1;
        ++count_;
    }
    /// `done`: the move that is complete. The corner behind it may still be driven.
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
    int count_ = 0;  ///< of moves since the older lot was begun
};

}  // namespace mw::motion
