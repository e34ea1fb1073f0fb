// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/message/wire_table.hh"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "messages/declarations/catalogue.hh"
#include "messages/declarations/status_list.hh"

namespace mw::nml {

/// The fields of EMC_JOINT_ABORT.
struct AbortJoint {
    int joint = 0;
};

}  // namespace mw::nml

namespace mw::messages {
template <>
inline constexpr auto DECLARED<nml::AbortJoint> =
    declare("AbortJoint", 120, "stops a joint",
            field<&nml::AbortJoint::joint>("joint", "number of the joint", unit::NONE, JOINTS));
}  // namespace mw::messages

namespace mw::nml {
namespace {

using namespace messages;  // NOLINT(google-build-using-namespace): the table lists most of its names

/// A message without fields, or whose fields are not read.
struct NoFields {};

template <class Body>
consteval MessageKind kind(int number, const char *name, Base base, const Declaration *declaration) {
    MessageKind made;
    made.number = number;
    made.wire_name = name;
    made.base = base;
    made.declaration = declaration;
    made.make = make_body<Body>;
    return made;
}

/// Commands and statuses have the same number on the wire and in the machine.
template <class Body>
consteval MessageKind same_number(int number, const char *name, Base base) {
    if (number != DECLARATION<Body>.number) {
        throw "the declaration has another number";  // does not compile
    }
    return kind<Body>(number, name, base, &DECLARATION<Body>);
}
template <class Body>
consteval MessageKind command(int number, const char *name) {
    MessageKind made = same_number<Body>(number, name, Base::COMMAND);
    made.convert = convert_body<Body>;
    return made;
}
template <class Body>
consteval MessageKind status(int number, const char *name) {
    return same_number<Body>(number, name, Base::STATUS);
}

/// Another name for a command of the machine.
using Convert = Command (*)(const void *);
consteval MessageKind same_as(int number, const char *name, Convert convert) {
    MessageKind made = kind<NoFields>(number, name, Base::COMMAND, nullptr);
    made.convert = convert;
    return made;
}
constexpr Convert ON = [](const void *) { return Command(SetState{State::ON}); };
constexpr Convert OFF = [](const void *) { return Command(SetState{State::OFF}); };
constexpr Convert ESTOP = [](const void *) { return Command(SetState{State::ESTOP}); };
constexpr Convert ESTOP_RESET = [](const void *) { return Command(SetState{State::ESTOP_RESET}); };
constexpr Convert PAUSE = [](const void *) { return Command(PauseProgram{}); };
constexpr Convert STEP = [](const void *) { return Command(StepProgram{}); };
constexpr Convert RESUME = [](const void *) { return Command(ResumeProgram{}); };
constexpr Convert ABORT = [](const void *) { return Command(AbortAll{}); };

consteval MessageKind abort_joint(int number, const char *name) {
    MessageKind made = same_number<AbortJoint>(number, name, Base::COMMAND);
    made.convert = [](const void *body) {
        return Command(JogStop{true, static_cast<const AbortJoint *>(body)->joint});
    };
    return made;
}

consteval MessageKind rejected(int number, const char *name, const char *reason) {
    MessageKind made = kind<NoFields>(number, name, Base::COMMAND, nullptr);
    made.rejection = reason;
    return made;
}
constexpr const char *PART_OF_PROGRAM = "only programs contain this: send it as G-code, by Mdi";
constexpr const char *PART_OF_CONFIGURATION =
    "this is a setting of the INI file and cannot change while the machine runs";
constexpr const char *PART_OF_START = "the machine does this itself when it starts and ends";
constexpr const char *NO_PLUGINS =
    "task has no Python functions (PYTHON_TASK); remapped codes run Python: [RS274NGC]REMAP";
constexpr const char *NO_PROGRAMS =
    "a machine runs no programs for clients that send messages: use M100 to M199";

constexpr auto ROWS = std::to_array<MessageKind>({
    command<OperatorError>(11, "EMC_OPERATOR_ERROR_TYPE"),
    command<OperatorText>(12, "EMC_OPERATOR_TEXT_TYPE"),
    command<OperatorDisplay>(13, "EMC_OPERATOR_DISPLAY_TYPE"),
    command<Null>(21, "EMC_NULL_TYPE"),
    command<SetDebug>(22, "EMC_SET_DEBUG_TYPE"),
    rejected(30, "EMC_SYSTEM_CMD_TYPE", NO_PROGRAMS),
    rejected(101, "EMC_JOINT_SET_JOINT_TYPE", PART_OF_CONFIGURATION),
    rejected(102, "EMC_JOINT_SET_UNITS_TYPE", PART_OF_CONFIGURATION),
    command<SetJointMinLimit>(107, "EMC_JOINT_SET_MIN_POSITION_LIMIT_TYPE"),
    command<SetJointMaxLimit>(108, "EMC_JOINT_SET_MAX_POSITION_LIMIT_TYPE"),
    command<SetJointFerror>(111, "EMC_JOINT_SET_FERROR_TYPE"),
    command<SetJointHoming>(112, "EMC_JOINT_SET_HOMING_PARAMS_TYPE"),
    command<SetJointMinFerror>(115, "EMC_JOINT_SET_MIN_FERROR_TYPE"),
    rejected(116, "EMC_JOINT_SET_MAX_VELOCITY_TYPE", PART_OF_CONFIGURATION),
    rejected(118, "EMC_JOINT_INIT_TYPE", PART_OF_START),
    rejected(119, "EMC_JOINT_HALT_TYPE", PART_OF_START),
    abort_joint(120, "EMC_JOINT_ABORT_TYPE"),
    command<EnableJoint>(121, "EMC_JOINT_ENABLE_TYPE"),
    command<DisableJoint>(122, "EMC_JOINT_DISABLE_TYPE"),
    command<HomeJoint>(123, "EMC_JOINT_HOME_TYPE"),
    command<JogContinuous>(124, "EMC_JOG_CONT_TYPE"),
    command<JogIncrement>(125, "EMC_JOG_INCR_TYPE"),
    command<JogAbsolute>(126, "EMC_JOG_ABS_TYPE"),
    command<ActivateJoint>(127, "EMC_JOINT_ACTIVATE_TYPE"),
    command<DeactivateJoint>(128, "EMC_JOINT_DEACTIVATE_TYPE"),
    command<OverrideLimits>(129, "EMC_JOINT_OVERRIDE_LIMITS_TYPE"),
    command<LoadCompensation>(131, "EMC_JOINT_LOAD_COMP_TYPE"),
    command<SetJointBacklash>(134, "EMC_JOINT_SET_BACKLASH_TYPE"),
    command<UnhomeJoint>(135, "EMC_JOINT_UNHOME_TYPE"),
    command<JogStop>(136, "EMC_JOG_STOP_TYPE"),
    status<JointStatus>(198, "EMC_JOINT_STAT_TYPE"),
    status<AxisStatus>(199, "EMC_AXIS_STAT_TYPE"),
    rejected(201, "EMC_TRAJ_SET_AXES_TYPE", PART_OF_CONFIGURATION),
    rejected(202, "EMC_TRAJ_SET_UNITS_TYPE", PART_OF_CONFIGURATION),
    rejected(203, "EMC_TRAJ_SET_CYCLE_TIME_TYPE", PART_OF_CONFIGURATION),
    command<SetMotionMode>(204, "EMC_TRAJ_SET_MODE_TYPE"),
    rejected(205, "EMC_TRAJ_SET_VELOCITY_TYPE", PART_OF_PROGRAM),
    rejected(206, "EMC_TRAJ_SET_ACCELERATION_TYPE", PART_OF_PROGRAM),
    command<SetMaxVelocity>(207, "EMC_TRAJ_SET_MAX_VELOCITY_TYPE"),
    rejected(208, "EMC_TRAJ_SET_MAX_ACCELERATION_TYPE", PART_OF_CONFIGURATION),
    command<SetFeedOverride>(209, "EMC_TRAJ_SET_SCALE_TYPE"),
    rejected(210, "EMC_TRAJ_SET_MOTION_ID_TYPE", PART_OF_PROGRAM),
    rejected(211, "EMC_TRAJ_INIT_TYPE", PART_OF_START),
    rejected(212, "EMC_TRAJ_HALT_TYPE", PART_OF_START),
    same_as(213, "EMC_TRAJ_ENABLE_TYPE", ON),
    same_as(214, "EMC_TRAJ_DISABLE_TYPE", OFF),
    same_as(215, "EMC_TRAJ_ABORT_TYPE", ABORT),
    same_as(216, "EMC_TRAJ_PAUSE_TYPE", PAUSE),
    same_as(217, "EMC_TRAJ_STEP_TYPE", STEP),
    same_as(218, "EMC_TRAJ_RESUME_TYPE", RESUME),
    rejected(219, "EMC_TRAJ_DELAY_TYPE", PART_OF_PROGRAM),
    rejected(220, "EMC_TRAJ_LINEAR_MOVE_TYPE", PART_OF_PROGRAM),
    rejected(221, "EMC_TRAJ_CIRCULAR_MOVE_TYPE", PART_OF_PROGRAM),
    rejected(222, "EMC_TRAJ_SET_TERM_COND_TYPE", PART_OF_PROGRAM),
    rejected(223, "EMC_TRAJ_SET_OFFSET_TYPE", PART_OF_PROGRAM),
    rejected(224, "EMC_TRAJ_SET_G5X_TYPE", PART_OF_PROGRAM),
    rejected(225, "EMC_TRAJ_SET_HOME_TYPE", PART_OF_CONFIGURATION),
    rejected(226, "EMC_TRAJ_SET_ROTATION_TYPE", PART_OF_PROGRAM),
    rejected(227, "EMC_TRAJ_SET_G92_TYPE", PART_OF_PROGRAM),
    command<ClearProbe>(228, "EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG_TYPE"),
    rejected(229, "EMC_TRAJ_PROBE_TYPE", PART_OF_PROGRAM),
    command<SetTeleop>(230, "EMC_TRAJ_SET_TELEOP_ENABLE_TYPE"),
    command<SetTeleopVector>(231, "EMC_TRAJ_SET_TELEOP_VECTOR_TYPE"),
    command<SetSpindleSync>(232, "EMC_TRAJ_SET_SPINDLESYNC_TYPE"),
    command<SetSpindleOverride>(233, "EMC_TRAJ_SET_SPINDLE_SCALE_TYPE"),
    command<EnableFeedOverride>(234, "EMC_TRAJ_SET_FO_ENABLE_TYPE"),
    command<EnableSpindleOverride>(235, "EMC_TRAJ_SET_SO_ENABLE_TYPE"),
    command<EnableFeedHold>(236, "EMC_TRAJ_SET_FH_ENABLE_TYPE"),
    command<RigidTapMove>(237, "EMC_TRAJ_RIGID_TAP_TYPE"),
    command<SetRapidOverride>(238, "EMC_TRAJ_SET_RAPID_SCALE_TYPE"),
    status<TrajectoryStatus>(299, "EMC_TRAJ_STAT_TYPE"),
    rejected(301, "EMC_MOTION_INIT_TYPE", PART_OF_START),
    rejected(302, "EMC_MOTION_HALT_TYPE", PART_OF_START),
    same_as(303, "EMC_MOTION_ABORT_TYPE", ABORT),
    command<SetAnalogOutput>(304, "EMC_MOTION_SET_AOUT_TYPE"),
    command<SetDigitalOutput>(305, "EMC_MOTION_SET_DOUT_TYPE"),
    command<EnableAdaptiveFeed>(306, "EMC_MOTION_ADAPTIVE_TYPE"),
    status<MotionStatus>(399, "EMC_MOTION_STAT_TYPE"),
    rejected(501, "EMC_TASK_INIT_TYPE", PART_OF_START),
    rejected(502, "EMC_TASK_HALT_TYPE", PART_OF_START),
    command<AbortAll>(503, "EMC_TASK_ABORT_TYPE"),
    command<SetMode>(504, "EMC_TASK_SET_MODE_TYPE"),
    command<SetState>(505, "EMC_TASK_SET_STATE_TYPE"),
    command<OpenProgram>(506, "EMC_TASK_PLAN_OPEN_TYPE"),
    command<RunProgram>(507, "EMC_TASK_PLAN_RUN_TYPE"),
    rejected(508, "EMC_TASK_PLAN_READ_TYPE", PART_OF_PROGRAM),
    command<Mdi>(509, "EMC_TASK_PLAN_EXECUTE_TYPE"),
    command<PauseProgram>(510, "EMC_TASK_PLAN_PAUSE_TYPE"),
    command<StepProgram>(511, "EMC_TASK_PLAN_STEP_TYPE"),
    command<ResumeProgram>(512, "EMC_TASK_PLAN_RESUME_TYPE"),
    rejected(513, "EMC_TASK_PLAN_END_TYPE", PART_OF_PROGRAM),
    command<CloseProgram>(514, "EMC_TASK_PLAN_CLOSE_TYPE"),
    command<ResetInterpreter>(515, "EMC_TASK_PLAN_INIT_TYPE"),
    command<SynchInterpreter>(516, "EMC_TASK_PLAN_SYNCH_TYPE"),
    command<SetOptionalStop>(517, "EMC_TASK_PLAN_SET_OPTIONAL_STOP_TYPE"),
    command<SetBlockDelete>(518, "EMC_TASK_PLAN_SET_BLOCK_DELETE_TYPE"),
    command<StopOptionally>(519, "EMC_TASK_PLAN_OPTIONAL_STOP_TYPE"),
    command<ReverseProgram>(520, "EMC_TASK_PLAN_REVERSE_TYPE"),
    command<ForwardProgram>(521, "EMC_TASK_PLAN_FORWARD_TYPE"),
    status<TaskStatus>(599, "EMC_TASK_STAT_TYPE"),
    rejected(1101, "EMC_TOOL_INIT_TYPE", PART_OF_START),
    rejected(1102, "EMC_TOOL_HALT_TYPE", PART_OF_START),
    same_as(1103, "EMC_TOOL_ABORT_TYPE", ABORT),
    rejected(1104, "EMC_TOOL_PREPARE_TYPE", PART_OF_PROGRAM),
    rejected(1105, "EMC_TOOL_LOAD_TYPE", PART_OF_PROGRAM),
    rejected(1106, "EMC_TOOL_UNLOAD_TYPE", PART_OF_PROGRAM),
    command<LoadToolTable>(1107, "EMC_TOOL_LOAD_TOOL_TABLE_TYPE"),
    command<SetToolEntry>(1108, "EMC_TOOL_SET_OFFSET_TYPE"),
    rejected(1109, "EMC_TOOL_SET_NUMBER_TYPE", PART_OF_PROGRAM),
    rejected(1110, "EMC_TOOL_START_CHANGE_TYPE", PART_OF_PROGRAM),
    rejected(1112, "EMC_EXEC_PLUGIN_CALL_TYPE", NO_PLUGINS),
    rejected(1113, "EMC_IO_PLUGIN_CALL_TYPE", NO_PLUGINS),
    status<ToolStatus>(1199, "EMC_TOOL_STAT_TYPE"),
    same_as(1206, "EMC_AUX_ESTOP_ON_TYPE", ESTOP),
    same_as(1207, "EMC_AUX_ESTOP_OFF_TYPE", ESTOP_RESET),
    same_as(1208, "EMC_AUX_ESTOP_RESET_TYPE", ESTOP_RESET),
    rejected(1209, "EMC_AUX_INPUT_WAIT_TYPE", PART_OF_PROGRAM),
    status<AuxStatus>(1299, "EMC_AUX_STAT_TYPE"),
    command<SpindleOn>(1304, "EMC_SPINDLE_ON_TYPE"),
    command<SpindleOff>(1305, "EMC_SPINDLE_OFF_TYPE"),
    command<SpindleIncrease>(1309, "EMC_SPINDLE_INCREASE_TYPE"),
    command<SpindleDecrease>(1310, "EMC_SPINDLE_DECREASE_TYPE"),
    command<SpindleConstant>(1311, "EMC_SPINDLE_CONSTANT_TYPE"),
    command<ReleaseBrake>(1312, "EMC_SPINDLE_BRAKE_RELEASE_TYPE"),
    command<EngageBrake>(1313, "EMC_SPINDLE_BRAKE_ENGAGE_TYPE"),
    rejected(1316, "EMC_SPINDLE_SPEED_TYPE", PART_OF_PROGRAM),
    rejected(1317, "EMC_SPINDLE_ORIENT_TYPE", PART_OF_PROGRAM),
    rejected(1318, "EMC_SPINDLE_WAIT_ORIENT_COMPLETE_TYPE", PART_OF_PROGRAM),
    status<SpindleStatus>(1399, "EMC_SPINDLE_STAT_TYPE"),
    command<MistOn>(1404, "EMC_COOLANT_MIST_ON_TYPE"),
    command<MistOff>(1405, "EMC_COOLANT_MIST_OFF_TYPE"),
    command<FloodOn>(1406, "EMC_COOLANT_FLOOD_ON_TYPE"),
    command<FloodOff>(1407, "EMC_COOLANT_FLOOD_OFF_TYPE"),
    status<CoolantStatus>(1499, "EMC_COOLANT_STAT_TYPE"),
    command<LubeOn>(1504, "EMC_LUBE_ON_TYPE"),
    command<LubeOff>(1505, "EMC_LUBE_OFF_TYPE"),
    status<LubeStatus>(1599, "EMC_LUBE_STAT_TYPE"),
    rejected(1601, "EMC_IO_INIT_TYPE", PART_OF_START),
    rejected(1602, "EMC_IO_HALT_TYPE", PART_OF_START),
    same_as(1603, "EMC_IO_ABORT_TYPE", ABORT),
    rejected(1604, "EMC_IO_SET_CYCLE_TIME_TYPE", PART_OF_CONFIGURATION),
    status<IoStatus>(1699, "EMC_IO_STAT_TYPE"),
    rejected(1901, "EMC_INIT_TYPE", PART_OF_START),
    rejected(1902, "EMC_HALT_TYPE", PART_OF_START),
    same_as(1903, "EMC_ABORT_TYPE", ABORT),
    status<MachineStatus>(1999, "EMC_STAT_TYPE"),
});

/// Declarations for rows without fields.
constexpr auto WITHOUT_FIELDS = [] {
    std::array<Declaration, ROWS.size()> all{};
    std::transform(ROWS.begin(), ROWS.end(), all.begin(), [](const MessageKind &row) {
        return Declaration{row.wire_name, row.number, "has no fields here", {}};
    });
    return all;
}();

constexpr auto TABLE = [] {
    auto all = ROWS;
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].declaration = all[i].declaration == nullptr ? &WITHOUT_FIELDS[i] : all[i].declaration;
    }
    return all;
}();

