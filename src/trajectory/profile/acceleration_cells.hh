// SPDX-License-Identifier: GPL-2.0-or-later
// Cells of a curve for motion within velocity and acceleration limits, with the limits in each cell.
//
// In a cell the path acceleration a is constant, so the squared speed b is linear in s. The limits at both
// ends of a cell are rows |a + c b| <= r, where b is the squared speed at the start. Cells are so short that
// a motion within its rows exceeds a limit between the ends by at most the fraction BETWEEN.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "trajectory/profile/point_limits.hh"

namespace mw::trajectory::profile {

/// Permitted path accelerations of a cell at a squared speed at its start, and their derivatives by the
/// squared speed.
struct AccelerationRange {
    double low = -1e300, high = 1e300;
    double low_slope = 0, high_slope = 0;
};

struct AccelerationCell {
    struct End {
        double machine_b = 1e300;   ///< squared speed at the velocity limits of the axes and joints
        double curve_b = 1e300;     ///< squared speed at which the curvature alone uses an acceleration limit
        double xyz2 = 0, uvw2 = 0;  ///< squared derivatives by s of the lengths over X Y Z and U V W
    };
    double s = 0, length = 0;
    std::array<End, 2> ends;
    std::array<PointLimits::Norm, 2> norms;  ///< norm at both ends, in a and the squared speed at the start
    bool has_norm = false;
    bool is_straight = false;  ///< the permitted acceleration is the same at every speed
    double least = 0;          ///< permitted path acceleration in both directions at standstill
    double most_b = 1e300;     ///< maximum squared speed at the start within the rows
    double cap_b = 1e300;      ///< maximum squared speed by the caps of seams
    std::size_t row = 0, rows = 0;
    double end_s() const noexcept { return s + length; }
};

/// The cells, in the order of the curve.
class AccelerationCells {
  public:
    /// Fraction of a limit by which it may be exceeded between the ends of a cell.
    static constexpr double BETWEEN = 2e-3;
    /// Approximate maximum time of a cell [s].
    static constexpr double CELL_S = 1e-3;

    /// Removes all cells. The next cell begins at `s`.
    void begin(double s) noexcept;
    /// Removes cells that end at or before `s`.
    void drop_before(double s);
    /// Removes cells that end after `s`.
    void cut_behind(double s);
    /// Adds the next cell, at most up to `end`. On a curve, it takes at most about CELL_S at the squared
    /// speed `b`, or during a stop at `end`.
    void lay(const Run &run, double end, double b);
    /// Divides the only cell, from `s` on, so that a motion can start and stop in it.
    void divide(const Run &run, double s);
    /// Parts of cells: the rest of the first cell, the last cell up to an end within it, the start of a stop.
    enum class Part : std::uint8_t { HEAD, TAIL, STOP };
    /// The part of a cell from `s` to `end`. It is valid until the next call with the same `which`. A part up
    /// to the end of the cell has the same rows as the whole cell.
    AccelerationCell part(const Run &run, const AccelerationCell &cell, double s, double end, Part which);

    std::size_t size() const noexcept { return cells_.size(); }
    const AccelerationCell &operator[](std::size_t k) const noexcept { return cells_[k]; }
    /// End of the last cell.
    double end_s() const noexcept { return cells_.empty() ? begin_s_ : cells_.back().end_s(); }

    /// Permitted path accelerations at the squared speed `b` at the start of the cell.
    AccelerationRange range(const AccelerationCell &cell, double b) const noexcept;
    /// `range(cell, b).low`.
    double lowest(const AccelerationCell &cell, double b) const noexcept;
    /// Maximum squared speed at the start of the cell, up to `most`, from which the speed at its end can be
    /// `next` or lower.
    double most_before(const AccelerationCell &cell, double most, double next) const noexcept;

  private:
    struct Row {
        double c = 0, r = 0;
    };
    static constexpr double NO_STRETCH = -1e300;
    /// Path between two points where the formula of the curve or of a limit changes.
    struct Stretch {
        double end_s = NO_STRETCH;
        CurvePlace place;
        CapRest rest;
        double cell = 0;          ///< maximum length of a cell, so that its rows change little enough
        double acceleration = 0;  ///< permitted path acceleration at standstill
        bool is_straight = false;
        PointLimits end;  ///< limits at the end of the last cell
    };
    void begin_stretch(const Run &run, double end);
    void add(const Run &run, double to);
    static AccelerationCell make(double from, double to, const std::array<PointLimits, 2> &limits,
                                 const std::array<double, 2> &at, bool is_straight, std::vector<Row> &rows);
    double change_in(const AccelerationCell &cell, const PointLimits &start,
                     const PointLimits &end) const noexcept;
    double next_point(const Run &run, const Span &span, double end) const noexcept;
    const Row *rows_of(const AccelerationCell &cell) const noexcept {
        return cell.row < IN_PART ? &rows_[cell.row - first_row_] : part_rows_[cell.row - IN_PART].data();
    }

    static constexpr std::size_t IN_PART = std::size_t{1} << 62;
    double begin_s_ = 0;
    Stretch stretch_;  ///< stretch of the next cell
    std::vector<AccelerationCell> cells_;
    std::vector<Row> rows_;
    std::array<std::vector<Row>, 3> part_rows_;
    std::size_t first_row_ = 0;  ///< number of the first row in `rows_`
};

}  // namespace mw::trajectory::profile
