// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path between two stops, by its length: what a curve is fitted to.
#pragma once

#include <cstddef>
#include <vector>

#include "trajectory/path/primitive.hh"

namespace mw::trajectory::curve {

/// One move of the programmed path.
struct ProgrammedMove {
    Primitive primitive;
    double start_s = 0;    ///< length of the path before it [units]
    double tolerance = 0;  ///< distance that the curve may keep from it [units; degrees over A B C]
    double end_s() const noexcept { return start_s + primitive.length; }
};

/// Moves one after the other, the end of each the start of the next.
class ProgrammedPath {
  public:
    /// The next move starts at `s`.
    void clear(double s = 0) noexcept {
        moves_.clear();
        start_s_ = s;
    }
    void add(const Primitive &primitive, double tolerance);
    /// Removes the moves that end before `s`, except the last one.
    void drop_before(double s) noexcept;
    const std::vector<ProgrammedMove> &moves() const noexcept { return moves_; }
    /// Place of its end.
    double length() const noexcept { return moves_.empty() ? start_s_ : moves_.back().end_s(); }
    /// Index of the move at `s`, searched from the move `near` on.
    std::size_t move_at(double s, std::size_t near) const noexcept;
    /// On the move `index`.
    Pose position_at(std::size_t index, double s) const noexcept;
    /// Mean position of [from, to]; `index`: the move at `from`.
    Pose mean(std::size_t index, double from, double to) const noexcept;

  private:
    std::vector<ProgrammedMove> moves_;
    double start_s_ = 0;
};

}  // namespace mw::trajectory::curve
