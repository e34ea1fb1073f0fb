// SPDX-License-Identifier: GPL-2.0-or-later
// The status of a machine. Each part is written by its owner; the whole status is published once in each task
// cycle.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/device_status.hh"
#include "messages/declarations/settings_status.hh"
#include "messages/declarations/task_status.hh"

namespace mw::messages {

struct TrajectoryStatus {
    std::uint32_t axis_mask = 0;
    int num_joints = 0;
    int num_extra_joints = 0;
    int num_spindles = 0;
    MotionMode mode = MotionMode::FREE;
    bool isEnabled = false;
    bool isInPosition = true;
    bool isPaused = false;
    bool isStepping = false;
    bool isReverse = false;
    bool isAllHomed = false;
    bool isHoming = false;
    std::uint32_t queue_depth = 0;
    bool isQueueFull = false;
    std::uint64_t active_move = 0;
    MoveKind move_kind = MoveKind::NONE;
    double current_velocity = 0;
    double requested_velocity = 0;
    double distance_to_go = 0;
    geometry::Pose position_cmd;
    geometry::Pose position_fb;
    bool isPositionValid = false;
    geometry::Pose dtg;
};
template <>
inline constexpr auto DECLARED<TrajectoryStatus> = declare(
    "TrajectoryStatus", 299, "motion as a whole and the move that is executed",
    field<&TrajectoryStatus::axis_mask>("axis_mask", "bit 0 X ... bit 8 W"),
    field<&TrajectoryStatus::num_joints>("num_joints", "joints that the machine has"),
    field<&TrajectoryStatus::num_extra_joints>("num_extra_joints",
                                               "the last of them, which pins move once they are homed"),
    field<&TrajectoryStatus::num_spindles>("num_spindles", "spindles that the machine has"),
    field<&TrajectoryStatus::mode>("mode", "of motion"),
    field<&TrajectoryStatus::isEnabled>("is_enabled", "motion is enabled"),
    field<&TrajectoryStatus::isInPosition>("in_position", "nothing moves and no move waits"),
    field<&TrajectoryStatus::isPaused>("is_paused", "motion is paused"),
    field<&TrajectoryStatus::isStepping>("is_stepping", "one block at a time"),
    field<&TrajectoryStatus::isReverse>("is_reverse", "goes back along the path"),
    field<&TrajectoryStatus::isAllHomed>("all_homed", "all joints are homed"),
    field<&TrajectoryStatus::isHoming>("is_homing", "a joint is being homed"),
    field<&TrajectoryStatus::queue_depth>("queue_depth", "moves in the planner"),
    field<&TrajectoryStatus::isQueueFull>("queue_full", "no further move is taken now"),
    field<&TrajectoryStatus::active_move>("active_move", "number of the move that is executed, 0 none"),
    field<&TrajectoryStatus::move_kind>("move_kind", "of that move"),
    field<&TrajectoryStatus::current_velocity>("current_velocity", "along the path", unit::SPEED),
    field<&TrajectoryStatus::requested_velocity>("requested_velocity", "along the path", unit::SPEED),
    field<&TrajectoryStatus::distance_to_go>("distance_to_go", "along the path of the move", unit::LENGTH),
    field<&TrajectoryStatus::position_cmd>("position_cmd", "commanded, machine coordinates", unit::POSE),
    field<&TrajectoryStatus::position_fb>("position_fb", "by feedback, machine coordinates", unit::POSE),
    field<&TrajectoryStatus::isPositionValid>("position_valid", "position_fb is known"),
    field<&TrajectoryStatus::dtg>("dtg", "distance to go of each axis", unit::POSE));

struct ProbeStatus {
    geometry::Pose position;
    bool isProbing = false;
    bool isTripped = false;
    bool isOn = false;
};
template <>
inline constexpr auto DECLARED<ProbeStatus> =
    declare("ProbeStatus", 0, "the probe",
            field<&ProbeStatus::position>("position", "where it tripped last", unit::POSE),
            field<&ProbeStatus::isProbing>("is_probing", "a probe move is executed"),
            field<&ProbeStatus::isTripped>("tripped", "the last probe move has met something"),
            field<&ProbeStatus::isOn>("on", "the probe input"));

struct OverridesStatus {
    double feed = 1.0;
    double rapid = 1.0;
    double net = 1.0;
    bool isFeedEnabled = true;
    bool isAdaptiveFeedEnabled = false;
    bool isFeedHoldEnabled = true;
};
template <>
inline constexpr auto DECLARED<OverridesStatus> = declare(
    "OverridesStatus", 0, "overrides of feed and rapids",
    field<&OverridesStatus::feed>("feed", "of feeds and jogs", unit::FACTOR),
    field<&OverridesStatus::rapid>("rapid", "of rapids", unit::FACTOR),
    field<&OverridesStatus::net>("net", "all together", unit::FACTOR),
    field<&OverridesStatus::isFeedEnabled>("feed_enabled", "feed overrides work (M50)"),
    field<&OverridesStatus::isAdaptiveFeedEnabled>("adaptive_feed_enabled", "adaptive feed works (M52)"),
    field<&OverridesStatus::isFeedHoldEnabled>("feed_hold_enabled", "the feed hold pin works (M53)"));

struct MotionStatus {
    std::uint64_t cycle = 0;
    bool isTaskLost = false;
    std::uint64_t digital_in = 0;
    std::uint64_t digital_out = 0;
    std::array<double, MAX_ANALOG_IO> analog_in{};
    std::array<double, MAX_ANALOG_IO> analog_out{};
};
template <>
inline constexpr auto DECLARED<MotionStatus> =
    declare("MotionStatus", 399, "the motion controller and its inputs and outputs",
            field<&MotionStatus::cycle>("cycle", "servo cycles since it was loaded"),
            field<&MotionStatus::isTaskLost>("task_lost", "motion has seen task dead or hanging"),
            field<&MotionStatus::digital_in>("digital_in", "bit per pin"),
            field<&MotionStatus::digital_out>("digital_out", "bit per pin"),
            field<&MotionStatus::analog_in>("analog_in", "value of each pin"),
            field<&MotionStatus::analog_out>("analog_out", "value of each pin"));

struct OperationStatus {
    std::uint32_t holder = 0;
    double lease_left_s = 0;
    std::uint64_t handovers = 0;
};
template <>
inline constexpr auto DECLARED<OperationStatus> =
    declare("OperationStatus", 3010, "who may operate the machine",
            field<&OperationStatus::holder>("holder", "client that operates alone, 0: open to all"),
            field<&OperationStatus::lease_left_s>("lease_left_s", "until its right runs out", unit::SECOND),
            field<&OperationStatus::handovers>("handovers", "changes of the holder"));

/// Trivially copyable. The tool table is large and changes seldom, so the status has only its version (see
/// ToolTable).
struct MachineStatus {
    std::uint64_t cycle = 0;
    std::int64_t time_ns = 0;
    std::uint64_t last_command = 0;
    Progress last_progress = Progress::DONE;
    std::uint64_t last_message = 0;
    TaskStatus task;
    CodesStatus codes;
    OffsetsStatus offsets;
    TrajectoryStatus trajectory;
    ProbeStatus probe;
    OverridesStatus overrides;
    MotionStatus motion;
    std::array<JointStatus, MAX_JOINTS> joints{};
    std::array<AxisStatus, MAX_AXES> axes{};
    std::array<SpindleStatus, MAX_SPINDLES> spindles{};
    ToolStatus tool;
    IoStatus io;
    OperationStatus operation;
    ApproachStatus approach;
    RecoveryStatus recovery;
    SettingsStatus settings;
};
template <>
inline constexpr auto DECLARED<MachineStatus> = declare(
    "MachineStatus", 1999, "the whole machine",
    field<&MachineStatus::cycle>("cycle", "task cycles since the start"),
    field<&MachineStatus::time_ns>("time_ns", "clock of the cycle", unit::NANOSECOND),
    field<&MachineStatus::last_command>("last_command", "serial number of the command that task took last"),
    field<&MachineStatus::last_progress>("last_progress", "of that command"),
    field<&MachineStatus::last_message>("last_message", "number of the newest message to the operator"),
    field<&MachineStatus::task>("task", "states and program"),
    field<&MachineStatus::codes>("codes", "modal codes"),
    field<&MachineStatus::offsets>("offsets", "active offsets"),
    field<&MachineStatus::trajectory>("trajectory", "motion as a whole"),
    field<&MachineStatus::probe>("probe", "probe"),
    field<&MachineStatus::overrides>("overrides", "of feed and rapids"),
    field<&MachineStatus::motion>("motion", "inputs and outputs"),
    field<&MachineStatus::joints>("joints", "by number"),
    field<&MachineStatus::axes>("axes", "X Y Z A B C U V W"),
    field<&MachineStatus::spindles>("spindles", "by number"), field<&MachineStatus::tool>("tool", "changer"),
    field<&MachineStatus::io>("io", "e-stop chain, coolant"),
    field<&MachineStatus::operation>("operation", "who may operate"),
    field<&MachineStatus::approach>("approach", "what a person is to confirm"),
    field<&MachineStatus::recovery>("recovery", "the program that can be resumed after a crash"),
    field<&MachineStatus::settings>("settings", "what is set for the machine"));

struct ToolRecord {
    int toolno = -1;
    int pocketno = 0;
    geometry::Pose offset;
    double diameter = 0;
    double frontangle_deg = 0;
    double backangle_deg = 0;
    int orientation = 0;
    std::string comment;
};
template <>
inline constexpr auto DECLARED<ToolRecord> =
    declare("ToolRecord", 0, "an entry of the tool table",
            field<&ToolRecord::toolno>("toolno", "number of the tool, -1: an empty entry"),
            field<&ToolRecord::pocketno>("pocketno", "where it is kept"),
            field<&ToolRecord::offset>("offset", "of the tool", unit::POSE),
            field<&ToolRecord::diameter>("diameter", "of the tool", unit::LENGTH),
            field<&ToolRecord::frontangle_deg>("frontangle_deg", "lathe tools", unit::DEGREE),
            field<&ToolRecord::backangle_deg>("backangle_deg", "lathe tools", unit::DEGREE),
            field<&ToolRecord::orientation>("orientation", "lathe tools, 0 to 9"),
            field<&ToolRecord::comment>("comment", "as in the file"));

/// Maximum number of entries of a tool table.
inline constexpr double MAX_TOOLS = 2000;

struct ToolTable {
    std::uint64_t version = 0;
    std::vector<ToolRecord> tools;
};
template <>
inline constexpr auto DECLARED<ToolTable> =
    declare("ToolTable", 3011, "the tool table, with the version that ToolStatus names",
            field<&ToolTable::version>("version", "counts changes"),
            field<&ToolTable::tools>("tools", "[0] is the spindle", unit::NONE, range(0, MAX_TOOLS)));

}  // namespace mw::messages
