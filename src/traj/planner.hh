// SPDX-License-Identifier: GPL-2.0-or-later
// The planning side of path motion: joins moves, finds the fastest profile within the limits, commits it.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "traj/joint_map.hh"
#include "traj/limits.hh"
#include "traj/path_store.hh"
#include "traj/tuning.hh"

namespace mw::traj {

enum class Join : std::uint8_t {
    STOP,   ///< comes to a stop at the end of the move
    EXACT,  ///< passes the end without a stop only where the path goes on in the same direction
    BLEND,  ///< rounds the corner within the tolerance
};

/// One move besides its geometry.
struct MoveRequest {
    MoveTag tag;
    Join join = Join::BLEND;
    /// Of a blend [machine units; degrees over ABC]; 0: as the speed needs, in proportion to the move.
    double tolerance = 0;
    double corner_scale = 1;     ///< with jerk limits: part of the reachable speed in corners (G64 R)
    bool isMergeAdded = false;   ///< joining may take all of merge_tolerance, on top of `tolerance`
    double merge_tolerance = 0;  ///< lines may be joined to one that is no farther from their ends (G64 Q)
    /// The merge tolerance that `q` means; call with tolerance and isMergeAdded set.
    void set_merge(double q) noexcept {
        // A Q as large as P says no more than P does.
        merge_tolerance = isMergeAdded || !(tolerance > 0) || q < tolerance ? q : 0.0;
    }
    bool isRapid = false;  ///< as fast as the limits allow, scaled by Scales::rapid
    bool isOverridable = true;
    bool isAngular = false;  ///< the feed length is over ABC: the operator's velocity ceiling does not apply
    double feed_per_revolution = 0;  ///< > 0: the speed follows a spindle
    int spindle = 0;
    bool isSynched() const noexcept { return feed_per_revolution > 0; }
    bool isLocked = false;  ///< keeps to the angle of the spindle: a thread
    bool isGated = false;   ///< a stop before it until the gate opens
    bool isPhased = false;  ///< the gate opens at a spindle phase
};

/// What may change while the path is under way.
struct Scales {
    double feed = 1.0;
    double rapid = 1.0;
    double max_feed = 1.0;            ///< highest `feed` that will come; limits are made for it
    double max_velocity = UNLIMITED;  ///< operator's ceiling along the feed length
    std::array<double, MAX_SPINDLES> spindle_rps{};
};

struct PlannerSettings {
    double period_s = 1e-3;     ///< of the servo
    std::uint64_t latency = 3;  ///< cycles from a plan's making to its start
    double horizon_s = 0.1;     ///< how far ahead phases are committed
    bool isMerging = true;      ///< nearly straight lines become one
};

/// All methods: planner thread only. Allocates at construction only. Same calls with the same values: same
/// bits.
class Planner {
  public:
    Planner(PathStore &store, const PlannerSettings &settings) noexcept;

    /// Holds for moves added from now on; jerk limits from the next `begin` on.
    void set_limits(const Limits &limits) noexcept;
    /// The path that begins now with `tolerance` would be made as the present one.
    bool isFilterCurrent(double tolerance) const noexcept {
        return filter_length(wanted_, settings_.period_s, tolerance) == filter_;
    }
    /// The tolerance that a path of such moves is made for; 0: any suits.
    double path_tolerance(const MoveRequest &request) const noexcept;
    /// With jerk limits a path is made for the tolerance that it began with; a much smaller one asks for
    /// another path, from a stop. 0: none is kept.
    bool suits(double tolerance) const noexcept;

    /// For machines whose joints are not axes; `map` stays valid. Null: the axes' limits are all there are.
    void set_joints(const JointMap *map, const JointLimits &limits) noexcept;

    /// Soft limits of the axes: the path is not moved beyond them, wherever the program leads. None to begin
    /// with; +-infinity where none holds.
    void set_room(const Pose &low, const Pose &high) noexcept;

