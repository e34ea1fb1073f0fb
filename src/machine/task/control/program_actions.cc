// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/program_actions.hh"

#include <fmt/format.h>

#include "gcode/interpreter/scripts/user_codes.hh"

namespace mw::task {

SequencerEvents ProgramActions::events() {
    SequencerEvents events;
    events.message = [this](MessageKind kind, const std::string &text) { parts_.port.post(kind, text); };
    events.print = [this](const std::string &text) { parts_.port.post(MessageKind::OPERATOR_TEXT, text); };
    events.stop = [this](const gcode::ProgramStop &at, int line) { return stop(at, line); };
    events.end = [this] { parts_.run.change(RunEvent::READ); };
    events.fail = [this](const std::string &text) { parts_.run.note_failure(text); };
    events.offsets = [this](const gcode::UseOffsets &item) { use_offsets(item); };
    events.tool_offset = [this](const gcode::UseToolOffset &item) { return use_tool_offset(item); };
    events.planner_mode = [this](const gcode::UsePlanner &item) { return use_planner(item); };
    events.confinement = [this] { return parts_.senders.confinement(); };
    events.start_user_code = [this](const gcode::UserCode &item) { start_user_code(item); };
    events.user_code_result = [this]() -> std::optional<Result<>> {
        return user_program_.isRunning() ? std::nullopt : std::optional(user_program_.take_result());
    };
    return events;
}

bool ProgramActions::stop(const gcode::ProgramStop &stop, int line) {
    const ProgramRun &run = parts_.run;
    // There is nothing to pause after the last block of an MDI line.
    const bool is_last =
        run.kind() == RunKind::MDI && run.phase() == RunPhase::FINISHING && parts_.reader.queue().size() <= 1;
    if (is_last || (stop.optional && !parts_.world.isOptionalStopOn())) {
        return false;
    }
    stops_.line = line;
    ++stops_.count;
    parts_.run.change(RunEvent::PROGRAM_STOP);
    return true;
}

void ProgramActions::show_announced_offsets() {
    const TaskCanon &canon = parts_.reader.canon();
    if (canon.offsets().has_value()) {
        use_offsets(*canon.offsets());
    }
    offsets_.tool = canon.tool_offset().value_or(offsets_.tool);
}

void ProgramActions::use_offsets(const gcode::UseOffsets &item) {
    offsets_.g5x_index = item.g5x_index;
    offsets_.g5x = item.g5x;
    offsets_.g92 = item.g92;
    offsets_.rotation_xy_deg = item.rotation_xy_deg;
}

motion::CommandId ProgramActions::use_tool_offset(const gcode::UseToolOffset &item) {
    offsets_.tool = item.offset;
    parts_.io.set_tool_offset(item.offset);
    return parts_.port.send(motion::SetToolOffset{item.offset});
}

std::optional<motion::CommandId> ProgramActions::use_planner(const gcode::UsePlanner &item) {
    const int smooth = parts_.settings.sequencer.smooth_planner;
    if (item.isSmooth && smooth == 0) {
        parts_.run.note_failure("G64 R above 0 needs the jerk-limited planner, which [TRAJ]SMOOTH_PLANNER = "
                                "0 does not allow; use G64 R0 or no R");
        return std::nullopt;
    }
    return parts_.planner.set(item.isSmooth ? smooth : 0);
}

void ProgramActions::start_user_code(const gcode::UserCode &item) {
    const auto find = [folders = parts_.settings.interpreter.user_m_path,
                       code = item.code]() -> Result<std::string> {
        const std::string path = gcode::find_user_program(folders, code);
        return path.empty()
                   ? Result<std::string>(fail(fmt::format("M{}: its program no longer exists", code)))
                   : path;
    };
    user_program_.start(fmt::format("M{}", item.code), find, item.p, item.q);
}

}  // namespace mw::task
