// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/table.hh"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "clients/publish/field_path.hh"

namespace mw::publish {
namespace {

using messages::MachineStatus;

Value execution(const MachineStatus &status, int) {
    using messages::InterpState;
    const auto &task = status.task;
    const bool runs = task.interp_state != InterpState::IDLE;
    if (!runs) {
        return std::string(task.state == messages::State::ON ? "READY" : "STOPPED");
    }
    if (task.isStoppedByProgram) {
        return std::string("PROGRAM_STOPPED");
    }
    if (task.isPaused || task.interp_state == InterpState::PAUSED) {
        return std::string("INTERRUPTED");
    }
    if (status.trajectory.isPaused) {
        return std::string("FEED_HOLD");
    }
    return std::string(task.waiting.what != messages::WaitFor::NOTHING ? "WAIT" : "ACTIVE");
}

Value program_fault(const MachineStatus &status, int) {
    return status.task.error_code == 0
               ? std::string()
               : fmt::format("The last program or line failed (code {}).", status.task.error_code);
}

Value system_fault(const MachineStatus &status, int) {
    return std::string(status.motion.isTaskLost ? "Task was lost." : "");
}

Value changer_fault(const MachineStatus &status, int) {
    return std::string(status.tool.isFaulted ? "The tool changer reports a fault." : "");
}

Value drive_fault(const MachineStatus &status, int) {
    std::string text;
    for (int i = 0; i < status.trajectory.num_joints && i < MAX_JOINTS; ++i) {
        const auto &joint = status.joints[static_cast<std::size_t>(i)];
        if (joint.isFaulted) {
            text += fmt::format("{}Joint {}: amplifier fault.", text.empty() ? "" : " ", i);
        }
        if (joint.isFerrorTripped) {
            text += fmt::format("{}Joint {}: following error.", text.empty() ? "" : " ", i);
        }
    }
    return text;
}

Value limit_fault(const MachineStatus &status, int) {
    std::string text;
    for (int i = 0; i < status.trajectory.num_joints && i < MAX_JOINTS; ++i) {
        const auto &joint = status.joints[static_cast<std::size_t>(i)];
        if (joint.isOnNegHardLimit || joint.isOnPosHardLimit) {
            text += fmt::format("{}Joint {}: limit switch {}.", text.empty() ? "" : " ", i,
                                joint.isOnNegHardLimit ? "min" : "max");
        }
    }
    return text;
}

/// Codes that are multiplied by `scale`, as "G1 G17 G54".
template <std::size_t N>
std::string code_words(const std::array<int, N> &codes, char letter, int scale) {
    std::string text;
    for (std::size_t i = 1; i < N; ++i) {
        if (codes[i] < 0) {
            continue;
        }
        const int whole = codes[i] / scale, part = codes[i] % scale;
        text += fmt::format("{}{}{}", text.empty() ? "" : " ", letter, whole);
        text += part == 0 ? "" : fmt::format(".{}", part);
    }
    return text;
}

Value g_codes(const MachineStatus &status, int) {
    return code_words(status.codes.g, 'G', 10);
}
Value m_codes(const MachineStatus &status, int) {
    return code_words(status.codes.m, 'M', 1);
}
Value programmed_feed(const MachineStatus &status, int) {
    return status.codes.settings[1];
}
Value programmed_speed(const MachineStatus &status, int) {
    return status.codes.settings[2];
}
Value position(const MachineStatus &status, int axis) {
    return status.trajectory.isPositionValid ? Value(status.trajectory.position_fb[axis]) : Value();
}
Value dwell_left(const MachineStatus &status, int) {
    return status.task.delay_left_s;
}

constexpr double NEAR = 0.001;  ///< deadband of positions [machine units, degrees]
constexpr double SPEED = 0.01;  ///< deadband of speeds [machine units/s]
constexpr double TURNS = 0.1;   ///< deadband of spindles [rev/s]

constexpr Item item(Component component, Category category, const char *type, const char *sub_type = "",
                    const char *units = "", Form form = Form::PLAIN) {
    return {component, category, type, sub_type, units, form};
}
constexpr Item fault(Component component, const char *type) {
    return item(component, Category::CONDITION, type, "", "", Form::FAULT);
}
constexpr auto SAMPLE = Category::SAMPLE;
constexpr auto EVENT = Category::EVENT;

// clang-format off
constexpr Row ROWS[] = {
    {"State", "task.state", Each::ONCE, 0, item(Component::CONTROLLER, EVENT, "EMERGENCY_STOP", "", "", Form::STOPPED)},
    {"Mode", "task.mode", Each::ONCE, 0, item(Component::PATH, EVENT, "CONTROLLER_MODE", "", "", Form::MODE)},
    {"Execution", "task.interp_state task.state task.is_paused task.stopped_by_program trajectory.is_paused task.waiting.what", Each::ONCE, 0, item(Component::PATH, EVENT, "EXECUTION"), execution, "READY, ACTIVE, WAIT, FEED_HOLD, INTERRUPTED, PROGRAM_STOPPED, STOPPED as in MTConnect"},
    {"Program/Path", "task.program", Each::ONCE, 0, item(Component::PATH, EVENT, "PROGRAM", "", "", Form::FILE)},
    {"Program/Line", "task.motion_line", Each::ONCE, 0, item(Component::PATH, EVENT, "LINE_NUMBER", "ABSOLUTE")},
    {"Program/Block", "task.block", Each::ONCE, 0, item(Component::PATH, EVENT, "BLOCK")},
    {"Program/Read Line", "task.read_line"},
    {"Program/Stop Line", "task.stop_line"},
    {"Program/Stops", "task.stops"},
    {"Program/Ended", "task.programs_ended"},
    {"Program/Error Code", "task.error_code"},
    {"Program/Interpreter", "task.interp_state"},
    {"Program/Paused", "task.is_paused"},
    {"Program/Stopped by Program", "task.stopped_by_program"},
    {"Program/Away", "task.is_away"},
    {"Program/Optional Stop", "task.optional_stop"},
    {"Program/Block Delete", "task.block_delete"},
    {"Program/Call Level", "task.call_level"},
    {"Program/Queued MDI", "task.queued_mdi"},
    {"Program/Waiting For", "task.waiting.what"},
    {"Program/Waiting Index", "task.waiting.index"},
    {"Program/Dwell Left", "task.delay_left", Each::ONCE, 1.0, {}, dwell_left, "time left of a dwell, in whole steps of a second"},
    {"Program/Input Timeout", "task.input_timeout"},
    {"Program/G Codes", "codes.g", Each::ONCE, 0, {}, g_codes, "active G codes"},
    {"Program/M Codes", "codes.m", Each::ONCE, 0, {}, m_codes, "active M codes"},
    {"Program/Feed", "codes.settings", Each::ONCE, 0, {}, programmed_feed, "programmed feed, the F word"},
    {"Program/Speed", "codes.settings", Each::ONCE, 0, {}, programmed_speed, "programmed spindle speed, the S word"},
    {"Motion/Enabled", "trajectory.is_enabled"},
    {"Motion/Mode", "trajectory.mode"},
    {"Motion/In Position", "trajectory.in_position"},
    {"Motion/Paused", "trajectory.is_paused"},
    {"Motion/Stepping", "trajectory.is_stepping"},
    {"Motion/Reverse", "trajectory.is_reverse"},
    {"Motion/All Homed", "trajectory.all_homed"},
    {"Motion/Homing", "trajectory.is_homing"},
    {"Motion/Move Type", "trajectory.move_kind"},
    {"Motion/Feed Rate", "trajectory.current_velocity", Each::ONCE, SPEED, item(Component::PATH, SAMPLE, "PATH_FEEDRATE", "ACTUAL", "MILLIMETER/SECOND", Form::LENGTH)},
    {"Motion/Requested Feed Rate", "trajectory.requested_velocity", Each::ONCE, SPEED, item(Component::PATH, SAMPLE, "PATH_FEEDRATE", "COMMANDED", "MILLIMETER/SECOND", Form::LENGTH)},
    {"Motion/Task Lost", "motion.task_lost"},
    {"Axes/#/Position", "trajectory.position_fb trajectory.position_valid", Each::AXIS, NEAR, item(Component::AXIS, SAMPLE, "POSITION", "ACTUAL", "MILLIMETER", Form::LENGTH), position, "position by feedback, machine coordinates; null while it is not known"},
    {"Axes/#/Commanded Position", "trajectory.position_cmd", Each::AXIS, NEAR, item(Component::AXIS, SAMPLE, "POSITION", "COMMANDED", "MILLIMETER", Form::LENGTH)},
    {"Axes/#/Distance to Go", "trajectory.dtg", Each::AXIS, NEAR},
    {"Axes/#/Jog Velocity", "axes.velocity", Each::AXIS, SPEED},
    {"Axes/#/Min Limit", "axes.min_limit", Each::AXIS},
    {"Axes/#/Max Limit", "axes.max_limit", Each::AXIS},
    {"Joints/#/Position", "joints.pos_fb", Each::JOINT, NEAR},
    {"Joints/#/Following Error", "joints.ferror", Each::JOINT, NEAR},
    {"Joints/#/Largest Following Error", "joints.ferror_highmark", Each::JOINT, NEAR},
    {"Joints/#/Min Limit", "joints.min_limit", Each::JOINT},
    {"Joints/#/Max Limit", "joints.max_limit", Each::JOINT},
    {"Joints/#/Max Velocity", "joints.max_velocity", Each::JOINT},
    {"Joints/#/Max Acceleration", "joints.max_acceleration", Each::JOINT},
    {"Joints/#/Active", "joints.is_active", Each::JOINT},
    {"Joints/#/In Position", "joints.in_position", Each::JOINT},
    {"Joints/#/Enabled", "joints.is_enabled", Each::JOINT},
    {"Joints/#/Homing", "joints.is_homing", Each::JOINT},
    {"Joints/#/Homed", "joints.is_homed", Each::JOINT},
    {"Joints/#/Amplifier Fault", "joints.is_faulted", Each::JOINT},
    {"Joints/#/Min Soft Limit", "joints.on_neg_soft_limit", Each::JOINT},
    {"Joints/#/Max Soft Limit", "joints.on_pos_soft_limit", Each::JOINT},
    {"Joints/#/Min Limit Switch", "joints.on_neg_hard_limit", Each::JOINT},
    {"Joints/#/Max Limit Switch", "joints.on_pos_hard_limit", Each::JOINT},
    {"Joints/#/Following Error Tripped", "joints.ferror_tripped", Each::JOINT},
    {"Joints/#/Limits Overridden", "joints.overriding_limits", Each::JOINT},
    {"Spindles/#/Commanded Speed", "spindles.speed_cmd_rpm", Each::SPINDLE, 0.1, item(Component::SPINDLE, SAMPLE, "ROTARY_VELOCITY", "COMMANDED", "REVOLUTION/MINUTE")},
    {"Spindles/#/Speed", "spindles.speed_in_rps", Each::SPINDLE, TURNS, item(Component::SPINDLE, SAMPLE, "ROTARY_VELOCITY", "ACTUAL", "REVOLUTION/MINUTE", Form::PER_MIN)},
    {"Spindles/#/Override", "spindles.override_factor", Each::SPINDLE, 0, item(Component::SPINDLE, EVENT, "ROTARY_VELOCITY_OVERRIDE", "", "PERCENT", Form::PERCENT)},
    {"Spindles/#/Direction", "spindles.direction", Each::SPINDLE, 0, item(Component::SPINDLE, EVENT, "DIRECTION", "ROTARY", "", Form::DIRECTION)},
    {"Spindles/#/On", "spindles.is_on", Each::SPINDLE},
    {"Spindles/#/At Speed", "spindles.at_speed", Each::SPINDLE},
    {"Spindles/#/Brake", "spindles.brake_on", Each::SPINDLE},
    {"Spindles/#/Override Enabled", "spindles.override_enabled", Each::SPINDLE},
    {"Spindles/#/Orientation", "spindles.orient_state", Each::SPINDLE},
    {"Spindles/#/Orientation Fault", "spindles.orient_fault", Each::SPINDLE},
    {"Probe/#", "probe.position", Each::AXIS},
    {"Probe/Probing", "probe.is_probing"},
    {"Probe/Tripped", "probe.tripped"},
    {"Probe/On", "probe.on"},
    {"Overrides/Feed", "overrides.feed", Each::ONCE, 0, item(Component::PATH, EVENT, "PATH_FEEDRATE_OVERRIDE", "PROGRAMMED", "PERCENT", Form::PERCENT)},
    {"Overrides/Rapid", "overrides.rapid", Each::ONCE, 0, item(Component::PATH, EVENT, "PATH_FEEDRATE_OVERRIDE", "RAPID", "PERCENT", Form::PERCENT)},
    {"Overrides/Net", "overrides.net"},
    {"Overrides/Feed Enabled", "overrides.feed_enabled"},
    {"Overrides/Adaptive Feed Enabled", "overrides.adaptive_feed_enabled"},
    {"Overrides/Feed Hold Enabled", "overrides.feed_hold_enabled"},
    {"Offsets/Work", "offsets.g5x_index", Each::ONCE, 0, item(Component::PATH, EVENT, "WORK_OFFSET", "", "", Form::WORK)},
    {"Offsets/Work/#", "offsets.g5x", Each::AXIS},
    {"Offsets/G92/#", "offsets.g92", Each::AXIS},
    {"Offsets/Tool/#", "offsets.tool", Each::AXIS},
    {"Offsets/Rotation", "offsets.rotation_xy_deg"},
    {"IO/Digital Inputs", "motion.digital_in"},
    {"IO/Digital Outputs", "motion.digital_out"},
    {"IO/Emergency Stop Requested", "io.aux.estop_requested"},
    {"IO/Emergency Stop Chain Closed", "io.aux.chain_closed"},
    {"IO/Mist", "io.coolant.mist"},
    {"IO/Flood", "io.coolant.flood"},
    {"IO/Lubrication", "io.lube.on"},
    {"IO/Lubricant Level OK", "io.lube.level_ok"},
    {"Tool/Number", "tool.in_spindle", Each::ONCE, 0, item(Component::PATH, EVENT, "TOOL_NUMBER")},
    {"Tool/Pocket", "tool.from_pocket"},
    {"Tool/Prepared", "tool.prepared_index"},
    {"Tool/Person Asked", "tool.person_asked"},
    {"Tool/Changer Fault", "tool.faulted"},
    {"Tool/Cut Time", "tool.cut_time_s", Each::ONCE, 1.0},
    {"Tool/Cut Length", "tool.cut_length", Each::ONCE, 1.0},
    {"Operation/Client", "operation.holder"},
    {"Recovery/Offered", "recovery.offered"},
    {"Recovery/Line", "recovery.line"},
    {"Recovery/Program", "recovery.program"},
    {"Settings/Max Velocity", "settings.max_velocity"},
    {"Settings/Max Acceleration", "settings.max_acceleration"},
    {"Settings/Units per mm", "settings.linear_units"},
    {"Alarms/Program", "task.error_code", Each::ONCE, 0, fault(Component::PATH, "LOGIC_PROGRAM"), program_fault, "text of a failed program or line, empty without one"},
    {"Alarms/System", "motion.task_lost", Each::ONCE, 0, fault(Component::CONTROLLER, "SYSTEM"), system_fault, "text of a lost task, empty without one"},
    {"Alarms/Tool Changer", "tool.faulted", Each::ONCE, 0, fault(Component::CONTROLLER, "HARDWARE"), changer_fault, "text of a changer fault, empty without one"},
    {"Alarms/Drives", "joints.is_faulted joints.ferror_tripped", Each::ONCE, 0, fault(Component::CONTROLLER, "ACTUATOR"), drive_fault, "amplifier faults and following errors of all joints, empty without one"},
    {"Alarms/Limits", "joints.on_neg_hard_limit joints.on_pos_hard_limit", Each::ONCE, 0, fault(Component::CONTROLLER, "POSITION"), limit_fault, "limit switches of all joints, empty when none is on"},
};

constexpr NotPublished NOT_PUBLISHED[] = {
    {"cycle", "counts task cycles; the session shows that the machine lives"},
    {"time_ns", "clock of the process; each value has its time in UTC"},
    {"last_command", "number in the mailbox, for its clients only"},
    {"last_progress", "of that command"},
    {"last_message", "number in the mailbox; the messages themselves are published"},
    {"task.exec_state", "internal step of task, several in a millisecond; Execution shows the state"},
    {"task.blocks", "changes with each block; Program/Line shows the place"},
    {"trajectory.axis_mask", "selects the axes that are published"},
    {"trajectory.num_joints", "selects the joints that are published"},
    {"trajectory.num_extra_joints", "of the configuration"},
    {"trajectory.num_spindles", "selects the spindles that are published"},
    {"trajectory.queue_depth", "internal to the planner, changes with each move"},
    {"trajectory.queue_full", "internal to the planner, changes with each move"},
    {"trajectory.active_move", "internal number of a move"},
    {"trajectory.distance_to_go", "changes in each cycle; Axes/#/Distance to Go has it for each axis"},
    {"motion.cycle", "counts servo cycles"},
    {"motion.analog_in", "64 pins whose meaning and unit only the HAL file knows"},
    {"motion.analog_out", "64 pins whose meaning and unit only the HAL file knows"},
    {"joints.is_present", "selects the joints that are published"},
    {"joints.pos_cmd", "position by feedback and following error are published"},
    {"joints.vel_cmd", "changes in each cycle"},
    {"joints.motor_pos_cmd", "for tuning, at the machine"},
    {"joints.motor_pos_fb", "for tuning, at the machine"},
    {"axes.is_present", "selects the axes that are published"},
    {"spindles.is_present", "selects the spindles that are published"},
    {"spindles.revs", "changes in each cycle"},
    {"tool.table_version", "counts changes; the tools are assets of MTConnect"},
    {"operation.lease_left_s", "changes in each cycle"},
    {"operation.handovers", "counts changes of Operation/Client"},
    {"approach", "a proposal to the person at the machine"},
    {"recovery.block", "the same as Recovery/Line, for task"},
    {"recovery.refusal", "for the person at the machine"},
    {"settings.angular_units", "angles are published in degrees"},
    {"settings.cycle_time", "of the configuration"},
    {"settings.debug", "of the configuration"},
    {"settings.kinematics", "of the configuration"},
    {"settings.joints", "of the configuration"},
};
// clang-format on

std::string names(const Item &item) {
    if (item.component == Component::NONE) {
        return "";
    }
    constexpr std::array<const char *, 3> CATEGORIES{"SAMPLE", "EVENT", "CONDITION"};
    std::string text = fmt::format("{} {}", CATEGORIES[static_cast<std::size_t>(item.category)], item.type);
    text += *item.sub_type == 0 ? "" : fmt::format(" {}", item.sub_type);
    text += *item.units == 0 ? "" : fmt::format(", {}", item.units);
    return text;
}

}  // namespace

std::span<const Row> rows() {
    return ROWS;
}

std::span<const NotPublished> not_published() {
    return NOT_PUBLISHED;
}

std::string published_page() {
    std::string page =
        "# Published values\n\n"
        "This page lists the values that `millwright publish` sends to a broker as metrics of Sparkplug B, "
        "and "
        "provides for clients of MTConnect. It is for integrators who connect a machine to a shop. Generated "
        "from the table in "
        "`src/clients/publish/table.cc`. # is the letter of an axis, or the number of a joint or spindle.\n\n"
        "| metric | type | unit | deadband | value | MTConnect |\n|---|---|---|---|---|---|\n";
    for (const Row &row : ROWS) {
        const auto field = FieldPath::find(FieldPath::first_of(row.fields));
        const bool isPlain = row.calculate == nullptr;
        page +=
            fmt::format("| {} | {} | {} | {} | {} | {} |\n", row.metric, name_of(type_of(row)), field->unit(),
                        row.deadband == 0 ? std::string("each change") : fmt::format("{}", row.deadband),
                        isPlain ? field->doc() : row.doc, names(row.item));
    }
    page += fmt::format(
        "| {} | String | | each message | text of a message to the operator | EVENT MESSAGE |\n"
        "| {} | String | | each message | ERROR, TEXT or DISPLAY | |\n"
        "| {} | String | | each message | unique: a message that is received twice has the same Id | |\n",
        MESSAGE_METRIC, MESSAGE_TYPE_METRIC, MESSAGE_ID_METRIC);
    page += "\n## Values that are not published\n\n| field of the status | reason |\n|---|---|\n";
    for (const NotPublished &field : NOT_PUBLISHED) {
        page += fmt::format("| {} | {} |\n", field.field, field.reason);
    }
    return page;
}

}  // namespace mw::publish
