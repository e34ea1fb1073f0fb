// SPDX-License-Identifier: GPL-2.0-or-later
// Path data of the planner: a ring of moves by number, in addition to the moves that the executor reads.
#pragma once

#include <algorithm>
#include <array>

#include "base/raw_array.hh"
#include "trajectory/path/move_request.hh"

namespace mw::trajectory {

/// Data of a move in addition to its primitive.
struct PlannedMove {
    double feed = 0;          ///< requested speed along s [1/s]; 0: none
    double chosen_speed = 0;  ///< speed along s chosen by a planner module [1/s]; 0: none
    double start_s = 0;       ///< start of the move on the programmed path
    MoveRequest request;
};

/// Ring of moves. Its size is several megabytes: do not put it on a stack.
class PlannedPath {
  public:
    explicit PlannedPath(PathStore &store) noexcept : store_(store) {}

    /// Begins a new path after all earlier moves.
    void begin() noexcept { first_move_ = last_move_ + 1; }
    Sequence first_move() const noexcept { return first_move_; }
    /// Number of the last move of all paths. A move of a dropped path is never completed.
    Sequence last_move() const noexcept { return last_move_; }
    /// Number of the last move of this path; 0: none.
    Sequence end_move() const noexcept { return last_move_ < first_move_ ? 0 : last_move_; }

    PlannedMove &move(Sequence n) noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    const PlannedMove &move(Sequence n) const noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    Primitive &primitive(Sequence n) noexcept { return store_.primitive(n); }
    const Primitive &primitive(Sequence n) const noexcept { return store_.primitive(n); }
    const PathStore &store() const noexcept { return store_; }
    PathStore &store() noexcept { return store_; }

    /// Appends an empty move. The caller fills its primitive and tag.
    Sequence append_move() noexcept { return ++last_move_; }
    /// Programmed length of this path until now.
    double programmed_length() const noexcept {
        return last_move_ < first_move_ ? 0.0 : move(last_move_).start_s + primitive(last_move_).length;
    }

  private:
    PathStore &store_;
    RawArray<PlannedMove, PRIMITIVE_CAPACITY> moves_;
    Sequence first_move_ = 1, last_move_ = 0;
};

}  // namespace mw::trajectory
