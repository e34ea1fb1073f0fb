// SPDX-License-Identifier: GPL-2.0-or-later
// Looks for direct stops from the cells of a plan, and for how soon a stop is possible.
#pragma once

#include <optional>
#include <vector>

#include "trajectory/profile/speed_plan.hh"

namespace mw::trajectory::profile {

/// Which cells of a plan a direct stop from their start is known for.
class KnownStops {
  public:
    void clear() noexcept { cells_.clear(); }
    /// Null: not asked for yet.
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
    /// A direct stop in less time that ends there; by default anywhere.
    struct Goal {
        double most_s = ANYWHERE, end_s = ANYWHERE;
    };

    /// `within`: the run with the limits that are planned with. All must outlive it.
    StopSearch(const Run &run, const Run &within, const SpeedPlan &plan) noexcept
        : run_(run), within_(within), plan_(plan) {}

    /// A direct stop from the start of a cell that keeps all limits; the number of cells: from the end.
    bool find(const Course &course, std::size_t cell, const Goal &goal, DirectStop &tail) const;
    /// The first cell from whose start a direct stop passes; cells + 1: none. Looks further and further
    /// ahead, then between that and the last that does not pass. `known`: of the plan, whose cell `fixed`
    /// is the first of the course.
    std::size_t first(const Course &course, std::size_t fixed, KnownStops &known, DirectStop &tail) const;
    /// About the least time of a stop from the start of the course [s]: braking with all that the limits of
    /// acceleration leave at each place (Bobrow, Dubowsky, Gibson 1985), with ramps for the limit of jerk.
    double least_s(const Course &course) const;
    /// Cells in which a stop is looked for: a third more than a direct stop takes on a straight line.
    std::size_t cells_of_stop(const Course &course) const;

  private:
    /// How dense the places are at which limits of a direct stop are checked.
    enum class Density : std::uint8_t { COARSE, EVERY_SPAN };
    bool keepsLimits(const Course &course, std::size_t cell, const DirectStop &tail, Density density,
                     Rates &least) const;

    const Run &run_, &within_;
    const SpeedPlan &plan_;
    mutable std::size_t places_ = 0;  ///< at which direct stops were checked
};

}  // namespace mw::trajectory::profile