std::string treatment_of(const MessageKind &kind) {
    if (kind.rejection != nullptr) {
        return fmt::format("rejected: {}", kind.rejection);
    }
    if (kind.convert == nullptr) {
        return fmt::format("`{}`", kind.declaration->name);
    }
    const auto body = kind.make();
    const Command command = kind.convert(body.get());
    return fmt::format("`{}`", kind.declaration->fields.empty() ? to_text(command)
                                                                : object(command).declaration->name);
}

}  // namespace

std::span<const MessageKind> wire_messages() {
    return TABLE;
}

std::string_view wire_name(const Declaration &declaration) {
    const auto found = std::ranges::find(TABLE, declaration.number, &MessageKind::number);
    return found == TABLE.end() ? std::string_view(declaration.name) : found->wire_name;
}

std::string nml_reference_page() {
    std::string page =
        "# NML messages\n"
        "This page lists the NML messages, for authors of clients. Generated from the table in "
        "`src/clients/nml/message/wire_table.cc`. The last column names the\n"
        "command or status of the machine, whose fields are in `messages.md`, or the reason why the machine\n"
        "rejects the message. The machine also sends messages 11 to 13, on the error channel.\n"
        "\n"
        "| number | name | class | in the machine |\n"
        "|---|---|---|---|\n";
    const Vocabulary vocabulary = Vocabulary::standard();
    for (const auto &[number, kind] : vocabulary.kinds()) {
        page += fmt::format("| {} | {} | {} | {} |\n", number, kind.wire_name, name_of(kind.base),
                            treatment_of(kind));
    }
    return page;
}

}  // namespace mw::nml