    /// A new path begins at `start`, where the executor rests with nothing left of another. `tolerance`: of
    /// its first move, 0 when that keeps none.
    void begin(const Pose &start, const Snapshot &now, double tolerance = 0) noexcept;

    /// There is room for one more move.
    bool hasRoom(const Snapshot &now) const noexcept;
    /// Appends a move that starts at `end()`; its length must be greater than 0. Returns its number.
    Sequence add(const Primitive &primitive, const MoveRequest &request) noexcept;
    /// Where the next move starts.
    const Pose &end() const noexcept { return end_; }
    Sequence last_move() const noexcept { return last_move_; }
    /// An output change when what has been added so far is complete; false when there is no room.
    bool add_event(PathEvent event) noexcept;
    /// Nothing follows for now: the last move is planned to its very end.
    void release_end() noexcept;

    void set_scales(const Scales &scales) noexcept;
    /// The gate before gated moves; open it once the executor waits there.
    /// Motion begins `delay_s` after the earliest moment.
    void open_gate(Sequence move, double delay_s) noexcept;
    bool isPhased(Sequence move) const noexcept { return move_plan(move).request.isPhased; }
    int spindle_of(Sequence move) const noexcept { return move_plan(move).request.spindle; }
    /// The move is driven by the executor, locked to the spindle's angle, with what follows up to a stop.
    bool isLocked(Sequence move) const noexcept {
        return joint_map_ == nullptr && move_plan(move).request.isLocked;
    }
    /// All of the pass that the executor would begin with is known.
    bool isPassKnown(const Snapshot &now) const noexcept;
    /// Speed that the pass from this move on needs at the present speed of its spindle, over what the machine
    /// and the operator allow.
    double pass_load(Sequence move) const noexcept;
    /// Seconds from a snapshot to the earliest start of a plan made with it.
    double latency_s() const noexcept { return static_cast<double>(settings_.latency) * settings_.period_s; }
    /// Move whose gate the executor waits at, 0: none.
    Sequence waiting_gate(const Snapshot &now) const noexcept;
    /// Single blocks: stops where the source block is another than `block`.
    void set_step(bool isStepping, std::uint32_t block) noexcept;
    /// The executor stands, and only the wish for single blocks keeps it from going on.
    bool isAtStepStop(const Snapshot &now) const noexcept;
    /// There is something that `next_block` can tell of.
    bool hasNext(const Snapshot &now) const noexcept;
    /// The block that comes next for an executor in state `now`.
    std::uint32_t next_block(const Snapshot &now) const noexcept;

    /// Commits what the executor needs next. Call once a planner period.
    void update(const Snapshot &now) noexcept;

    /// The committed plan runs to the end of the known path and there is an open end that could be released.
    bool isStarving() const noexcept {
        return (open_move_ != 0 || raw_move_ != 0) && (isAtEndOfPath_ || last_piece_ < oldest_piece_);
    }
    /// True once when it has stood for a second without finding a plan that passes the trial.
    bool take_stuck() noexcept;
    std::uint32_t moves_left(const Snapshot &now) const noexcept;

  private:
    struct MovePlan {
        double feed = 0;            ///< requested speed in s [1/s]; 0: none
        double start_s = 0;         ///< where the move begins on the programmed path
        double free_tolerance = 0;  ///< with jerk limits, where the program gives none
        double deviation = 0;       ///< of the primitive from the lines that were joined to it
        Pose shift_in, shift_out;   ///< of its start and its end from where they were programmed
        MoveRequest request;
    };
    struct PiecePlan {
        double v_limit = 0;  ///< highest speed the limits allow
        double v2_in = 0;    ///< highest speed at its start from which all that follows can be kept, squared
        bool isStopBefore = false;
        double dwell_s = 0;          ///< with jerk limits: how long it stands there at least
        std::uint64_t eased_in = 0;  ///< the replanning that made the piece slower by these factors
        double eased_speed = 1, eased_acceleration = 1;
        /// What easing along the path has left of the acceleration, refused attempts counted as well.
        double gentle = 1;
    };
    struct State {
        Sequence piece = 0;
        double x = 0, v = 0;
        Coasting coasting;
    };
    struct Joint {
        double d = 0;
        bool isStop = false;
        double dwell_s = 0;
        double v = UNLIMITED;  ///< highest speed on the blend
        double turning = 0;    ///< share of the acceleration that it takes at that speed
        double gentle = 1;     ///< part of the acceleration next to a stop that the mean can bring together
    };

