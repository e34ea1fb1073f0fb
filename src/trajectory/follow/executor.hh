// SPDX-License-Identifier: GPL-2.0-or-later
// The servo side of path motion. It evaluates the committed plan and can stop on the path without the
// planner.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "trajectory/follow/curve_follower.hh"
#include "trajectory/follow/pass_follower.hh"
#include "trajectory/follow/spindle_track.hh"
#include "trajectory/follow/tap_follower.hh"

namespace mw::trajectory {

/// Spindle command of a tap.
struct TapDemand {
    int spindle = -1;   ///< number of the spindle; -1: no tap is active
    double factor = 1;  ///< factor of the speed with which the spindle was started; 0: off, without a restart
                        ///< by the executor
    bool isLost = false;  ///< the tool could not follow the spindle
};

/// Command of the executor for the end of a cycle.
struct ExecutorOutput {
    Pose position;
    double velocity = 0;  ///< speed along the parameter of the path [1/s]
    Sequence move = 0;    ///< current move; 0: none
    bool isMoving = false;
    double distance_to_go = 0;  ///< distance to the end of the current move, in the unit of s
    bool isOnProbe = false;
    TapDemand tap;
};

/// State of an executor. A copy of it can continue in another executor with a copy of the store.
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
    bool tapping_ = false;  ///< the tool is on the line of a tap, which it may exceed at both ends
    CurveFollower curve_;
};

/// Call all methods in the servo thread only. They are bounded and do not allocate memory.
///
/// The executor follows the cells of a plan. Every plan contains its stops: `hold`, `drop` and a late or lost
/// planner take the next stop. The executor itself controls passes that are locked to a spindle angle
/// (Motion::LOCKED), from stop to stop. In a pass, `hold` takes effect at its end, because a paused thread is
/// scrap. `drop` brakes at once. In a tap, `drop` switches the spindle off, and the tool follows the spindle
/// until it is stopped.
class Executor : private ExecutorState {
  public:
    explicit Executor(PathStore &store, double period_s) noexcept : ExecutorState(period_s), store_(store) {}
    /// Continues from the state of `other`. `store` must hold the same path.
    Executor(const Executor &other, PathStore &store) noexcept : ExecutorState(other), store_(store) {}

    /// Begins a path at `pose`. Call it only at standstill, without a remaining path.
    [[gnu::cold]] void set_position(const Pose &pose) noexcept;

    /// Sets the angle of a spindle [rev]. Call it in every cycle before `step`; the speed is calculated from
    /// it.
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

    /// Advances the motion to the end of `cycle`.
    [[gnu::hot]] const ExecutorOutput &step(std::uint64_t cycle) noexcept;

    /// While held, the motion brakes, and no plan is accepted.
    void hold(bool isHeld) noexcept;
    /// Brakes. At standstill, the rest of the path is dropped.
    void drop() noexcept;
    /// Stops in this cycle and drops the path. For disabled amplifiers, which cannot follow a profile.
    [[gnu::cold]] void stop_now() noexcept;

    /// The next event whose move is complete, or nullptr. Remove it with `drop_event`.
    const PathEvent *due_event() noexcept;
    void drop_event() noexcept { store_.events.drop(); }

    bool isAtRest() const noexcept { return state_.motion == Motion::REST; }
    /// The spindle to which the current motion is locked; -1: none.
    int locked_spindle() const noexcept {
        if (state_.motion == Motion::LOCKED) [[unlikely]] {
            return curve_.plan().pass.spindle;
        }
        return -1;
    }
    /// True if no path remains.
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
