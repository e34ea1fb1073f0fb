// SPDX-License-Identifier: GPL-2.0-or-later
// The planner of path motion. It makes a curve of the moves, calculates the fastest profile within the
// limits, and commits it to the executor.
#pragma once

#include "trajectory/plan/curve_planner.hh"
#include "trajectory/plan/tap_plan.hh"

namespace mw::trajectory {

struct Trouble {
    bool isStuck = false;  ///< the path is stopped, and the planner found no plan within a second
    Overreach overreach;   ///< a planner module chose speeds that exceed the limits; the path stops
};

struct PlannerSettings {
    double period_s = 1e-3;           ///< servo period [s]
    std::uint64_t latency = 3;        ///< servo cycles from the snapshot for a plan to the start of this plan
    SpeedChooser *chooser = nullptr;  ///< planner module that chooses speeds; null: none; must remain valid
    /// For the estimator: no hold or abort can occur, so a plan has only its last stop.
    bool is_estimate = false;
};

/// Call all methods in the planner thread only. Allocates memory. Equal calls give bit-identical results.
class Planner {
  public:
    Planner(PathStore &store, const PlannerSettings &settings) noexcept;

    /// Sets the limits of the next path that begins.
    void set_limits(const Limits &limits) noexcept { conditions_.limits.set(limits); }
    /// True if the current path was planned for the current limits and joints.
    bool suits() const noexcept { return curve_.suits(conditions_); }

    /// For machines whose joints are not axes. `map` must remain valid. Null: only the limits of the axes
    /// apply.
    void set_joints(const JointMap *map, const JointLimits &limits, const LinearJoints &linear = {}) noexcept;

    /// Sets the soft limits of the axes, which the path does not exceed: initially none, +-infinity for an
    /// axis without limit. Joints in `joints` are kept within their range there, other joints within their
    /// soft limits.
    void set_room(const Pose &low, const Pose &high, const JointRoom &joints = {}) noexcept;

    /// Begins a new path at `start`. The executor must be stopped there, without a remaining path.
    void begin(const Pose &start, const Snapshot &now) noexcept;

    /// True if another move can be added.
    bool hasRoom() const noexcept { return curve_.path().hasRoom(); }
    /// Appends a move that starts at `end()`. Its length must be greater than 0. Returns its number.
    Sequence add(const Primitive &primitive, const MoveRequest &request) noexcept;
    /// End of the last move, where the next move must start.
    const Pose &end() const noexcept { return curve_.path().end(); }
    /// Number of the last move of this path; 0: none.
    Sequence last_move() const noexcept { return path_.end_move(); }
    /// Adds an output change at the end of the last move. False if the queue is full.
    bool add_event(PathEvent event) noexcept;
    /// No move follows now: the last move is planned to its end.
    void release_end() noexcept;

    /// Sets overrides, the maximum velocity and spindle speeds.
    void set_scales(const Scales &scales) noexcept;
    /// Opens the gate before a gated move. Call it when the executor waits there. The motion begins `delay_s`
    /// after the earliest possible time.
    void open_gate(Sequence move, double delay_s) noexcept;
    /// True if the start of the move is delayed to a full revolution of its spindle.
    bool isPhased(Sequence move) const noexcept { return path_.move(move).request.isPhased; }
    /// Number of the spindle of the move.
    int spindle_of(Sequence move) const noexcept { return path_.move(move).request.spindle; }
    /// True if the executor locks the move to the spindle angle. The moves up to the next stop belong to it.
    bool isLocked(Sequence move) const noexcept { return conditions_.isLocked(path_.move(move).request); }
    /// True if the pass that the executor would begin is known completely.
    bool isPassKnown(const Snapshot &now) const noexcept { return curve_.isPassKnown(now); }
    /// Speed that the pass from this move on needs at the current spindle speed, divided by the maximum speed
    /// of the machine and the operator.
    double pass_load(Sequence move) const noexcept { return plan::pass_load(path_, conditions_, move); }
    /// True if the move is the cut of a rigid tap.
    bool isTap(Sequence move) const noexcept { return path_.move(move).request.isTap; }
    /// Checks whether the tap that begins with `move` is possible at the current spindle speed.
    TapVerdict check_tap(Sequence move) const noexcept {
        return plan::check_tap({path_.primitive(move), path_.move(move).request, conditions_});
    }
    /// Sets the braking data of the spindles and the resolutions of their encoders [rev].
    void set_spindles(const std::array<SpindleBrakings, MAX_SPINDLES> &brakings,
                      const std::array<double, MAX_SPINDLES> &encoder_steps) noexcept {
        conditions_.brakings = brakings;
        conditions_.encoder_steps = encoder_steps;
    }
    /// Time from a snapshot to the earliest start of a plan made with it [s].
    double latency_s() const noexcept { return static_cast<double>(settings_.latency) * settings_.period_s; }
    /// The move whose gate the executor waits at; 0: none.
    Sequence waiting_gate(const Snapshot &now) const noexcept;
    /// Single block: the path stops before moves of any block other than `block`.
    void set_step(bool isStepping, std::uint32_t block) noexcept;
    /// True if the executor is stopped and only single block prevents the motion.
    bool isAtStepStop(const Snapshot &now) const noexcept;
    /// True if `next_block` has a valid result.
    bool hasNext(const Snapshot &now) const noexcept;
    /// The block that an executor in state `now` continues with.
    std::uint32_t next_block(const Snapshot &now) const noexcept;

    /// Commits the next part of the motion. Call it once per planner period.
    void update(const Snapshot &now) noexcept;

    /// True if the committed plan reaches the end of the known path, and release_end() would extend it.
    bool isStarving() const noexcept { return curve_.isStarving(); }
    /// Returns why the path does not continue. Each reason is returned once.
    Trouble take_trouble() noexcept;
    /// Number of moves that are not complete.
    std::uint32_t moves_left(const Snapshot &now) const noexcept;

  private:
    PlannerSettings settings_;
    Conditions conditions_;
    PlannedPath path_;
    plan::CurvePlanner curve_;
    std::uint64_t drops_ = 0;  ///< Snapshot::drops at the start of this path
    bool isOverreachTold_ = false, is_stuck_told_ = false;
};

}  // namespace mw::trajectory