    MovePlan &move_plan(Sequence n) noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    const MovePlan &move_plan(Sequence n) const noexcept { return moves_[n % PRIMITIVE_CAPACITY]; }
    PiecePlan &piece_plan(Sequence n) noexcept { return pieces_[n % PIECE_CAPACITY]; }
    const PiecePlan &piece_plan(Sequence n) const noexcept { return pieces_[n % PIECE_CAPACITY]; }

    double wish_of(const MovePlan &m) const noexcept;
    Joint joint_between(Sequence a, Sequence b) const noexcept;
    void add_piece(const Piece &piece, const SpeedLimit &limit) noexcept;
    void add_blend(const Primitive &a, const Primitive &b, const Joint &joint, double wish) noexcept;
    Joint corner(Sequence na, Sequence nb, double tolerance, bool mustStop) const noexcept;
    Joint filtered_corner(Sequence na, Sequence nb, double tolerance, bool mustStop) const noexcept;
    double filtered_arc_speed(const Primitive &p, const MovePlan &m) const noexcept;
    double tolerance_of(const MovePlan &m) const noexcept;
    void add_part(Piece piece, double to, bool isToEnd, double v) noexcept;
    double zone_length(const Primitive &p, const Joint &joint, double wish) const noexcept;
    void make_gentle(Sequence from, double part) noexcept;
    bool isAlongOnly(const Primitive &p, const MoveRequest &request) const noexcept;
    SpeedLimit along_limit(const Primitive &p, double wish) const noexcept;
    SpeedLimit shared_limit(const Primitive &a, const Primitive &b, const Joint &joint,
                            double wish) const noexcept;
    static double speed_through(double share, double need, double most_d, double tau) noexcept;
    Joint filtered_stop(const Primitive &a, const Primitive &b, double share) const noexcept;
    bool canJoin(const Primitive &line, const MoveRequest &request) const noexcept;
    void join_raw() noexcept;
    bool join_line(const Primitive &line, const MoveRequest &request) noexcept;
    void fill_move(Sequence n, const Primitive &primitive, const MoveRequest &request) noexcept;
    bool isFiltered() const noexcept { return filter_ > 1; }
    double filter_s() const noexcept {
        return isFiltered() ? static_cast<double>(filter_) * settings_.period_s : 0.0;
    }
    void close_move(double to, bool isToEnd, const Joint &after) noexcept;

    double move_cap(const MovePlan &m, double v_limit) const noexcept;
    double cap_of(Sequence piece) const noexcept;
    bool isBarrier(Sequence piece) const noexcept;
    Sequence move_of(Sequence piece) const noexcept;
    void pass_backward(Sequence from, bool isWhole) noexcept;

    bool start_state(const Snapshot &now, State &state) const noexcept;
    bool predict(const Snapshot &now, State &state) const noexcept;
    void replan(const Snapshot &now, const State &from) noexcept;
    void emit(double until_s) noexcept;
    bool emit_piece() noexcept;
    void emit_hill(double left, double cap, double out2) noexcept;
    void emit_phase(double length, double v1) noexcept;
    void emit_wait(double duration) noexcept;
    bool hasPhaseRoom() const noexcept;

    // --- planner_filtered.cc: with jerk limits
    void update_filtered(const Snapshot &now) noexcept;
    bool replan_filtered(const Snapshot &now, State from, bool isStop) noexcept;
    bool emit_filtered() noexcept;
    bool emit_rise(double cap) noexcept;
    void emit_coast(double cap, double out2) noexcept;
    bool emit_tail() noexcept;
    bool canCoast(Sequence piece, double x, double v) noexcept;

