// SPDX-License-Identifier: GPL-2.0-or-later
// Calculates the shortest time along a curve within velocity and acceleration limits.
//
// The backward pass over the known curve calculates the maximum squared speed at each cell from which a stop
// at the end of the known curve is within every limit. The forward pass uses the maximum acceleration up to
// these speeds. The speeds only grow when more of the curve is known, so each plan can continue the previous
// one.
#pragma once

#include <algorithm>
#include <vector>

#include "trajectory/profile/acceleration_cells.hh"
#include "trajectory/profile/path_timing.hh"

namespace mw::trajectory::profile {

/// A point of the motion: its position on the curve, and the squared speed.
struct MotionPoint {
    double s = 0, b = 0;
};

/// Use it in the planner thread only.
class AccelerationProfile final : public PathTiming {
  public:
    /// `window_s`: time of a window [s]. `period_s`: servo period [s].
    AccelerationProfile(double window_s, double period_s) : window_s_(window_s), period_s_(period_s) {}

    void begin(double s) noexcept override;
    bool plan(const Run &run, std::size_t fixed) override;
    bool replan(const Run &run, std::size_t fixed) override { return plan(run, fixed); }
    void begin_stops(const Run &) override {}
    Stop next_stop(const Run &run, std::size_t fixed, StopEffort effort) override;
    double stops_apart_s(double stop_s) const noexcept override { return std::max(5e-3, 0.1 * stop_s); }
    double committed_part() const noexcept override { return 1; }
    std::size_t cells() const noexcept override { return time_cells_.size(); }
    const TimeCell &cell(std::size_t k) const noexcept override { return time_cells_[k]; }
    bool isComplete() const noexcept override { return is_complete_; }
    double end_s() const noexcept override { return end_s_; }
    void drop(std::size_t count) override;
    double drivable_s() const noexcept override { return joint_curve_.drivable_s(); }

  private:
    using State = MotionPoint;
    void take_limits(const Run &run);
    void lay(const State &from, double time_s);
    /// Squared speeds at the ends of a cell.
    using Ends = std::array<double, 2>;
    Ends limited_b(std::size_t &feed, const AccelerationCell &cell) const noexcept;
    void pass_backward();
    void allow_braking(const State &from);
    double brake(const AccelerationCell &cell, double b, double &stop_s) const noexcept;
    double pass_forward(State from);
    void drive(const AccelerationCell &cell, std::size_t k, State &from);
    void drive_straight(const AccelerationCell &cell, std::size_t k, State &from);
    void add(const State &from, double b, double length);
    Stop stop_from(const State &from);
    bool stop_soon(const State &from, std::size_t fixed);
    State state_at(std::size_t cell) const noexcept;
    const AccelerationCell &cell_at(std::size_t k) const noexcept {
        return k == 0 ? head_ : k == tail_at_ ? tail_ : cells_[k];
    }

    double window_s_, period_s_;
    Run run_;
    curve::JointCurve joint_curve_;
    AccelerationCells cells_;
    AccelerationCell head_, tail_;  ///< rest of the first cell; cell in which the run ends
    std::size_t tail_at_ = 0;       ///< index of the cell that `tail_` replaces; 0: none
    std::vector<Ends> speed_;       ///< squared speed limits
    std::vector<double> most_;      ///< maximum squared speeds from which a stop is possible
    std::vector<double> braked_;    ///< squared speeds of maximum braking at the ends of the cells
    double start_s_ = 0, drivable_end_s_ = 0;
    std::vector<TimeCell> time_cells_;
    double end_s_ = 0;
    bool is_complete_ = false;
    /// Data of the last run: whether it had a stop, its end, the distance before the end within which a seam
    /// may lower limits.
    bool had_stop_ = false;
    double run_end_s_ = 0, reach_ = 0;
};

}  // namespace mw::trajectory::profile
