// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of the controller, and functions that concern several of them: faults, stops, and data for the
// path planner. The stages of a servo cycle pass data between the parts.
#pragma once

#include <cstdint>

#include "motion/interface/channels.hh"
#include "motion/planner/path_link.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/controller_config.hh"
#include "motion/servo/coord/cartesian_position.hh"
#include "motion/servo/coord/joint_continuity.hh"
#include "motion/servo/coord/kinematics_types.hh"
#include "motion/servo/coord/retracing.hh"
#include "motion/servo/extra_joints/extra_joints.hh"
#include "motion/servo/holds/holds.hh"
#include "motion/servo/homing/homing_drive.hh"
#include "motion/servo/indexers/indexers.hh"
#include "motion/servo/io.hh"
#include "motion/servo/jogs/jogs.hh"
#include "motion/servo/joints/gantry_alignment.hh"
#include "motion/servo/joints/joints.hh"
#include "motion/servo/machine_model.hh"
#include "motion/servo/offsets/external_offsets.hh"
#include "motion/servo/outputs/machine_outputs.hh"
#include "motion/servo/power/power.hh"
#include "motion/servo/probe/probe.hh"
#include "motion/servo/spindles/spindles.hh"
#include "trajectory/follow/executor.hh"

namespace mw::motion {

/// Contains only values, so that a controller can be cloned during a move. Its size is some megabytes, so it
/// is never on a stack.
struct ControllerParts {
    ControllerParts(const ControllerConfig &config, const kinematics::Kinematics &kinematics,
                    Channels &channels, PathLink &link) noexcept;
    /// Continues the state of `other` on separate channels; `link` is a copy of the link of `other`.
    ControllerParts(const ControllerParts &other, Channels &channels, PathLink &link) noexcept;
    ControllerParts &operator=(const ControllerParts &) = delete;

    /// Passes the number of joints in use to the parts that depend on it.
    [[gnu::cold]] void use_joints(int count) noexcept;

    /// Reports a fault, with the line of the active move.
    [[gnu::cold]] void raise(FaultKind kind, int index, double value = 0, std::uint16_t detail = 0) noexcept;
    /// Stop category 0: reports the fault and switches the amplifiers off in this cycle.
    [[gnu::cold]] void stop_category_0(FaultKind kind, int index, double value = 0) noexcept;
    /// Stop category 1: everything brakes within its limits; the amplifiers go off in the cycle after
    /// standstill. Reports the fault if no stop is active.
    [[gnu::cold]] void stop_category_1(FaultKind kind, int index, double value = 0) noexcept;
    /// Brakes all motion within its limits, except external offsets.
    [[gnu::cold]] void brake() noexcept;
    [[gnu::cold]] void switch_off() noexcept;
    /// Selects free mode while off, if joints that the kinematics needs have lost their home: the joint
    /// positions of a pose are then unknown.
    [[gnu::cold]] void leave_unknown_pose() noexcept;

    /// The move that the path executes; nullptr for none.
    const trajectory::MoveTag *active_move() const noexcept;
    /// Commanded pose without external offsets.
    geometry::Pose programmed_pose() const noexcept { return offsets.remove_from(position.cmd()); }

    /// Prepares a mode in which the pose commands the joints. They must be at their positions in the pose,
    /// except for a small difference that the alignment removes.
    [[gnu::cold]] CommandResult align_joints() noexcept;
    /// Drops the path; the next one begins at `pose`.
    [[gnu::cold]] void restart_path(const geometry::Pose &pose) noexcept;
    /// Combines the limits and passes them to the path planner.
    [[gnu::cold]] void publish_limits() noexcept;
    /// Passes the joint positions to the path planner; they select the configuration of elbows and wrists.
    [[gnu::cold]] void publish_joint_start() noexcept;

    Channels *channels;
    PathLink *link;
    MachineModel model;
    JointStart joint_start;
    std::uint64_t cycle = 0;
    Power power;
    Joints joints;
    GantryAlignment alignment;
    Jogs jogs;
    HomingDrive homing;
    Spindles spindles;
    MachineOutputs outputs;
    Holds holds;
    TouchProbe probe;
    CartesianPosition position;
    KinematicsTypes types;
    ExternalOffsets offsets;
    ExtraJoints extra;
    Indexers indexers;
    trajectory::Executor executor;
    Retracing retracing;
    bool coord_error = false;  ///< an error stopped the path

  private:
    /// Also copies channels and link, so only for cloning.
    ControllerParts(const ControllerParts &other) noexcept = default;
};

}  // namespace mw::motion
