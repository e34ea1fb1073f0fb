// SPDX-License-Identifier: GPL-2.0-or-later
// Calculates the time of a path with the planner and the executor, without controller, drives or HAL. Not
// realtime.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "trajectory/follow/executor.hh"
#include "trajectory/planner.hh"

namespace mw::trajectory {

/// The limit that determines the speed of a move.
enum class Binding : std::uint8_t { FEED, VELOCITY, ACCELERATION, JERK, TOLERANCE };

struct MoveEstimate {
    MoveTag tag;
    double seconds = 0;
    /// Time at the programmed feed with the feed override, without acceleration [s]; 0 for rapids.
    double seconds_at_feed = 0;
    double top_velocity = 0;  ///< maximum speed along the feed length [unit/s]
    Binding binding = Binding::FEED;
    int axis = -1;  ///< geometry::Axis of the binding limit, XYZ_NORM for the norm, -1 for none
};

class Estimator {
  public:
    using Listener = std::function<void(const MoveEstimate &)>;
    Estimator(const Limits &limits, double period_s, Listener listener);

    /// Sets the limits for paths from the next begin() on.
    void set_limits(const Limits &limits);
    /// Sets the overrides, with the maximum override that plans must be ready for, and the soft limits.
    void set_machine(const Scales &scales, const Pose &low, const Pose &high);
    /// Begins the path at `pose`, or continues it there after an action without motion.
    void begin(const Pose &pose);
    const Pose &end() const { return planner_->end(); }
    /// `isToEnd` is called at least every CHECK_CYCLES cycles. After it has returned true, nothing more is
    /// simulated.
    void end_when(std::function<bool()> isToEnd) { isToEnd_ = std::move(isToEnd); }
    static constexpr std::uint64_t CHECK_CYCLES = 1024;
    /// Appends a move. If the store is full, earlier moves are simulated first. Moves of length 0 are
    /// ignored. If the move takes more than DRIVEN_S seconds, only its end is simulated, from standstill; the
    /// time of the rest follows from the speed in its middle.
    void add(const Primitive &primitive, const MoveRequest &request);
    /// Simulates the motion to the end of the path, with a stop there.
    void finish();
    /// False if the simulation was ended, if the path stopped before its end, or if a move took far longer
    /// than its limits suggest. seconds() then lacks the time of the remaining path.
    bool isComplete() const { return isComplete_; }
    /// Total time until now [s].
    double seconds() const { return static_cast<double>(cycle_) * period_s_ + skipped_s_; }

    static constexpr double DRIVEN_S = 60;  ///< maximum simulated time of one move [s]

  private:
    /// Simulates one servo cycle. False if the path is stopped, or a move takes, longer than any plan needs.
    bool step();
    double speed_bound(const Primitive &primitive, const MoveRequest &request) const;
    Primitive skip_to_end(const Primitive &primitive, const MoveRequest &request);
    void count(const ExecutorOutput &out);
    void close_move();
    double ratio(int i, int order) const;

    Limits limits_;
    Scales scales_;
    double period_s_;
    std::array<double, 3> period_power_;  ///< powers of the period [s, s^2, s^3]
    Listener listener_;
    std::unique_ptr<PathStore> store_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<Planner> planner_;
    std::function<bool()> isToEnd_;
    bool isEnded_ = false;  ///< `isToEnd_` has returned true
    std::uint64_t cycle_ = 0;
    Sequence move_ = 0;  ///< the move whose time is counted
    std::uint64_t move_cycles_ = 0;
    double move_top_ = 0;     ///< maximum speed along the parameter of the move until now
    double move_middle_ = 0;  ///< speed in the middle of the move
    std::uint64_t standing_cycles_ = 0;
    /// Length of the newest move that is not simulated; total time that is not simulated [s].
    double skipped_ = 0, skipped_s_ = 0;
    bool isComplete_ = true;
    std::array<Pose, 4> last_{};
    std::size_t kept_ = 0;  ///< number of positions in `last_` from consecutive cycles
    std::array<std::array<std::uint64_t, LIMITED_COUNT>, 3>
        bound_{};  ///< cycles near a limit, by order of the derivative and axis
};

}  // namespace mw::trajectory
