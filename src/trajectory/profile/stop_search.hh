// SPDX-License-Identifier: GPL-2.0-or-later
// Searches direct stops from the cells of a plan, and estimates how soon a stop is possible.
#pragma once

#include <optional>
#include <vector>

#include "trajectory/profile/speed_plan.hh"

namespace mw::trajectory::profile {

/// Results of the search for direct stops from the starts of the cells of a plan.
class KnownStops {
  public:
    void clear() noexcept { cells_.clear(); }
    /// Null: not searched yet.
    const std::optional<DirectStop> *get(std::size_t cell) const noexcept {
        return cell < cells_.size() && cells_[cell].is_known ? &cells_[cell].stop : nullptr;
    }
    void set(std::size_t cell, const std::optional<DirectStop> &stop) {
        cells_.resize(std::max(cells_.size(), cell + 1));
        cells_[cell] = {true, stop};
    }

  private:
    struct Cell {
        bool is_known = false;
        std::optional<DirectStop> stop;
    };
    std::vector<Cell> cells_;
};

class StopSearch {
  public:
    static constexpr double ANYWHERE = 1e300;
    /// A direct stop in less than `most_s` that ends at `end_s`; by default in any time at any position.
    struct Goal {
        double most_s = ANYWHERE, end_s = ANYWHERE;
    };

    /// `within`: the run with the limits for planning. All arguments must outlive the search.
    StopSearch(const Run &run, const Run &within, const SpeedPlan &plan) noexcept
        : run_(run), within_(within), plan_(plan) {}

    /// Searches a direct stop within all limits from the start of a cell. If `cell` is the number of cells,
    /// it begins at their end.
    bool find(const Course &course, std::size_t cell, const Goal &goal, DirectStop &tail) const;
    /// The first cell from whose start a direct stop is within the limits; cells + 1: none. It searches with
    /// increasing steps, then between the last failure and the first success. `known`: results of the plan,
    /// whose cell `fixed` is the first of the course.
    std::size_t first(const Course &course, std::size_t fixed, KnownStops &known, DirectStop &tail) const;
    /// Approximate minimum time of a stop from the start of the course [s]: maximum braking at each position
    /// within the acceleration limits (Bobrow, Dubowsky, Gibson 1985), with ramps for the jerk limit.
    double least_s(const Course &course) const;
    /// Number of cells in which a stop is searched: a third more than a direct stop needs on a straight line.
    std::size_t cells_of_stop(const Course &course) const;

  private:
    /// Density of the points at which the limits of a direct stop are checked.
    enum class Density : std::uint8_t { COARSE, EVERY_SPAN };
    bool keepsLimits(const Course &course, std::size_t cell, const DirectStop &tail, Density density,
                     Rates &least) const;

    const Run &run_, &within_;
    const SpeedPlan &plan_;
    mutable std::size_t places_ = 0;  ///< number of points that were checked
};

}  // namespace mw::trajectory::profile
