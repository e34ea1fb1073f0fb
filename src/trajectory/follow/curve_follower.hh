// SPDX-License-Identifier: GPL-2.0-or-later
// Follows the curve cell by cell. If a stop is requested, or the plan ends, it takes the next stop of the
// plan.
#pragma once

#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// Call all methods in the servo thread only. They are bounded and do not allocate memory.
class CurveFollower {
  public:
    /// Position on the path.
    struct Place {
        Pose pose;
        Sequence move = 0;
        bool is_complete = false;  ///< the end of this move is reached
        double left = 0;           ///< distance to the end of this move
    };

    /// Accepts a plan of the planner. It will be ignored if the cell that it continues is already complete.
    void take(const CurvePlan &plan) noexcept;
    /// True if a plan that begins at standstill waits for its start.
    bool isWaiting() const noexcept { return waiting_.plan != 0 && waiting_.behind == 0; }
    /// Advances the motion by `dt` [s], or starts a waiting plan, and updates the motion data of `state`.
    /// During a hold or a drop, the motion takes the next stop.
    void step(const PathStore &store, double dt, Snapshot &state) noexcept;
    /// The current plan. A pass is controlled by the executor.
    const CurvePlan &plan() const noexcept { return plan_; }
    double s() const noexcept { return s_; }
    /// Sets the position of a pass.
    void set_place(double s, double v) noexcept {
        s_ = s;
        v_ = v;
    }
    /// Removes all plans.
    void clear() noexcept;
    Place place(const PathStore &store, bool is_resting) noexcept;

    /// Maximum number of cells in one cycle.
    static constexpr int MOST_CELLS_PER_CYCLE = 256;

  private:
    bool start(const Snapshot &state) noexcept;
    bool advance(const PathStore &store, double dt) noexcept;
    bool leave_cell() noexcept;
    Sequence move(const PathStore &store) noexcept;

    CurvePlan plan_, waiting_;
    std::size_t next_stop_ = 0;  ///< the first stop that is not passed
    bool stopping_ = false;      ///< in the cells of a stop, up to `end_`
    bool must_stop_ = false;
    bool planner_stop_ = false;  ///< the planner has requested a stop of this plan
    Sequence cell_ = 0, end_ = 0;
    double time_ = 0, s_ = 0, v_ = 0;
    Sequence span_ = 0, move_ = 0;
};

}  // namespace mw::trajectory
