// SPDX-License-Identifier: GPL-2.0-or-later
// Plans the motion along a curve in windows, and commits each plan with its stops.
#pragma once

#include <vector>

#include "trajectory/plan/curve_path.hh"
#include "trajectory/profile/acceleration_profile.hh"
#include "trajectory/profile/profile.hh"

namespace mw::trajectory::plan {

/// Use it in the planner thread only.
///
/// A plan continues the motion at the end of a cell that the executor has not reached. The cells before
/// remain. A plan reaches RENEWAL_S + RESERVE_S ahead, and the next plan is made after RENEWAL_S. If a plan
/// is too late, the executor ignores it and takes the last stop of the previous plan. The next plan then
/// begins at standstill.
class CurvePlanner {
  public:
    /// `is_estimate`: plans have only their last stop.
    CurvePlanner(PathStore &store, PlannedPath &moves, double period_s, bool is_estimate = false);

    /// Begins a path at `start`, where the executor is stopped.
    void begin(const Pose &start, const Snapshot &now, const Conditions &conditions);
    /// True if the current path was planned for the current limits and joints.
    bool suits(const Conditions &conditions) const noexcept {
        return path_.isEmpty() || path_.isMadeFor(conditions);
    }
    /// Appends a move that starts at the end of the path. The limits of the first move apply to the whole
    /// path.
    Sequence add(const Conditions &conditions, const Primitive &primitive, const MoveRequest &request);
    CurvePath &path() noexcept { return path_; }
    const CurvePath &path() const noexcept { return path_; }
    /// Call it when overrides have changed.
    void set_scales(const Conditions &conditions);
    /// No move follows now: the curve ends at the end of the last move.
    void release_end(const Conditions &conditions);
    /// Call it when gates or single blocks have changed.
    void renew() noexcept { is_changed_ = true; }
    /// Delays the next start by `delay_s` after the earliest possible time [s].
    void delay_start(double delay_s) noexcept { delay_s_ = delay_s; }
    /// Commits the next part of the motion.
    void update(const Snapshot &now, const Conditions &conditions);

    /// True if the pass that the executor would begin is known completely, or no more of it can follow.
    bool isPassKnown(const Snapshot &now) const noexcept {
        return path_.isPassKnown(place_of(now)) || !path_.hasRoom();
    }
    /// True if the plan covers the whole known curve, and release_end() would extend it.
    bool isStarving() const noexcept { return path_.hasOpenEnd() && (!is_running_ || !is_window_full_); }
    /// The move that the executor executes, or before which it is stopped.
    Sequence move_of(const Snapshot &now) const noexcept { return path_.move_at(place_of(now)); }
    /// The move at whose start the executor is stopped; 0: none.
    Sequence standing_before(const Snapshot &now) const noexcept;
    /// Number of consecutive failed plans at standstill.
    int failures() const noexcept { return failures_; }

    static constexpr double RENEWAL_S = 0.2;   ///< time from one plan to the next [s]
    static constexpr double RESERVE_S = 0.15;  ///< time by which a plan may be late [s]
    static constexpr double COMMITTED_S = RENEWAL_S + RESERVE_S;
    /// Length of a window with jerk limits, without the time of a stop [s].
    static constexpr double WINDOW_S = 0.45;
    static constexpr double PLANNING_S = 0.01;  ///< time from a snapshot to the first cell of its plan [s]

  private:
    double place_of(const Snapshot &now) const noexcept;
    void follow(const Snapshot &now);
    void drop_driven(const Snapshot &now);
    void start(const Snapshot &now, const Conditions &conditions);
    void start_pass(const Snapshot &now, double s, Sequence move, const Conditions &conditions);
    void continue_plan(const Snapshot &now, const Conditions &conditions);
    profile::Run run_from(double s, double least_end, const Conditions &conditions) const;
    bool hasSpeed(Sequence move) const noexcept;
    std::size_t first_free_cell(const Snapshot &now) const noexcept;
    bool commit(const Snapshot &now, std::size_t fixed);
    profile::Stop stop_from(std::size_t cell, std::size_t most_cells);
    void add_stop(CurvePlan &plan, const profile::Stop &stop) noexcept;
    void add_stops(CurvePlan &plan, std::size_t fixed, const profile::Stop &end, std::size_t room);
    double apart_of(const profile::Stop &stop) const noexcept;
    Sequence write(const profile::TimeCell &cell) noexcept;

    PathStore &store_;
    PlannedPath &moves_;
    double period_s_;
    bool is_estimate_;
    CurvePath path_;
    Scales scales_;                 ///< overrides for which the feeds of the path were calculated
    profile::Profile third_order_;  ///< profile with jerk limits
    profile::AccelerationProfile second_order_;  ///< profile without jerk limits
    profile::PathTiming *timing_;                ///< profile of the current path
    profile::Run run_;
    std::vector<profile::Stop> stops_;  ///< stops of the plan that is being committed
    std::vector<Sequence> numbers_;     ///< numbers of the committed cells of the profile
    Sequence next_cell_ = 1, next_leg_ = 1;
    std::uint64_t plan_ = 0, first_plan_ = 0;
    std::uint64_t planned_cycle_ = 0, tried_cycle_ = 0;
    double committed_s_ = 0;  ///< approximate time from the plan to its last stop [s]
    std::uint64_t drops_ = 0;
    bool is_running_ = false;    ///< a plan was committed and has not ended
    bool is_abandoned_ = false;  ///< the executor is in a stop
    bool is_changed_ = false, is_lower_ = false;
    bool is_window_full_ = false;
    double delay_s_ = 0;
    std::uint64_t start_cycle_ = 0;
    int failures_ = 0;
};

}  // namespace mw::trajectory::plan