    // --- planner_locked.cc: passes that are locked to a spindle
    bool isLockedPiece(Sequence piece) const noexcept { return isLocked(move_of(piece)); }
    /// Where plans end: at a barrier, or where a pass begins, which the executor drives by itself.
    bool isPlanEnd(Sequence piece) const noexcept { return isBarrier(piece) || isLockedPiece(piece); }
    bool isPassStart(const State &from) const noexcept { return from.x <= 0 && isLockedPiece(from.piece); }
    bool isBeforeBarrier(const State &from) const noexcept;
    Sequence pass_end(Sequence first) const noexcept;
    bool start_pass(const Snapshot &now, const State &from) noexcept;
    void fill_pass(const Pass &pass) noexcept;
    double turn_way(Sequence piece) const noexcept;
    Joint locked_corner(Sequence a, Sequence b) const noexcept;
    double turning_speed(const MoveRequest &request) const noexcept;
    void move_corner_on(Sequence a, Sequence b, const Joint &joint) noexcept;

    // --- planner_shape.cc: with jerk limits, the corners of dense curves
    /// Way in the time of the mean, and how far a corner may be moved.
    struct ShiftRoom {
        double reach = 0, most = 0;
    };
    bool wanted_shift(Sequence nb, Sequence nc, Pose &shift, ShiftRoom &room) const noexcept;
    void shape_corner(Sequence nb, Sequence nc) noexcept;
    Pose within_room(const Pose &corner, const Pose &shift) const noexcept;
    void reshape(Sequence n, const Pose &in, const Pose &out) noexcept;
    Pose programmed_at(Sequence n, double s) const noexcept;

    // --- planner_check.cc: what is commanded is tried out before it is committed
    bool isPlanSound(const Snapshot &now, const State &from, Sequence begin) noexcept;
    bool isStopPassed(Sequence begin) const noexcept;
    void start_trial(const Snapshot &now, const State &from) noexcept;
    void try_sample(const Phase &phase, double t) noexcept;
    void push_sample(const LeaderSample &sample, Sequence piece) noexcept;
    bool isTrialSound() noexcept;
    Pose along_bend(std::uint64_t tick) const noexcept;
    bool isLeaderSound() const noexcept;
    double trial_deviation(std::uint64_t tick) noexcept;
    double trial_tolerance() const noexcept;
    bool ease(const State &from) noexcept;
    void ease_piece(Sequence piece, double speed, double acceleration) noexcept;
    void take_back_easing() noexcept;
    void take_back_gentleness() noexcept;
    bool canBeGentler(Sequence low, Sequence high, double factor) const noexcept;
    void scale_piece(Sequence piece, double speed, double acceleration) noexcept;
    bool isCurved(Sequence piece) const noexcept;
    SpeedLimit limit_with_joints(const Piece &piece, const SpeedLimit &limit) const noexcept;
    bool areJointsSound() noexcept;
    /// Plans are tried out before they are committed.
    bool isTried() const noexcept { return isFiltered() || joint_map_ != nullptr; }
    bool isKept(const State &from) const noexcept;

    void append(const Snapshot &now) noexcept;

    PathStore &store_;
    PlannerSettings settings_;
    Limits wanted_;             ///< as set
    Limits highest_;            ///< of all that were set since the path began
    Limits limits_;             ///< the same with accelerations that fit the filter
    std::uint64_t filter_ = 1;  ///< samples of the mean that is commanded; 1: no jerk limits
    Scales scales_;
    std::array<MovePlan, PRIMITIVE_CAPACITY> moves_{};
    std::array<PiecePlan, PIECE_CAPACITY> pieces_{};

