// SPDX-License-Identifier: GPL-2.0-or-later
// The servo side of path motion: evaluates what the planner has committed, and stops on the path by itself.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "trajectory/follow/curve_follower.hh"
#include "trajectory/follow/pass_follower.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/follow/tap_follower.hh"

namespace mw::trajectory {

/// What a tap wants of its spindle.
struct TapDemand {
    int spindle = -1;     ///< -1: no tap is under way
    double factor = 1;    ///< of the speed that the spindle was started with; 0: off, and not on by itself
    bool isLost = false;  ///< the tool could not keep to the spindle
};

/// What the executor commands for the end of a cycle.
struct ExecutorOutput {
    Pose position;
    double velocity = 0;  ///< along the parameter of the path [1/s]
    Sequence move = 0;    ///< the move under way, 0: none
    bool isMoving = false;
    double distance_to_go = 0;  ///< to the end of the move under way
    bool isOnProbe = false;
    TapDemand tap;
};

/// State of an executor. A copy of it continues in another executor whose store holds the same path.
class ExecutorState {
  protected:
    explicit ExecutorState(double period_s) noexcept : period_(period_s) {}

    double period_;
    Snapshot state_;
    ExecutorOutput out_;
    Pose position_;
    Sequence done_ = 0;

    std::array<FollowedSpindle, MAX_SPINDLES> spindles_{};
    PassFollower pass_;
    TapFollower tap_;
    bool tapping_ = false;  ///< the tool is on the line of a tap, which it may leave at both ends
    CurveFollower curve_;
};

/// All methods: servo thread only; bounded, no allocation.
///
/// Follows the cells of a plan. Every plan has its stops: `hold`, `drop` and a planner that is late or lost
/// take the next one. The executor itself drives passes that are locked to a spindle's angle (Motion::LOCKED)
/// from stop to stop: `hold` takes effect at their end, because a paused thread is scrap; `drop` brakes at
/// once. In a tap `drop` switches the spindle off, and the tool follows it until it is stopped.
class Executor : private ExecutorState {
  public:
    explicit Executor(PathStore &store, double period_s) noexcept : ExecutorState(period_s), store_(store) {}
    /// Continues where `other` is; `store` holds the same path.
    Executor(const Executor &other, PathStore &store) noexcept : ExecutorState(other), store_(store) {}

    /// The path begins at `pose`; only at rest and with nothing left of a path.
    [[gnu::cold]] void set_position(const Pose &pose) noexcept;

    /// The angle [turns] of a spindle; call every cycle before `step`: it gives the speed.
    void set_spindle(int spindle, double turns) noexcept {
        FollowedSpindle &followed = spindles_[static_cast<std::size_t>(spindle)];
        followed.track.take(turns, period_);
    }
    const FollowedSpindle &spindle(int spindle) const noexcept {
        return spindles_[static_cast<std::size_t>(spindle)];
    }
    void set_brakings(int spindle, const SpindleBrakings &brakings) noexcept {
        spindles_[static_cast<std::size_t>(spindle)].brakings = brakings;
    }

    /// Advances to the end of `cycle`.
    [[gnu::hot]] const ExecutorOutput &step(std::uint64_t cycle) noexcept;

    /// Held: brakes and takes no plans until released.
    void hold(bool isHeld) noexcept;
    /// Brakes; when at rest everything that is left of the path is dropped.
    void drop() noexcept;
    /// Stops dead where it is and drops the path (amplifiers are off, nothing can follow a profile).
    [[gnu::cold]] void stop_now() noexcept;

    /// The next event whose place has been passed, or nullptr; pop with `drop_event`.
    const PathEvent *due_event() noexcept;
    void drop_event() noexcept { store_.events.drop(); }

    bool isAtRest() const noexcept { return state_.motion == Motion::REST; }
    /// The spindle that what moves is in step with, -1: none.
    int locked_spindle() const noexcept {
        if (state_.motion == Motion::LOCKED) [[unlikely]] {
            return curve_.plan().pass.spindle;
        }
        return -1;
    }
    /// Nothing is left of the path.
    bool isEmpty() const noexcept;
    const Snapshot &snapshot() const noexcept { return state_; }
    const ExecutorOutput &output() const noexcept { return out_; }

  private:
    void take_plans() noexcept;
    [[gnu::cold]] void come_to_rest() noexcept;
    [[gnu::hot]] void locate() noexcept;
    [[gnu::hot]] void command() noexcept;
    [[gnu::cold]] void finish_drop() noexcept;

    [[gnu::cold]] void begin_pass() noexcept;
    void step_locked() noexcept;
    bool advance_tap(const SpindleReading &spindle) noexcept;
    bool advance_pass(const SpindleReading &spindle) noexcept;

    PathStore &store_;
};

}  // namespace mw::trajectory
