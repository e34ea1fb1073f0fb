// SPDX-License-Identifier: GPL-2.0-or-later
// The plan of a run: the spline of the squared speed on its cells.
#pragma once

#include <array>
#include <vector>

#include "trajectory/profile/cells.hh"
#include "trajectory/profile/stop_law.hh"

namespace mw::trajectory::profile {

/// Fraction by which the squared speed may exceed that of maximum braking.
inline constexpr double ABOVE_LOWEST = 1e-3;

/// The coefficients of a plan from one of its cells on.
struct Course {
    const double *knots = nullptr, *c = nullptr;
    std::size_t cells = 0;
    double before = 0, behind = 0;  ///< lengths of the adjacent cells
    /// State at the fraction x in [0, 1] of a cell.
    LawState state(std::size_t cell, double x) const noexcept;
    /// The same motion up to the end of its first `count` cells.
    Course first(std::size_t count) const noexcept;
};

struct SpeedPlan {
    RestMap map;
    std::vector<double> knots, c;  ///< knots and coefficients of the cells that are not dropped
    std::vector<TimeCell> time_cells;
    std::vector<double> laid_s;  ///< time for which each cell was made; a creep takes longer [s]
    /// Permitted b at the points of each cell, above the speed limits; 0: none.
    std::vector<std::array<double, PLACES>> eased;
    /// 1 / squared speed limit at the points of each cell, from the last planning.
    std::vector<std::array<double, PLACES>> speed_rows;
    double before = 0;  ///< length of the cell before the first one; 0: none
    /// End of the known curve, and length over which a stop there is blended.
    double end_s = 0, end_ramp = 0;
    bool has_end = false;     ///< the last cell ends in the stop
    bool ends_early = false;  ///< a direct stop replaces the last cells
    bool is_fastest = false;  ///< the last plan has the minimum time
    bool lowers = false;      ///< the creep at the end of the plan still brakes for lowered speed limits

    std::size_t laid() const noexcept { return knots.empty() ? 0 : knots.size() - 1; }
    Course course_from(std::size_t fixed, const double *from) const noexcept;
    Motion motion_at(const Course &course, std::size_t cell, double x) const noexcept;
    /// Adds cells from the last one to the parameter p.
    void lay_first(double p);
    /// Changes the last coefficient for another length of the cell after the plan.
    void change_behind(double from, double to) noexcept;
    /// Drops the cells after the first `kept`.
    void cut(std::size_t kept);
    /// Drops the first `count` cells.
    void drop(std::size_t count);
    /// Copies the speed limits from the rows of the cells after the fixed ones. True if most of the plan is
    /// already the fastest one: the last plan had the minimum time for its first `old` cells, and the limits
    /// there were not lower.
    bool takes_rows(const Rows &rows, std::size_t fixed, std::size_t old);
    /// Permits the current speed in cells from `from` to `to`, even if it exceeds the speed limits.
    void ease(std::size_t from, std::size_t to);
};

}  // namespace mw::trajectory::profile
