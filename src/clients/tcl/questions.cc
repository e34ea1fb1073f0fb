// SPDX-License-Identifier: GPL-2.0-or-later
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/rsh/units.hh"
#include "clients/tcl/commands.hh"
#include "messages/legacy/status_table.hh"
#include "messages/legacy/units.hh"

namespace mw::tcl {
namespace {

using Text = Result<std::string>;

/// A floating-point number as Tcl writes it, without the digits that unit conversions add.
std::string number(double value) {
    const std::string text = fmt::format("{:.12g}", value == 0 ? 0.0 : value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// Converts machine units to the shown units; AUTO: the units of the program.
double shown_length(const Shell &shell) {
    return rsh::length_factor(rsh::shown_unit(shell.own, shell.status()), shell.status());
}

double factor_of_axis(const Shell &shell, int axis) {
    return geometry::isAngular(axis) ? rsh::angle_factor(shell.own.angle_unit, shell.status())
                                     : shown_length(shell);
}

Result<int> letter(const Words &words) {
    const int axis = !words.empty() && words[0].size() == 1 ? geometry::axis_of_letter(words[0][0]) : -1;
    return axis >= 0 ? Result<int>(axis)
                     : fail(fmt::format("'{}' is not one of X Y Z A B C U V W",
                                        words.empty() ? "" : printable(words[0])));
}

Text of_pose(const Shell &shell, const Words &words, const geometry::Pose &pose) {
    const auto axis = letter(words);
    return axis.has_value() ? Text(number(pose[*axis] * factor_of_axis(shell, *axis)))
                            : std::unexpected(axis.error());
}

Result<std::size_t> joint(const Words &words) {
    const auto value = parse_int(words.empty() ? "" : words[0]);
    const bool is_joint = value.has_value() && *value >= 0 && *value < MAX_JOINTS;
    return is_joint ? Result<std::size_t>(static_cast<std::size_t>(*value))
                    : fail(fmt::format("'{}' is not a joint: 0 to {}",
                                       words.empty() ? "" : printable(words[0]), MAX_JOINTS - 1));
}

/// An answer of linuxcncrsh in lower case.
template <class Name>
Text lower(Shell &shell, const Name &question, const Words &words = {}) {
    auto text = shell.told(question, words);
    return text.has_value() ? Text(to_lower(*text)) : text;
}

/// linuxcncrsh returns all axes; this command returns the axis of the letter.
Text relative(Shell &shell, const Words &words, const char *question) {
    const auto axis = letter(words);
    if (!axis.has_value()) {
        return std::unexpected(axis.error());
    }
    auto text = shell.told(question, {words[0]});  // machine units with AUTO
    const auto value = text.has_value() ? parse_double(rsh::behind_words(*text, 1)) : std::optional<double>();
    if (!value.has_value()) {
        return text;
    }
    const double told = geometry::isAngular(*axis)
                            ? rsh::angle_factor(shell.own.angle_unit, shell.status())
                            : rsh::length_factor(shell.own.length_unit, shell.status());
    return number(*value / told * factor_of_axis(shell, *axis));
}

Text program_status(Shell &shell, const Words &) {
    const messages::TaskStatus &task = shell.status().task;
    return task.isPaused ? "paused" : task.interp_state == messages::InterpState::IDLE ? "idle" : "running";
}

Text shown_units(Shell &shell, const Words &) {
    const std::string name = to_lower(rsh::name_of(rsh::shown_unit(shell.own, shell.status())));
    return shell.own.length_unit == rsh::LengthUnit::AUTO ? "(" + name + ")" : name;
}

Text shown_angles(Shell &shell, const Words &) {
    return shell.own.angle_unit == rsh::AngleUnit::AUTO ? "(deg)"
                                                        : to_lower(rsh::name_of(shell.own.angle_unit));
}

/// 1 done, 2 executing, 3 rejected or failed.
int progress_of(const messages::MachineStatus &status) {
    constexpr int DONE = 1, EXEC = 2, ERROR = 3;
    switch (status.last_progress) {
    case messages::Progress::REFUSED:
    case messages::Progress::FAILED: return ERROR;
    case messages::Progress::STARTED: return EXEC;
    case messages::Progress::DONE: break;
    }
    return status.task.interp_state == messages::InterpState::IDLE ? DONE : EXEC;
}

Text last_number(Shell &shell, const Words &) {
    return std::to_string(shell.status().last_command);
}
Text last_progress(Shell &shell, const Words &) {
    return std::to_string(progress_of(shell.status()));
}
/// The status does not contain which command it was.
Text last_kind(Shell &, const Words &) {
    return "0";
}

template <messages::MessageKind KIND>
Text next_line(Shell &shell, const Words &) {
    return shell.next_line(KIND).value_or("ok");
}

constexpr const char *LETTER = "letter";

/// A value from a row of the status table.
template <std::size_t I>
Text status_text(Shell &shell, const Words &words) {
    constexpr const auto &ROW = std::get<I>(legacy::STATUS);
    const auto value = ROW.get(shell.status());
    if constexpr (ROW.form == legacy::Form::POSE) {
        return of_pose(shell, words, value);
    } else {
        const bool is_order = legacy::isNamed(ROW.names.tcl_order) && !words.empty();
        return is_order ? shell.ask(ROW.names.rsh, words)
                        : Text(legacy::text(ROW.form, legacy::Dialect::TCL, value));
    }
}

template <std::size_t I>
Text joint_text(Shell &shell, const Words &words) {
    constexpr const auto &ROW = std::get<I>(legacy::JOINT_STATUS);
    const auto index = joint(words);
    if (!index.has_value()) {
        return std::unexpected(index.error());
    }
    const messages::MachineStatus &status = shell.status();
    const legacy::Joint one{status.joints[*index], status.settings.joints[*index]};
    if constexpr (ROW.form == legacy::Form::LENGTH) {
        const double factor =
            one.isAngular() ? rsh::angle_factor(shell.own.angle_unit, status) : shown_length(shell);
        return number(ROW.get(one) * factor);
    } else {
        return legacy::text(ROW.form, legacy::Dialect::TCL, ROW.get(one));
    }
}

constexpr auto OF_STATUS = legacy::from_rows<legacy::STATUS, &legacy::Names::tcl>([]<std::size_t I>() {
    constexpr const auto &ROW = std::get<I>(legacy::STATUS);
    constexpr bool POSE = ROW.form == legacy::Form::POSE;
    const int most = POSE || legacy::isNamed(ROW.names.tcl_order) ? 1 : 0;
    return CommandRow{ROW.names.tcl, POSE ? 1 : 0, most, POSE ? LETTER : ROW.names.tcl_order, status_text<I>};
});
constexpr auto OF_JOINTS = legacy::from_rows<legacy::JOINT_STATUS, &legacy::Names::tcl>([]<std::size_t I>() {
    return CommandRow{std::get<I>(legacy::JOINT_STATUS).names.tcl, 1, 1, "joint", joint_text<I>};
});

constexpr CommandRow ROWS[] = {
    {"emc_display_angular_units", 0, 0, "", shown_angles},
    {"emc_display_linear_units", 0, 0, "", shown_units},
    {"emc_error", 0, 0, "", next_line<messages::MessageKind::OPERATOR_ERROR>},
    {"emc_io_command", 0, 0, "", last_kind},
    {"emc_io_command_number", 0, 0, "", last_number},
    {"emc_io_command_status", 0, 0, "", last_progress},
    {"emc_io_heartbeat", 0, 0, "",
     [](Shell &s, const Words &) { return Text(std::to_string(s.status().cycle)); }},
    {"emc_motion_command", 0, 0, "", last_kind},
    {"emc_motion_command_number", 0, 0, "", last_number},
    {"emc_motion_command_status", 0, 0, "", last_progress},
    {"emc_operator_display", 0, 0, "", next_line<messages::MessageKind::OPERATOR_DISPLAY>},
    {"emc_operator_text", 0, 0, "", next_line<messages::MessageKind::OPERATOR_TEXT>},
    {"emc_program_angular_units", 0, 0, "", [](Shell &, const Words &) { return Text("deg"); }},
    {"emc_program_codes", 0, 0, "", [](Shell &s, const Words &) { return s.told("PROGRAM_CODES"); }},
    {"emc_program_linear_units", 0, 0, "",
     [](Shell &s, const Words &) { return Text(to_lower(rsh::name_of(rsh::program_unit(s.status())))); }},
    {"emc_program_status", 0, 0, "", program_status},
    {"emc_rel_act_pos", 1, 1, LETTER, [](Shell &s, const Words &w) { return relative(s, w, "REL_ACT_POS"); }},
    {"emc_rel_cmd_pos", 1, 1, LETTER, [](Shell &s, const Words &w) { return relative(s, w, "REL_CMD_POS"); }},
    {"emc_task_command", 0, 0, "", last_kind},
    {"emc_task_command_number", 0, 0, "", last_number},
    {"emc_task_command_status", 0, 0, "", last_progress},
    {"emc_tool_offset", 0, 1, "[letter]",
     [](Shell &s, const Words &w) {
         return of_pose(s, w.empty() ? Words{"Z"} : w, s.status().offsets.tool);
     }},
    {"emc_user_angular_units", 0, 0, "",
     [](Shell &s, const Words &) { return lower(s, "USER_ANGULAR_UNITS"); }},
    {"emc_user_linear_units", 0, 0, "",
     [](Shell &s, const Words &) { return lower(s, "USER_LINEAR_UNITS"); }},
};

}  // namespace

std::span<const CommandRow> questions() {
    static const std::vector<CommandRow> ALL = [] {
        std::vector<CommandRow> all(std::begin(ROWS), std::end(ROWS));
        all.insert(all.end(), OF_STATUS.begin(), OF_STATUS.end());
        all.insert(all.end(), OF_JOINTS.begin(), OF_JOINTS.end());
        return all;
    }();
    return ALL;
}

}  // namespace mw::tcl
