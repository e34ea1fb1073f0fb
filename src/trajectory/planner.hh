// SPDX-License-Identifier: GPL-2.0-or-later
// The planning side of path motion: joins moves, finds the fastest profile within the limits, commits it.
#pragma once

#include "trajectory/plan/curve_planner.hh"
#include "trajectory/plan/tap_plan.hh"

namespace mw::trajectory {

struct Trouble {
    bool isStuck = false;  ///< it is stopped and found no plan within a second
    Overreach overreach;   ///< of who chooses speeds: the path stops
};

struct PlannerSettings {
    double period_s = 1e-3;           ///< of the servo
    std::uint64_t latency = 3;        ///< cycles from a plan's making to its start
    SpeedChooser *chooser = nullptr;  ///< chooses speeds instead of the fastest; stays valid
    bool is_estimate = false;         ///< nothing stops the motion, so a plan has only its last stop
};

/// All methods: planner thread only. Allocates. Same calls with the same values: same bits.
class Planner {
  public:
    Planner(PathStore &store, const PlannerSettings &settings) noexcept;

    /// Limits of the next path that begins.
    void set_limits(const Limits &limits) noexcept { conditions_.limits.set(limits); }
    /// The present path was made for the present limits and joints.
    bool suits() const noexcept { return curve_.suits(conditions_); }

    /// For machines whose joints are not axes; `map` stays valid. Null: the axes' limits are all there are.
    void set_joints(const JointMap *map, const JointLimits &limits, const LinearJoints &linear = {}) noexcept;

    /// Soft limits of the axes: the path never leaves them. None to begin
    /// with; +-infinity where none holds. Joints with a room are kept within that, others within their soft
    /// limits.
    void set_room(const Pose &low, const Pose &high, const JointRoom &joints = {}) noexcept;

    /// A new path begins at `start`, where the executor rests with nothing left of another.
    void begin(const Pose &start, const Snapshot &now) noexcept;

    /// One more move can be added.
    bool hasRoom() const noexcept { return curve_.path().hasRoom(); }
    /// Appends a move that starts at `end()`; its length must be greater than 0. Returns its number.
    Sequence add(const Primitive &primitive, const MoveRequest &request) noexcept;
    /// Where the next move starts.
    const Pose &end() const noexcept { return curve_.path().end(); }
    /// Of this path, 0 as long as it has none.
    Sequence last_move() const noexcept { return path_.end_move(); }
    /// An output change when what has been added so far is complete; false when there is no room.
    bool add_event(PathEvent event) noexcept;
    /// Nothing follows for now: the last move is planned to its very end.
    void release_end() noexcept;

    void set_scales(const Scales &scales) noexcept;
    /// The gate before gated moves; open it once the executor waits there.
    /// Motion begins `delay_s` after the earliest moment.
    void open_gate(Sequence move, double delay_s) noexcept;
    bool isPhased(Sequence move) const noexcept { return path_.move(move).request.isPhased; }
    int spindle_of(Sequence move) const noexcept { return path_.move(move).request.spindle; }
    /// The move is driven by the executor, locked to the spindle's angle, with what follows up to a stop.
    bool isLocked(Sequence move) const noexcept { return conditions_.isLocked(path_.move(move).request); }
    /// All of the pass that the executor would begin with is known.
    bool isPassKnown(const Snapshot &now) const noexcept { return curve_.isPassKnown(now); }
    /// Speed that the pass from this move on needs at the present speed of its spindle, over what the machine
    /// and the operator allow.
    double pass_load(Sequence move) const noexcept { return plan::pass_load(path_, conditions_, move); }
    bool isTap(Sequence move) const noexcept { return path_.move(move).request.isTap; }
    TapVerdict check_tap(Sequence move) const noexcept {
        return plan::check_tap({path_.primitive(move), path_.move(move).request, conditions_});
    }
    void set_spindles(const std::array<SpindleBrakings, MAX_SPINDLES> &brakings,
                      const std::array<double, MAX_SPINDLES> &encoder_steps) noexcept {
        conditions_.brakings = brakings;
        conditions_.encoder_steps = encoder_steps;
    }
    /// Seconds from a snapshot to the earliest start of a plan made with it.
    double latency_s() const noexcept { return static_cast<double>(settings_.latency) * settings_.period_s; }
    /// Move whose gate the executor waits at, 0: none.
    Sequence waiting_gate(const Snapshot &now) const noexcept;
    /// Single blocks: stops where the source block is another than `block`.
    void set_step(bool isStepping, std::uint32_t block) noexcept;
    /// The executor is stopped, and only single blocks keep it from continuing.
    bool isAtStepStop(const Snapshot &now) const noexcept;
    /// `next_block` has an answer.
    bool hasNext(const Snapshot &now) const noexcept;
    /// The block that comes next for an executor in state `now`.
    std::uint32_t next_block(const Snapshot &now) const noexcept;

    /// Commits what the executor needs next. Call once a planner period.
    void update(const Snapshot &now) noexcept;

    /// The committed plan runs to the end of the known path and there is an open end that could be released.
    bool isStarving() const noexcept { return curve_.isStarving(); }
    /// Why the path does not continue; each once.
    Trouble take_trouble() noexcept;
    std::uint32_t moves_left(const Snapshot &now) const noexcept;

  private:
    PlannerSettings settings_;
    Conditions conditions_;
    PlannedPath path_;
    plan::CurvePlanner curve_;
    std::uint64_t drops_ = 0;  ///< Snapshot::drops of this path
    bool isOverreachTold_ = false, is_stuck_told_ = false;
};

}  // namespace mw::trajectory
