// SPDX-License-Identifier: GPL-2.0-or-later
// The servo side of path motion: evaluates what the planner has committed, and stops on the path by itself.
#pragma once

#include <cstdint>

#include "traj/path_store.hh"

namespace mw::traj {

/// What the executor commands for the end of a cycle.
struct ExecutorOutput {
    Pose position;
    double velocity = 0;  ///< along the parameter of the path [1/s]
    Sequence move = 0;    ///< the move under way, 0: none
    bool isMoving = false;
    double distance_to_go = 0;  ///< to the end of the move under way
    bool isOnProbe = false;
};

/// All methods: servo thread only; bounded, no allocation.
///
/// Follows phases; when they run out, or on `hold` and `drop`, it brakes with each piece's own acceleration
/// along the path. A late or lost planner therefore means a stop on the path.
/// With jerk limits (Commit::filter above 1) a leader does this and its mean is commanded; the planner then
/// ends every plan with a stop, and answers `hold` and `drop` with a plan.
class Executor {
  public:
    explicit Executor(PathStore &store, double period_s) noexcept : store_(store), period_(period_s) {}

    /// The path begins at `pose`; only at rest and with nothing left of a path.
    void set_position(const Pose &pose) noexcept;

    /// Advances to the end of `cycle`.
    const ExecutorOutput &step(std::uint64_t cycle) noexcept;

    /// Held: brakes and takes no plans until released.
    void hold(bool isHeld) noexcept;
    /// Brakes; when at rest everything that is left of the path is dropped.
    void drop() noexcept;
    /// Stops dead where it is and drops the path (amplifiers are off, nothing can follow a profile).
    void stop_now() noexcept;

    /// The next event whose place has been passed, or nullptr; pop with `drop_event`.
    const PathEvent *due_event() noexcept;
    void drop_event() noexcept { store_.events.drop(); }

    bool isAtRest() const noexcept { return state_.motion == Motion::REST && state_.isSettled; }
    /// Nothing is left of the path.
    bool isEmpty() const noexcept;
    const Snapshot &snapshot() const noexcept { return state_; }
    const ExecutorOutput &output() const noexcept { return out_; }

    /// Upper bound of phases and pieces passed in one cycle; the planner keeps below it.
    static constexpr int MAX_STEPS_PER_CYCLE = 4096;

  private:
    void take_commits() noexcept;
    void advance(double dt) noexcept;
    double follow(double dt) noexcept;
    double brake_along(double dt) noexcept;
    void start_brake() noexcept;
    void brake_on_piece() noexcept;
    void come_to_rest() noexcept;
    void locate() noexcept;
    void filter() noexcept;
    bool follow_along() noexcept;
    void finish_drop() noexcept;
    bool isFiltered() const noexcept { return state_.filter > 1; }

    PathStore &store_;
    double period_;
    Snapshot state_;
    ExecutorOutput out_;
    Commit next_switch_;      ///< plan != 0: waits for its cycle
    Sequence phase_end_ = 0;  ///< phases of the plan taken end here
    Sequence next_end_ = 0;   ///< the same of the waiting switch
    Phase brake_;             ///< the braking profile on the present piece
    double brake_time_ = 0;
    bool isBrakeFinal_ = false;  ///< it ends in a stop
    Pose leader_;
    double leader_s_ = 0, leader_tolerance_ = 0;
    Sequence leader_done_ = 0;
    MeanFilter mean_;
    Sequence along_ = 0;  ///< the primitive of which the mean place is commanded, 0: none
    std::uint64_t along_first_ = 0, along_last_ = 0;  ///< ticks on it
    std::array<double, HISTORY_CAPACITY> along_history_{};
    std::uint64_t rest_ticks_ = MAX_FILTER;  ///< since the leader stands
    std::array<Sequence, HISTORY_CAPACITY> done_history_{};
};

}  // namespace mw::traj
