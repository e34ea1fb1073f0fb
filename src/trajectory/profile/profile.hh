// SPDX-License-Identifier: GPL-2.0-or-later
// The timing of a curve from stop to stop. It is planned in windows while the curve grows.
//
// A window begins with the state at the end of the cells that remain, and ends in a creep. The last plan,
// followed by a creep over new cells, is within every limit. Each plan starts from this motion, so even a
// plan that is late or ended early is valid.
#pragma once

#include <algorithm>
#include <vector>

#include "trajectory/profile/path_timing.hh"
#include "trajectory/profile/speed_plan.hh"
#include "trajectory/profile/stop_search.hh"
#include "trajectory/profile/time_law.hh"

namespace mw::trajectory::profile {

struct ProfileSettings {
    double window_s = 0.5;   ///< time of a window, without the stop after it [s]
    double period_s = 1e-3;  ///< servo period [s]: limits hold for samples at this distance
};

/// Profile within velocity, acceleration and jerk. Use it in the planner thread only.
class Profile final : public PathTiming {
  public:
    explicit Profile(const ProfileSettings &settings) : settings_(settings) {}

    void begin(double s) noexcept override;
    bool plan(const Run &run, std::size_t fixed) override;
    bool replan(const Run &run, std::size_t fixed) override;
    /// The search for the slowest motion from an earlier cell starts with that from a later cell. Direct
    /// stops are searched only once.
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

    /// Maximum row of the start motion of the last plan, divided by its limit.
    double worst_start() const noexcept { return worst_start_; }
    /// Number of rejected plans, and maximum row of their start motions, divided by its limit.
    int rejected() const noexcept { return rejected_; }
    double worst_rejected() const noexcept { return worst_rejected_; }
    int steps() const noexcept { return steps_; }

  private:
    /// Fraction of a limit by which rounding may exceed it.
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
    Run run_;  ///< its limits include the margins
    curve::JointCurve joint_curve_;
    Rows rows_;
    TimeLaw law_;
    SpeedPlan plan_, kept_;  ///< the plan, and the previous plan while a new one is made
    std::vector<double> creep_, floors_, part_knots_;
    struct {
        std::vector<double> knots, c;
    } split_;
    /// The last slowest motion of the current plan: its coefficients from cell `from` to cell `end`. Empty:
    /// none.
    struct {
        std::vector<double> c;
        std::size_t from = 0, end = 0;
    } slowest_;
    KnownStops known_stops_;  ///< stops of the plan since begin_stops()
    double start_s_ = 0;
    double reach_ = 0;  ///< distance before the end of the known curve within which a seam may lower limits
    // A direct stop before the end of the cells, from the start of cell `ending_at_` on.
    std::size_t ending_at_ = 0, ending_cells_ = 0;
    double ending_s_ = 0;
    std::vector<TimeCell> ending_;
    double worst_start_ = 0, worst_rejected_ = 0;
    int steps_ = 0, rejected_ = 0;
};

}  // namespace mw::trajectory::profile
