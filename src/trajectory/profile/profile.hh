// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop, planned in windows while the curve still grows.
//
// A window begins with the state at the end of the cells that stay and ends in a creep. The last plan,
// followed by a creep over what is new, keeps every limit: each plan starts from it, so a plan that is late
// or stopped early can be driven.
#pragma once

#include <vector>

#include "trajectory/profile/cells.hh"
#include "trajectory/profile/time_law.hh"

namespace mw::trajectory::profile {

/// s(t) of a cell: a polynomial of degree five from its start, t in [0, duration].
struct TimeCell {
    double duration = 0;
    std::array<double, 6> c{};
    double s_at(double t) const noexcept {
        return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
    }
};

struct ProfileSettings {
    double cell_s =
        2e-3;  ///< length of a cell in time; with high jerk limits a part of the time of a full acceleration
    double window_s = 0.5;  ///< planned at once
};

/// Planner thread. Cells that were planned stay in it until they are dropped, so that another motion can
/// begin at the start of each.
class Profile {
  public:
    explicit Profile(const ProfileSettings &settings) : settings_(settings) {}

    /// A run begins, at rest at `s`.
    void begin(double s) noexcept;
    /// Plans a window of the run behind the first `fixed` cells, which stay. The limits are those of the last
    /// plan or higher, the end of the run the same or farther away.
    void plan(const Run &run, std::size_t fixed);
    /// Cells that are planned and not dropped.
    std::size_t cells() const noexcept { return knots_.empty() ? 0 : knots_.size() - 1; }
    const TimeCell &cell(std::size_t k) const noexcept { return time_cells_[k]; }
    /// The last cell ends in the stop of the run.
    bool isComplete() const noexcept { return has_end_; }
    /// The first `count` cells are driven.
    void drop(std::size_t count);

    /// Largest row over its limit of the plan that the last one started from.
    double worst_start() const noexcept { return worst_start_; }
    int steps() const noexcept { return steps_; }

  private:
    void take_limits(const Run &run);
    void lay_cells(std::size_t fixed);
    void make_time_cells(std::size_t fixed);
    double planned_s() const noexcept;

    ProfileSettings settings_;
    double cell_s_ = 0;
    RestMap map_;
    RoughProfile rough_;
    Run run_;  ///< its limits with the margins
    Rows rows_;
    TimeLaw law_;
    std::vector<double> knots_, c_;  ///< of the cells that have not been dropped
    std::vector<TimeCell> time_cells_;
    double start_s_ = 0;
    double creep_scale_ = 0;  ///< of the last cell of the creep
    double before_ = 0;       ///< length of the cell before them; 0: there is none
    double end_s_ = 0,
           end_ramp_ =
               0;  ///< end of the curve as it is known, and the length over which a stop there is blended
    bool has_end_ = false;  ///< the last cell ends in the stop
    double worst_start_ = 0;
    int steps_ = 0;
};

}  // namespace mw::trajectory::profile
