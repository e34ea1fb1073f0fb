// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop, planned in windows while the curve still grows.
//
// A window begins with the state at the end of the cells that stay and ends in a creep. The last plan,
// followed by a creep over what is new, keeps every limit: each plan starts from it, so a plan that is late
// or stopped early can be driven.
#pragma once

#include <algorithm>
#include <vector>

#include "trajectory/profile/path_timing.hh"
#include "trajectory/profile/speed_plan.hh"
#include "trajectory/profile/stop_search.hh"
#include "trajectory/profile/time_law.hh"

namespace mw::trajectory::profile {

struct ProfileSettings {
    double window_s = 0.5;   ///< planned at once, and the time of a stop behind it
    double period_s = 1e-3;  ///< of the servo thread: limits hold for samples so far apart
};

/// Planner thread. Within velocity, acceleration and jerk.
class Profile final : public PathTiming {
  public:
    explicit Profile(const ProfileSettings &settings) : settings_(settings) {}

    void begin(double s) noexcept override;
    bool plan(const Run &run, std::size_t fixed) override;
    bool replan(const Run &run, std::size_t fixed) override;
    /// The slowest motion from a place, behind the plan up to there, is where that from an earlier place
    /// begins to be looked for, and direct stops are looked for once.
    void begin_stops(const Run &run) override;
    Stop next_stop(const Run &run, std::size_t fixed, StopEffort effort) override;
    double stops_apart_s(double stop_s) const noexcept override { return std::max(1e-2, 0.12 * stop_s); }
    double committed_part() const noexcept override { return 0.5; }
    std::size_t cells() const noexcept override {
        return plan_.ends_early ? ending_at_ + ending_.size() : plan_.laid();
    }
    const TimeCell &cell(std::size_t k) const noexcept override {
        return plan_.ends_early && k >= ending_at_ ? ending_[k - ending_at_] : plan_.time_cells[k];
    }
    bool isComplete() const noexcept override { return plan_.has_end || plan_.ends_early; }
    double end_s() const noexcept override { return plan_.ends_early ? ending_s_ : planned_s(); }
    void drop(std::size_t count) override;
    double drivable_s() const noexcept override { return joint_curve_.drivable_s(); }

    /// Largest row over its limit of the plan that the last one started from.
    double worst_start() const noexcept { return worst_start_; }
    /// Plans that were rejected, and the largest row over its limit that they would have started from.
    int rejected() const noexcept { return rejected_; }
    double worst_rejected() const noexcept { return worst_rejected_; }
    int steps() const noexcept { return steps_; }

  private:
    /// Part of a limit by which rounding may leave it.
    static constexpr double ROUNDING = 1e-6;
    void take_limits(const Run &run);
    void lay_cells(std::size_t fixed);
    void prepare(std::size_t fixed, std::size_t n);
    double make_room();
    bool isStart(double worst) noexcept;
    bool restore() noexcept;
    bool extend(const Run &run, std::size_t fixed);
    bool change(const Run &run, std::size_t fixed);
    bool make_slowest(std::size_t fixed, std::size_t n, const std::vector<double> &floors,
                      SolveSettings settings);
    void forget_slowest() noexcept { slowest_.end = 0; }
    void restart() noexcept;
    std::size_t split(const Run &run, std::size_t fixed, std::size_t n);
    int parts_of(const Run &run, const Course &course, std::size_t cell, double length) const;
    bool keepsRows(const Course &course, std::size_t cell, int parts);
    bool slow_down(const Run &run, std::size_t fixed);
    double time_of(const Stop &stop, std::size_t fixed) const;
    void stop_sooner(const Run &run, std::size_t fixed, double enough_s, Stop &out);
    void make_time_cells(std::size_t fixed);
    bool endsNear(const Run &run) const noexcept;
    bool end_early(const Run &run, std::size_t fixed);
    bool isInEnding() const noexcept { return plan_.ends_early && ending_.size() < ending_cells_; }
    double planned_s() const noexcept;

    ProfileSettings settings_;
    RoughProfile rough_;
    Run run_;  ///< its limits with the margins
    curve::JointCurve joint_curve_;
    Rows rows_;
    TimeLaw law_;
    SpeedPlan plan_, kept_;  ///< what is planned, and the plan before while another one is made
    std::vector<double> creep_, floors_, part_knots_;
    struct {
        std::vector<double> knots, c;
    } split_;
    /// The slowest motion of the present plan that was found last: its coefficients from a cell on, up to
    /// the end of another. No cells: none.
    struct {
        std::vector<double> c;
        std::size_t from = 0, end = 0;
    } slowest_;
    KnownStops known_stops_;  ///< of the plan, since begin_stops()
    double start_s_ = 0;
    double reach_ = 0;  ///< before the end of what is known: a seam there may lower limits so far
    // A direct stop before the end of the cells, from the start of one of them on.
    std::size_t ending_at_ = 0, ending_cells_ = 0;
    double ending_s_ = 0;
    std::vector<TimeCell> ending_;
    double worst_start_ = 0, worst_rejected_ = 0;
    int steps_ = 0, rejected_ = 0;
};

}  // namespace mw::trajectory::profile
