// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path between two stops, by its length. A curve is fitted to it.
#pragma once

#include <cstddef>
#include <vector>

#include "trajectory/path/primitive.hh"

namespace mw::trajectory::curve {

/// One move of the programmed path.
struct ProgrammedMove {
    Primitive primitive;
    double start_s = 0;    ///< path length at its start [unit]
    double tolerance = 0;  ///< maximum distance of the curve from the move [unit; degrees for A B C]
    double end_s() const noexcept { return start_s + primitive.length; }
};

/// Consecutive moves. Each starts at the end of the move before.
class ProgrammedPath {
  public:
    /// Removes all moves. The next move starts at path length `s`.
    void clear(double s = 0) noexcept {
        moves_.clear();
        start_s_ = s;
    }
    void add(const Primitive &primitive, double tolerance);
    /// Removes the moves that end before `s`, except the last one.
    void drop_before(double s) noexcept;
    const std::vector<ProgrammedMove> &moves() const noexcept { return moves_; }
    /// Path length at its end.
    double length() const noexcept { return moves_.empty() ? start_s_ : moves_.back().end_s(); }
    /// Index of the move at `s`. `near`: index at which the search starts.
    std::size_t move_at(double s, std::size_t near) const noexcept;
    /// Position at `s` on the move `index`.
    Pose position_at(std::size_t index, double s) const noexcept;
    /// Average position over [from, to]. `index`: the move at `from`.
    Pose mean(std::size_t index, double from, double to) const noexcept;

  private:
    std::vector<ProgrammedMove> moves_;
    double start_s_ = 0;
};

}  // namespace mw::trajectory::curve
