// SPDX-License-Identifier: GPL-2.0-or-later
// The motion along a curve: cell after cell of the plan, and into its next stop when that is requested or the
// plan ends.
#pragma once

#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// All methods: servo thread only; bounded, no allocation.
class CurveFollower {
  public:
    /// Where it is.
    struct Place {
        Pose pose;
        Sequence move = 0;
        bool is_complete = false;  ///< at the end of this move or behind it
        double left = 0;           ///< to the end of this move
    };

    /// A plan of the planner. One that continues a cell which is already left is not taken.
    void take(const CurvePlan &plan) noexcept;
    /// A plan that begins at rest waits.
    bool isWaiting() const noexcept { return waiting_.plan != 0 && waiting_.behind == 0; }
    /// Continues for `dt` [s], or begins a plan that waits; sets what `state` says of the motion. While it is
    /// held or dropping it takes the next stop.
    void step(const PathStore &store, double dt, Snapshot &state) noexcept;
    /// The present plan; with a pass, someone else drives it.
    const CurvePlan &plan() const noexcept { return plan_; }
    double s() const noexcept { return s_; }
    /// Where a pass is.
    void set_place(double s, double v) noexcept {
        s_ = s;
        v_ = v;
    }
    /// Nothing is left of any plan.
    void clear() noexcept;
    Place place(const PathStore &store, bool is_resting) noexcept;

    /// Cells that one cycle may pass at most.
    static constexpr int MOST_CELLS_PER_CYCLE = 256;

  private:
    bool start(const Snapshot &state) noexcept;
    bool advance(const PathStore &store, double dt) noexcept;
    bool leave_cell() noexcept;
    Sequence move(const PathStore &store) noexcept;

    CurvePlan plan_, waiting_;
    std::size_t next_stop_ = 0;  ///< the first one that is not behind
    bool stopping_ = false;      ///< in the cells of a stop, up to `end_`
    bool must_stop_ = false;
    bool planner_stop_ = false;  ///< requested by the planner, for this plan
    Sequence cell_ = 0, end_ = 0;
    double time_ = 0, s_ = 0, v_ = 0;
    Sequence span_ = 0, move_ = 0;
};

}  // namespace mw::trajectory
