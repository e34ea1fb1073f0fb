// SPDX-License-Identifier: GPL-2.0-or-later
// The path as the planner knows it: rings of moves and pieces by number, beside those that the executor
// reads.
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
    double deviation = 0;     ///< of the primitive from the lines that were joined to it
    MoveRequest request;
};

/// A piece besides its geometry.
struct PlannedPiece {
    double v_limit = 0;  ///< maximum speed within the limits
    bool isStopBefore = false;
};

/// Plain tables; elements from `oldest_piece` on are valid, and the moves that they belong to. Some
/// megabytes, so never on a stack.
class PlannedPath {
  public:
    explicit PlannedPath(PathStore &store) noexcept : store_(store) {}

    /// Another path begins behind all that there was.
    void begin() noexcept {
        first_move_ = last_move_ + 1;
        first_piece_ = last_piece_ + 1;
        oldest_piece_ = first_piece_;
    }
    Sequence first_move() const noexcept { return first_move_; }
    /// Of all paths; one that was dropped is never done.
    Sequence last_move() const noexcept { return last_move_; }
    /// Of this path, 0 as long as it has none.
    Sequence end_move() const noexcept { return last_move_ < first_move_ ? 0 : last_move_; }
    Sequence first_piece() const noexcept { return first_piece_; }
    Sequence last_piece() const noexcept { return last_piece_; }
    /// The executor's place; earlier pieces are free.
    Sequence oldest_piece() const noexcept { return oldest_piece_; }
    void drive_to(Sequence piece) noexcept { oldest_piece_ = std::max(first_piece_, piece); }
    bool isAllDriven() const noexcept { return last_piece_ < oldest_piece_; }

    PlannedMove &move(Sequence n) noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    const PlannedMove &move(Sequence n) const noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    PlannedPiece &plan(Sequence piece) noexcept { return pieces_[piece % PIECE_CAPACITY]; }
    const PlannedPiece &plan(Sequence piece) const noexcept { return pieces_[piece % PIECE_CAPACITY]; }
    Primitive &primitive(Sequence n) noexcept { return store_.primitive(n); }
    const Primitive &primitive(Sequence n) const noexcept { return store_.primitive(n); }
    const Piece &piece(Sequence n) const noexcept { return store_.piece(n); }
    const PathStore &store() const noexcept { return store_; }
    PathStore &store() noexcept { return store_; }

    /// Appends an empty move; its primitive and tag are the caller's to fill.
    Sequence append_move() noexcept { return ++last_move_; }
    /// The executor may read the piece, and the primitives that it lies on, from now on.
    void append_piece(const Piece &piece, const PlannedPiece &plan) noexcept;
    /// Less speed and acceleration on a piece, or more again.
    void scale(Sequence piece, double speed, double acceleration) noexcept;

    /// The move that a piece leads into: of a blend the second.
    Sequence move_of(Sequence piece) const noexcept {
        const Piece &p = store_.piece(piece);
        return p.move + (p.blend_d > 0 ? 1 : 0);
    }
    /// Length of what has been programmed since the path began.
    double programmed_length() const noexcept {
        return last_move_ < first_move_ ? 0.0 : move(last_move_).start_s + primitive(last_move_).length;
    }

  private:
    PathStore &store_;
    RawArray<PlannedMove, PRIMITIVE_CAPACITY> moves_;
    RawArray<PlannedPiece, PIECE_CAPACITY> pieces_;
    Sequence first_move_ = 1, last_move_ = 0;
    Sequence first_piece_ = 1, last_piece_ = 0;
    Sequence oldest_piece_ = 1;
};

}  // namespace mw::trajectory