    Pose end_;
    Sequence first_move_ = 1;  ///< of this path
    Sequence last_move_ = 0;
    Sequence last_synched_ = 0;  ///< the last move that follows a spindle
    Sequence open_move_ = 0;     ///< whose end is not yet joined or released, 0: none
    Sequence raw_move_ = 0;      ///< the newest move, which may still grow, 0: none
    double open_offset_ = 0;     ///< where its own part begins
    bool isOpenStop_ = false;    ///< stop before its part
    Joint open_joint_;           ///< before it
    std::array<Pose, PathTuning::MOST_JOINED>
        joined_{};  ///< ends within the open move of the lines that it stands for
    std::size_t joined_count_ = 0;
    Pose shift_, shift_drive_;  ///< of the last corner, and what it follows
    bool isJoinable_ = false;   ///< nothing else hangs on the end of the open move
    double programmed_s_ = 0;   ///< length of what has been added
    Sequence first_piece_ = 1;  ///< of this path
    Sequence last_piece_ = 0;
    std::uint64_t drops_ = 0;

    Sequence changed_from_ = 0;  ///< lowest piece whose v2_in rose or fell since the last plan, 0: none
    Sequence oldest_piece_ = 1;  ///< the executor's place; earlier ones are free
    Sequence oldest_phase_ = 1;

    std::uint64_t plan_ = 0;
    std::uint64_t plan_brakes_ = 0;
    std::uint64_t switch_cycle_ = 0;
    Sequence plan_begin_ = 1, plan_end_ = 1;
    std::array<Sequence, 16> plan_ends_{};  ///< of the last plans, by number: one may turn out to be refused
    State planned_;                         ///< where the committed plan ends
    double planned_s_ = 0;                  ///< when, from switch_cycle_ on
    bool isAtEndOfPath_ = false;
    bool isStopPlan_ = false;
    Sequence looked_at_ = 0;  ///< the farthest piece that the present plan depends on

    struct TrialSample {
        LeaderSample leader;
        Pose bend;  ///< second difference of the leader's positions
        Sequence piece = 0;
    };
    std::array<TrialSample, HISTORY_CAPACITY> trial_{};
    std::uint64_t trial_tick_ = 0;
    Pose trial_sum_;
    double trial_s_sum_ = 0;
    Pose trial_origin_;
    double trial_s_origin_ = 0;
    std::uint64_t tolerance_tick_ = 0;  ///< the newest sample whose tolerance differs from the one before
    std::uint64_t failed_tick_ = 0;
    int refusals_ = 0;                 ///< replanning at rest, one after the other, for which no plan passed
    bool isRefused_ = false;           ///< no attempt of the last replanning passed
    std::uint64_t replan_ = 0;         ///< counts replanning
    bool isAfterDriven_ = false;       ///< the failed sample depends on what has been driven already
    double eased_excess_ = UNLIMITED;  ///< of the attempt before
    struct Gentleness {
        Sequence low = 0, high = 0;  ///< pieces; 0: none
        double factor = 1;
    };
    Gentleness gentle_;             ///< of the attempt before, along the path alone
    std::uint64_t eased_tick_ = 0;  ///< where it failed
    double along_share_ = 0;        ///< part of the failed swing that is acceleration along the path
    double excess_ = 1;             ///< what the failed sample has over what is allowed
    const JointMap *joint_map_ = nullptr;
    JointLimits joint_limits_;
    Pose room_low_, room_high_;
    double nominal_tolerance_ = 0;  ///< of moves without one on a path with jerk limits, at least
    std::array<std::array<double, MAX_JOINTS>, 4> trial_joints_{};
    std::uint64_t joint_tick_ = 0, joint_samples_ = 0;
    std::uint64_t along_tick_ = 0;  ///< the last on an arc that is followed exactly

    double start_delay_s_ = 0;  ///< of the next plan from rest
    int steady_updates_ = 0;    ///< since spindles have changed their speeds by more than a little
    bool isStepping_ = false;
    std::uint32_t step_block_ = 0;
};

}  // namespace mw::traj
