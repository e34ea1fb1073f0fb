// SPDX-License-Identifier: GPL-2.0-or-later
// The path as the planner knows it: a ring of moves by number, beside those that the executor reads.
#pragma once

#include <algorithm>
#include <array>

#include "base/raw_array.hh"
#include "trajectory/path/move_request.hh"

namespace mw::trajectory {

/// A move besides its primitive.
struct PlannedMove {
    double feed = 0;          ///< requested speed in s [1/s]; 0: none
    double chosen_speed = 0;  ///< by a planner module, in s [1/s]; 0: none
    double start_s = 0;       ///< where the move begins on the programmed path
    MoveRequest request;
};

/// Plain tables. Some megabytes, so never on a stack.
class PlannedPath {
  public:
    explicit PlannedPath(PathStore &store) noexcept : store_(store) {}

    /// Another path begins behind all that there was.
    void begin() noexcept { first_move_ = last_move_ + 1; }
    Sequence first_move() const noexcept { return first_move_; }
    /// Of all paths; one that was dropped is never done.
    Sequence last_move() const noexcept { return last_move_; }
    /// Of this path, 0 as long as it has none.
    Sequence end_move() const noexcept { return last_move_ < first_move_ ? 0 : last_move_; }

    PlannedMove &move(Sequence n) noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    const PlannedMove &move(Sequence n) const noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    Primitive &primitive(Sequence n) noexcept { return store_.primitive(n); }
    const Primitive &primitive(Sequence n) const noexcept { return store_.primitive(n); }
    const PathStore &store() const noexcept { return store_; }
    PathStore &store() noexcept { return store_; }

    /// Appends an empty move; its primitive and tag are the caller's to fill.
    Sequence append_move() noexcept { return ++last_move_; }
    /// Length of what has been programmed since the path began.
    double programmed_length() const noexcept {
        return last_move_ < first_move_ ? 0.0 : move(last_move_).start_s + primitive(last_move_).length;
    }

  private:
    PathStore &store_;
    RawArray<PlannedMove, PRIMITIVE_CAPACITY> moves_;
    Sequence first_move_ = 1, last_move_ = 0;
};

}  // namespace mw::trajectory
