// SPDX-License-Identifier: GPL-2.0-or-later
// The motion controller: takes commands and calculates the position of each joint every servo cycle. Pure: no
// HAL, no clock, no allocation. All of it runs in the servo thread.
#pragma once

#include <cstdint>

#include "kinematics/kinematics.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/settings.hh"
#include "motion/planner/path_link.hh"
#include "motion/servo/command_result.hh"
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
#include "motion/servo/offsets/external_offsets.hh"
#include "motion/servo/outputs/machine_outputs.hh"
#include "motion/servo/power/power.hh"
#include "motion/servo/probe/probe.hh"
#include "motion/servo/spindles/spindles.hh"
#include "motion/servo/watchdog/watchdog.hh"
#include "trajectory/follow/executor.hh"

namespace mw::motion {

struct ControllerConfig {
    int num_joints = 3;
    int num_spindles = 1;
    int num_dio = 4;
    int num_aio = 4;
    double period_s = 1e-3;
    int num_extra_joints = 0;          ///< the last joints, which no pose moves
    homing::Module *homing = nullptr;  ///< replaces Millwright's homing; outlives the controller

    int num_led_joints() const noexcept { return num_joints - num_extra_joints; }
};

/// State of the command channels.
struct Received {
    Epoch epoch = 0;        ///< older commands are stale
    CommandId last_id = 0;  ///< of the immediate commands
};

/// Owns the parts of the machine and passes to each, every cycle, what it needs of the others. Some
/// megabytes, so never on a stack.
class Controller {
  public:
    Controller(const ControllerConfig &config, const kinematics::Kinematics &kinematics, Channels &channels,
               PathLink &link) noexcept;
    /// Continues the state of `other` on separate channels; `link` is a copy of the other's.
    Controller(const Controller &other, Channels &channels, PathLink &link) noexcept;
    Controller &operator=(const Controller &) = delete;

    /// Takes up to MAX_COMMANDS_PER_CYCLE immediate commands and answers each (function
    /// motion-command-handler).
    [[gnu::hot]] void handle_commands(const Inputs &in) noexcept;
    /// One servo cycle (function motion-controller).
    [[gnu::hot]] void step(const Inputs &in, Outputs &out) noexcept;

    static constexpr int MAX_COMMANDS_PER_CYCLE = 64;

  private:
    /// Copies channels and link as well, so only for making a clone.
    Controller(const Controller &other) noexcept = default;

    // --- controller_commands.cc
    [[gnu::cold]] CommandResult take(const Inputs &in, const CommandBody &body) noexcept;
    [[gnu::cold]] CommandResult abort_all(const Abort &command) noexcept;
    [[gnu::cold]] CommandResult enable(const Inputs &in) noexcept;
    [[gnu::cold]] CommandResult set_mode(Mode mode) noexcept;
    [[gnu::cold]] void leave_lost_mode() noexcept;
    [[gnu::cold]] CommandResult lead_joints() noexcept;
    [[gnu::cold]] CommandResult set_num_joints(const Inputs &in, int count) noexcept;
    [[gnu::cold]] CommandResult set_parameter(const SetParameter &command) noexcept;
    JogSituation situation_of(const Inputs &in, const JogTarget &target) const noexcept;
    [[gnu::cold]] void disable() noexcept;
    [[gnu::cold]] void publish_limits() noexcept;
    [[gnu::cold]] void publish_joint_start() noexcept;

    // --- controller.cc
    [[gnu::cold]] void use_joints(int count) noexcept;
    /// `spindles_lost`: bit per spindle whose feedback is not a number.
    [[gnu::hot]] void check_faults(const Inputs &in, std::uint32_t spindles_lost) noexcept;
    [[gnu::hot]] void check_joints(const Inputs &in) noexcept;
    [[gnu::hot]] void step_kinematics(const Inputs &in) noexcept;
    [[gnu::cold]] void switch_kinematics(kinematics::TypeSwitch &types) noexcept;
    [[gnu::hot]] void step_homing(const Inputs &in) noexcept;
    [[gnu::cold]] void drive_homing(const Inputs &in) noexcept;
    [[gnu::hot]] void step_jogs(const Inputs &in) noexcept;
    void step_indexers(const Inputs &in) noexcept;
    [[gnu::hot]] void output_joints() noexcept;
    [[gnu::cold]] void stop_category_1(FaultKind kind, int index, double value = 0) noexcept;
    [[gnu::cold]] void stop_category_0(FaultKind kind, int index, double value = 0) noexcept;
    [[gnu::cold]] void raise(FaultKind kind, int index, double value = 0, std::uint16_t detail = 0) noexcept;
    [[gnu::hot]] bool isAnythingMoving() const noexcept;

    // --- controller_motion.cc
    void move_joints(const Inputs &in) noexcept;
    [[gnu::hot]] void move_axes(const Inputs &in) noexcept;
    geometry::Pose teleop_pose() noexcept;
    [[gnu::hot]] geometry::Pose path_pose() noexcept;
    void move_extra_joints(const Inputs &in) noexcept;
    [[gnu::hot]] void move_to(const geometry::Pose &pose) noexcept;
    [[gnu::hot]] void check_probe(const Inputs &in) noexcept;

    // --- controller_status.cc
    [[gnu::hot]] void publish(const Inputs &in, Outputs &out) noexcept;
    [[gnu::hot]] void fill_path(Status &status, const geometry::Pose &programmed) const noexcept;
    [[gnu::hot]] void publish_view(const Inputs &in, const geometry::Pose &programmed) noexcept;

    ControllerConfig config_;  ///< with the joints that are in use
    const kinematics::Kinematics &kinematics_;
    Channels *channels_;
    PathLink *link_;
    Settings settings_;
    AxisMap map_;
    FoldedLimits limits_;
    std::uint32_t limits_version_ = 0;
    JointStart standing_;

    std::uint64_t cycle_ = 0;
    Received received_;

    Power power_;
    Watchdog watchdog_;
    Joints joints_;
    GantryAlignment alignment_;
    Jogs jogs_;
    HomingDrive homing_;
    Spindles spindles_;
    MachineOutputs outputs_;
    Holds holds_;
    TouchProbe probe_;
    CartesianPosition place_;
    KinematicsTypes types_;
    ExternalOffsets offsets_;
    ExtraJoints extra_;
    Indexers indexers_;
    trajectory::Executor executor_;
    Retracing retracing_;

    bool isCoordError_ = false;
};

inline JointStepLimit stride_of(const FoldedLimits &limits, const ControllerConfig &config) noexcept {
    return {limits.joints.velocity.data(), config.period_s, config.num_led_joints()};
}

inline ExtraJointInputs extra_inputs(const Inputs &in, const Joints &joints, const FoldedLimits &limits,
                                     double period_s) noexcept {
    return {in.joint, commanded(joints), limits, limits.homed.joints & ~inactive_joints(joints), period_s};
}

/// Range that jogs or the path may reach without external offsets.
TravelRange programmed_range(const Jogs &jogs, const PathLink &link, Mode mode, const geometry::Pose &pose,
                             const SharedJoints &shared) noexcept;

/// The move that the path is executing; nullptr for none.
inline const trajectory::MoveTag *active_move(const trajectory::Executor &executor,
                                              const trajectory::PathStore &store, Mode mode) noexcept {
    const trajectory::Sequence move = executor.output().move;
    return mode == Mode::COORD && move != 0 ? &store.move(move) : nullptr;
}

}  // namespace mw::motion
