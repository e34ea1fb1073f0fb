// SPDX-License-Identifier: GPL-2.0-or-later
// The interface between the controller (servo thread) and the path planner (lower priority) in one process.
#pragma once

#include <array>
#include <cstdint>

#include "base/copyable_atomic.hh"
#include "base/limits.hh"
#include "base/seqlock.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/status.hh"
#include "trajectory/path/joint_map.hh"
#include "trajectory/path/limits.hh"
#include "trajectory/path/spindle_braking.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

/// Written by the controller when a setting changes or a joint is homed or unhomed.
struct PathLimits {
    trajectory::Limits limits;
    double corner_scale = 1;        ///< for moves without a tolerance
    geometry::Pose low, high;       ///< soft limits per axis; +-infinity without a limit
    std::uint32_t axes = 0;         ///< bit per axis that the kinematics drive
    std::uint32_t offset_axes = 0;  ///< bit per axis that may have an external offset
    std::array<std::int8_t, MAX_AXES> indexer = NO_INDEXERS;  ///< as in FoldedLimits
    trajectory::JointLimits joints;                           ///< if joints are not axes
    SharedJoints shared;                                      ///< with external offsets
    /// joint positions before the path, which select the configuration of elbows and wrists
    std::array<double, MAX_JOINTS> start_joints{};
    int side = 0;                        ///< of that configuration (kinematics::Kinematics)
    std::uint32_t position_changes = 0;  ///< count
};

/// Range of the path that is planned and not yet executed.
struct PathExtent {
    TravelRange range;
    bool isEmpty = true;
};

/// Written by the controller in every servo cycle as a consistent snapshot.
struct PathView {
    trajectory::Snapshot executor;
    Epoch epoch = 0;
    Mode mode = Mode::FREE;
    bool isEnabled = false;
    bool isStopping = false;    ///< everything brakes; the rest of the path will be dropped
    std::uint32_t enables = 0;  ///< counts Enable
    std::uint32_t limits_version = 0;
    geometry::Pose position;  ///< carte_pos_cmd
    double feed_scale = 1, rapid_scale = 1, max_velocity = 0;
    std::array<double, MAX_SPINDLES> spindle_rps{}, spindle_revs{};
    std::uint32_t spindles_ready = 0;  ///< bit per spindle that is at speed or off
    std::uint32_t spindles_reversible = 0;
    std::array<trajectory::SpindleBrakings, MAX_SPINDLES> spindle_brakings{};
    std::array<double, MAX_SPINDLES> encoder_steps{};  ///< [rev]
    bool isProbeClosed = false;
    std::uint32_t probe_trips = 0;  ///< counts probe moves that were tripped
    std::uint32_t steps = 0;        ///< counts StepOnce
    bool isStepping = false;
    /// Locking indexers, a bit per joint: may move; waiting or moving; did not lock in time.
    std::uint32_t indexers_unlocked = 0, indexers_busy = 0, indexers_stuck = 0;
    std::uint32_t type_asks = 0;  ///< counts requests for another kinematics type
    bool isTypePending = false;   ///< new paths wait until the type is active
};

/// Copied only while both sides are stopped, when a controller is saved or cloned.
struct PathLink {
    trajectory::PathStore store;
    Seqlock<PathView> view;      ///< controller -> planner
    PathView newest;             ///< source of `view`; only for the controller
    Seqlock<PathLimits> limits;  ///< controller -> planner
    /// Range of external offsets, and range of the path. Each side publishes its range before it reads the
    /// other's, so that they never use the same travel. Used only with such offsets.
    Seqlock<PoseRange> offsets;  ///< controller -> planner
    Seqlock<PathExtent> extent;  ///< planner -> controller
    /// planner -> controller: StepOnce count whose stop has been reached
    CopyableAtomic<std::uint32_t> steps_done{0};
    /// planner -> controller: value of type_asks at which all accepted commands had been executed
    CopyableAtomic<std::uint32_t> type_asks_seen{0};
    /// planner -> controller: joints that the path requires unlocked; the upper bits contain the last known
    /// drop of a path
    CopyableAtomic<std::uint64_t> indexers_wanted{0};
    CopyableAtomic<std::uint32_t> queue_depth{0};   ///< planner -> controller
    CopyableAtomic<std::uint32_t> isQueueFull{0};   ///< planner -> controller
    CopyableAtomic<std::uint64_t> last_done_id{0};  ///< planner -> controller: last path command completed
};

}  // namespace mw::motion
