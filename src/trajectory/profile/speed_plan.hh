// SPDX-License-Identifier: GPL-2.0-or-later
// What is planned of a run: the spline of the squared speed on its cells.
#pragma once

#include <array>
#include <vector>

#include "trajectory/profile/cells.hh"
#include "trajectory/profile/stop_law.hh"

namespace mw::trajectory::profile {

/// Part by which the speed may exceed that of the soonest braking, squared.
inline constexpr double ABOVE_LOWEST = 1e-3;

/// The coefficients of a plan from one of its cells on.
struct Course {
    const double *knots = nullptr, *c = nullptr;
    std::size_t cells = 0;
    double before = 0, behind = 0;  ///< lengths of the cells beside them
    /// At the part x in [0, 1] of a cell.
    LawState state(std::size_t cell, double x) const noexcept;
    /// The same motion up to the end of its first `count` cells.
    Course first(std::size_t count) const noexcept;
};

struct SpeedPlan {
    RestMap map;
    std::vector<double> knots, c;  ///< of the cells that have not been dropped
    std::vector<TimeCell> time_cells;
    std::vector<double> laid_s;  ///< time that each cell was laid for; a creep takes longer
    /// What b may be at the places of each cell, above the limits of the speed; 0: nothing.
    std::vector<std::array<double, PLACES>> eased;
    /// 1 over the squared limit of the speed at the places of each cell, when it was planned last.
    std::vector<std::array<double, PLACES>> speed_rows;
    double before = 0;  ///< length of the cell before them; 0: there is none
    /// End of the curve as it is known, and the length over which a stop there is blended.
    double end_s = 0, end_ramp = 0;
    bool has_end = false;     ///< the last cell ends in the stop
    bool ends_early = false;  ///< a direct stop takes the place of the last cells
    bool is_fastest = false;  ///< the last plan made the time least
    bool lowers = false;      ///< the creep behind the plan still brakes for lowered limits of the speed

    std::size_t laid() const noexcept { return knots.empty() ? 0 : knots.size() - 1; }
    Course course_from(std::size_t fixed, const double *from) const noexcept;
    Motion motion_at(const Course &course, std::size_t cell, double x) const noexcept;
    /// Cells from the end of those laid to p.
    void lay_first(double p);
    /// The last coefficient for another length of the cell behind the plan.
    void change_behind(double from, double to) noexcept;
    /// Drops the cells behind the first `kept`.
    void cut(std::size_t kept);
    /// Drops the first cells.
    void drop(std::size_t count);
    /// Takes the limits of the speed from the rows of the cells behind the fixed ones. True if most of the
    /// plan is the fastest one already: the last plan made its first `old` cells so, for limits that were not
    /// lower.
    bool takes_rows(const Rows &rows, std::size_t fixed, std::size_t old);
    /// What is above limits of the speed in some cells is allowed from now on.
    void ease(std::size_t from, std::size_t to);
};

}  // namespace mw::trajectory::profile
