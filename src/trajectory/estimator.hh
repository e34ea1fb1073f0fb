// SPDX-License-Identifier: GPL-2.0-or-later
// How long a path takes, by the planner and executor that drive it, without controller, drives or HAL. Not
// realtime.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "trajectory/follow/executor.hh"
#include "trajectory/planner.hh"

namespace mw::trajectory {

/// What keeps a move from being faster.
enum class Binding : std::uint8_t { FEED, VELOCITY, ACCELERATION, JERK, TOLERANCE };

struct MoveEstimate {
    MoveTag tag;
    double seconds = 0;
    double seconds_at_feed = 0;  ///< if it ran at its feed, as overridden, throughout; 0 for rapids
    double top_velocity = 0;     ///< along the feed length
    Binding binding = Binding::FEED;
    int axis = -1;  ///< geometry::Axis of the binding limit, XYZ_NORM for the norm, -1 for none
};

class Estimator {
  public:
    using Listener = std::function<void(const MoveEstimate &)>;
    Estimator(const Limits &limits, double period_s, Listener listener);

    /// From the next begin() on.
    void set_limits(const Limits &limits);
    /// The overrides under which it drives, with the highest that the plan is made ready for, and the soft
    /// limits.
    void set_machine(const Scales &scales, const Pose &low, const Pose &high);
    /// The path begins or continues at `pose` after an action that is no motion.
    void begin(const Pose &pose);
    const Pose &end() const { return planner_->end(); }
    /// Checked while it drives, at least every CHECK_CYCLES cycles: from the first true on nothing is driven.
    void end_when(std::function<bool()> isToEnd) { isToEnd_ = std::move(isToEnd); }
    static constexpr std::uint64_t CHECK_CYCLES = 1024;
    /// Appends a move; drives earlier ones if the store is full. Moves of length 0 are left out. The work for
    /// one move is bounded: if it takes more than DRIVEN_S seconds, only its end is driven, from standstill,
    /// and its speed gives the time of the rest.
    void add(const Primitive &primitive, const MoveRequest &request);
    /// Drives to the end of the path and stops.
    void finish();
    /// False when a path stopped that nothing ended, or a move took far longer than its limits suggest: the
    /// time then lacks what was left of it.
    bool isComplete() const { return isComplete_; }
    /// All time so far [s].
    double seconds() const { return static_cast<double>(cycle_) * period_s_ + skipped_s_; }

    static constexpr double DRIVEN_S = 60;  ///< of a move [s]

  private:
    /// False when the path is stopped, or a move takes, longer than any plan can need.
    bool step();
    double speed_bound(const Primitive &primitive, const MoveRequest &request) const;
    Primitive skip_to_end(const Primitive &primitive, const MoveRequest &request);
    void count(const ExecutorOutput &out);
    void close_move();
    double ratio(int i, int order) const;

    Limits limits_;
    Scales scales_;
    double period_s_;
    std::array<double, 3> period_power_;  ///< [s, s^2, s^3]
    Listener listener_;
    std::unique_ptr<PathStore> store_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<Planner> planner_;
    std::function<bool()> isToEnd_;
    bool isEnded_ = false;  ///< by that
    std::uint64_t cycle_ = 0;
    Sequence move_ = 0;  ///< the one whose time is counted
    std::uint64_t move_cycles_ = 0;
    double move_top_ = 0;     ///< maximum speed along its parameter until now
    double move_middle_ = 0;  ///< speed in the middle of the move
    std::uint64_t standing_cycles_ = 0;
    double skipped_ = 0,
           skipped_s_ = 0;  ///< length and time that were not driven; the length of the newest move
    bool isComplete_ = true;
    std::array<Pose, 4> last_{};
    std::size_t kept_ = 0;  ///< of them, positions of consecutive cycles
    std::array<std::array<std::uint64_t, LIMITED_COUNT>, 3>
        bound_{};  ///< cycles near a limit, by order and axis
};

}  // namespace mw::trajectory
