// SPDX-License-Identifier: GPL-2.0-or-later
// Takes path commands, checks them, plans them, and answers each. Runs in the planner thread once per period;
// allocates only at construction.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "kinematics/kinematics.hh"
#include "motion/interface/channels.hh"
#include "motion/planner/path_link.hh"
#include "motion/planner/path_window.hh"
#include "motion/planner/pending_commands.hh"
#include "motion/planner/reach_check.hh"
#include "trajectory/planner.hh"

namespace mw::motion {

struct PathPlannerConfig {
    double servo_period_s = 1e-3;
    int num_joints = 3;
    int num_spindles = 1;
    int num_dio = 4, num_aio = 4;
    trajectory::SpeedChooser *chooser = nullptr;  ///< a planner module of a user
};

/// After a rejection or a stop, the remaining path commands of the epoch are answered STALE until a new epoch
/// or Enable. So the machine never follows a path with a gap.
class PathPlanner {
  public:
    PathPlanner(const PathPlannerConfig &config, const kinematics::Kinematics &kinematics, Channels &channels,
                PathLink &link) noexcept;

    /// One planner period. [planner thread]
    void update() noexcept;

    static constexpr int MAX_COMMANDS_PER_UPDATE = 1024;

  private:
    void follow_controller() noexcept;
    void follow_drops() noexcept;
    void follow_steps() noexcept;
    void complete_moves() noexcept;
    bool take_commands() noexcept;
    bool isWaiting(const PathCommand &c) noexcept;
    bool isIdle() const noexcept;
    void begin_path(const PathCommand &c) noexcept;
    Reason accept(const PathCommand &c) noexcept;
    Reason accept_flush(const PathCommand &c) noexcept;
    Reason accept_line(const PathCommand &c, const geometry::Pose &end, const MoveTerms &terms) noexcept;
    Reason accept_arc(const PathCommand &c, const Arc &arc) noexcept;
    Reason accept_tap(const PathCommand &c, const RigidTap &tap) noexcept;
    Reason accept_probe(const PathCommand &c, const Probe &probe) noexcept;
    Reason accept_digital(const PathCommand &c, const SynchedDigitalOutput &output) noexcept;
    Reason accept_analog(const PathCommand &c, const SynchedAnalogOutput &output) noexcept;
    Reason accept_event(const PathCommand &c, const trajectory::PathEvent &event) noexcept;
    int indexer_of(const PathBody &body) const noexcept;
    Reason check_reach(const trajectory::Primitive &p, int indexer = -1) noexcept;
    TravelRange available_travel(const TravelRange &move) noexcept;
    void publish_extent() noexcept;
    void tell_overreach(const trajectory::Overreach &overreach) noexcept;
    trajectory::MoveRequest request_for(const PathCommand &c, const MoveTerms &terms) const noexcept;
    void add_pending(const PathCommand &c, const SourceTag &source) noexcept;
    void open_gates() noexcept;
    bool areSpindlesReady() const noexcept;
    bool isThreadPossible(trajectory::Sequence gate) noexcept;
    bool isTapPossible(trajectory::Sequence gate) noexcept;
    void tell_impossible(trajectory::Sequence gate, FaultKind kind, double value) noexcept;
    void publish() noexcept;
    void answer(CommandId id, AnswerKind kind, Reason reason) noexcept;

    PathPlannerConfig config_;
    const kinematics::Kinematics &kinematics_;
    ReachCheck reach_;
    Channels &channels_;
    PathLink &link_;
    trajectory::Planner planner_;
    PendingCommands pending_;

    PathView view_;
    PathWindow window_;  ///< used while there are external offsets
    std::uint32_t limits_version_ = 0;
    Epoch epoch_ = 0;
    bool isBroken_ = false;  ///< the path has a gap: further commands of this epoch are rejected
    bool isPathBegun_ = false;
    bool isQueueFull_ = false;
    bool wasLocked_ = false;  ///< the last move follows the angle of a spindle
    trajectory::Sequence refused_gate_ = 0;
    std::uint64_t drops_ = 0;
    std::uint32_t enables_ = 0;
    std::uint32_t probe_trips_ = 0;
    std::uint32_t steps_ = 0;
    bool isStepPending_ = false;
    trajectory::Sequence step_from_ = 0;
    std::int16_t refused_index_ = -1;
    int idle_updates_ = 0;
    CommandId last_done_ = 0;
};

}  // namespace mw::motion
