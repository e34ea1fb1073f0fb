// SPDX-License-Identifier: GPL-2.0-or-later
// The limits on the cells of a profile, as rows of the timing problem.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trajectory/profile/lanes.hh"

namespace mw::trajectory::profile {

/// Number of points of a cell at which limits are checked: its start, middle and end.
inline constexpr std::size_t PLACES = 3;
inline constexpr std::array<double, PLACES> PLACE_PART{0, 0.5, 1};

/// b, a = b'/2 and w = b''/2 at a point.
struct LawState {
    double b = 0, a = 0, w = 0;
};

/// Derivatives of a coordinate by the parameter at a point, divided by its limits: |q' a + q'' b| <= 1 and
/// |q' w + 3 q'' a + q''' b| sqrt(b) + k b <= 1. k: part for a jump of the curvature (see speed_cap.hh).
struct Row {
    double a1 = 0, a2 = 0;
    double j1 = 0, j2 = 0, j3 = 0;
    double k = 0;
};

/// The rows of LANES cells for the solver, scaled by the lengths of the cells (see time_law.cc).
struct alignas(Lanes) RowLanes {
    Lanes a1{}, a2{}, j1{}, j2{}, j3{}, k{};
};

/// The norm over some coordinates at a point, divided by its limits. Its square is a quadratic form:
/// acceleration aa a^2 + 2 ab a b + bb b^2 <= 1, jerk the same of (w, a, b) <= (1 - k b)^2/b.
struct NormRow {
    double aa = 0, ab = 0, bb = 0;
    double jww = 0, jwa = 0, jwb = 0, jaa = 0, jab = 0, jbb = 0;
    double k = 0;
};
struct alignas(Lanes) VelocityLanes {
    Lanes v2{};
};
struct alignas(Lanes) NormLanes {
    Lanes aa{}, ab{}, bb{};
    Lanes jww{}, jwa{}, jwb{}, jaa{}, jab{}, jbb{}, k{};
};

/// The rows of all cells. Every cell has the same number of coordinates.
class Rows {
  public:
    /// Removes all cells. The next ones have `coordinates` rows per point, and a norm if `has_norm`.
    void begin(std::size_t coordinates, bool has_norm);
    /// Adds a cell of the length h in the parameter.
    void add_cell(double h);
    /// Sets the velocity limit of the newest cell: b v2 <= 1, and the limit of the axes and joints alone,
    /// without feed and override.
    void set_velocity(std::size_t place, double v2, double machine_v2) noexcept;
    /// Sets a row of the newest cell.
    void set(std::size_t place, std::size_t coordinate, const Row &row) noexcept;

    void set_norm(std::size_t place, const NormRow &row) noexcept;
    /// Raises the limits of acceleration and jerk at a point by `factor`.
    void relax(std::size_t cell, std::size_t place, double factor) noexcept;
    /// Raises the velocity limit at a point so that it allows b, at most to the limit of the axes and joints
    /// plus rounding.
    void allow(std::size_t cell, std::size_t place, double b) noexcept;

    std::size_t cells() const noexcept { return cells_; }
    std::size_t blocks() const noexcept { return (cells_ + LANES - 1) / LANES; }
    std::size_t coordinates() const noexcept { return coordinates_; }
    double length(std::size_t cell) const noexcept { return lengths_[cell]; }
    Row get(std::size_t cell, std::size_t place, std::size_t coordinate) const noexcept;
    double velocity(std::size_t cell, std::size_t place) const noexcept;
    /// Maximum row of acceleration and jerk for a motion at a point, divided by its limit.
    double worst(std::size_t cell, std::size_t place, const LawState &state) const noexcept;
    const Lanes &velocity_lanes(std::size_t block, std::size_t place) const noexcept {
        return velocity_[block * PLACES + place].v2;
    }
    const RowLanes *row_lanes(std::size_t block, std::size_t place) const noexcept {
        return &rows_[(block * PLACES + place) * coordinates_];
    }

    bool hasNorm() const noexcept { return has_norm_; }
    NormRow get_norm(std::size_t cell, std::size_t place) const noexcept;
    const NormLanes &norm_lanes(std::size_t block, std::size_t place) const noexcept {
        return norms_[block * PLACES + place];
    }

  private:
    std::size_t coordinates_ = 0, cells_ = 0;
    std::vector<double> lengths_;
    std::vector<VelocityLanes> velocity_;
    std::vector<double> machine_v2_;  ///< PLACES elements for each cell
    std::vector<RowLanes> rows_;
    bool has_norm_ = false;
    std::vector<NormLanes> norms_;
};

}  // namespace mw::trajectory::profile
