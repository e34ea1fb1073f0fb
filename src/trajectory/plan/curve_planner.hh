// SPDX-License-Identifier: GPL-2.0-or-later
// Plans the motion along a curve in windows, and commits each plan with its stops.
#pragma once

#include <vector>

#include "trajectory/plan/curve_path.hh"
#include "trajectory/profile/acceleration_profile.hh"
#include "trajectory/profile/profile.hh"

namespace mw::trajectory::plan {

/// Planner thread.
///
/// A plan continues the motion behind a cell that the executor has not reached yet. The cells before stay. It
/// reaches RENEWAL_S + RESERVE_S ahead; the next one is made after RENEWAL_S. A plan that comes too late is
/// not taken: the executor takes the last stop of the plan before, and the next plan begins at rest.
class CurvePlanner {
  public:
    /// `is_estimate`: plans have only their last stop.
    CurvePlanner(PathStore &store, PlannedPath &moves, double period_s, bool is_estimate = false);

    /// A path begins at `start`, where the executor is at rest.
    void begin(const Pose &start, const Snapshot &now, const Conditions &conditions);
    /// The present path was made for the present limits and joints.
    bool suits(const Conditions &conditions) const noexcept {
        return path_.isEmpty() || path_.isMadeFor(conditions);
    }
    /// Appends a move that starts at the end of the path. The limits are those at the first move.
    Sequence add(const Conditions &conditions, const Primitive &primitive, const MoveRequest &request);
    CurvePath &path() noexcept { return path_; }
    const CurvePath &path() const noexcept { return path_; }
    /// Overrides have changed.
    void set_scales(const Conditions &conditions);
    /// Nothing follows for now.
    void release_end(const Conditions &conditions);
    /// Gates or single blocks have changed.
    void renew() noexcept { is_changed_ = true; }
    /// The next start is so much later than possible.
    void delay_start(double delay_s) noexcept { delay_s_ = delay_s; }
    /// Commits what the executor needs next.
    void update(const Snapshot &now, const Conditions &conditions);

    /// All of the pass that the executor would begin with is known, or no more of it can be.
    bool isPassKnown(const Snapshot &now) const noexcept {
        return path_.isPassKnown(place_of(now)) || !path_.hasRoom();
    }
    /// The plan covers all of the curve that is known, and there is more of it that could be released.
    bool isStarving() const noexcept { return path_.hasOpenEnd() && (!is_running_ || !is_window_full_); }
    /// The move that the executor is in, or before which it is at rest.
    Sequence move_of(const Snapshot &now) const noexcept { return path_.move_at(place_of(now)); }
    /// It is at rest exactly at the start of this move; 0: it is not.
    Sequence standing_before(const Snapshot &now) const noexcept;
    /// Plans without success at rest, one after the other.
    int failures() const noexcept { return failures_; }

    static constexpr double RENEWAL_S = 0.2;   ///< from one plan to the next
    static constexpr double RESERVE_S = 0.15;  ///< by which a plan may be late
    static constexpr double COMMITTED_S = RENEWAL_S + RESERVE_S;
    static constexpr double WINDOW_S = 0.45;    ///< planned at once with jerk limits, and the time of a stop
    static constexpr double PLANNING_S = 0.01;  ///< from the making of a plan to its first cell

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
    Scales scales_;                              ///< that the feeds of the path were made for
    profile::Profile third_order_;               ///< with jerk limits
    profile::AccelerationProfile second_order_;  ///< without
    profile::PathTiming *timing_;                ///< that of the present path
    profile::Run run_;
    std::vector<profile::Stop> stops_;  ///< of the plan that is being committed
    std::vector<Sequence> numbers_;     ///< of the cells of the profile that are committed
    Sequence next_cell_ = 1, next_leg_ = 1;
    std::uint64_t plan_ = 0, first_plan_ = 0;
    std::uint64_t planned_cycle_ = 0, tried_cycle_ = 0;
    double committed_s_ = 0;  ///< from then to the last stop, about
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
