// SPDX-License-Identifier: GPL-2.0-or-later
// The status that task writes at the end of its cycle.
#include <algorithm>
#include <cmath>

#include "machine/task/link/motion_status.hh"
#include "machine/task/program_resume.hh"
#include "machine/task/run/shown_offsets.hh"
#include "machine/task/task_show.hh"

namespace mw::task {
namespace {

/// Cutting time and length of the tool in the spindle since that status: axes at feed while a spindle ran.
tools::CutLife cut_since(const Status &status, std::int64_t now_ns) {
    constexpr double S_PER_NS = 1e-9;
    const double elapsed_s = static_cast<double>(now_ns - status.time_ns) * S_PER_NS;
    const MoveKind kind = status.trajectory.move_kind;
    const bool feeding = kind == MoveKind::FEED || kind == MoveKind::ARC;
    const bool turning =
        std::ranges::any_of(status.spindles, [](const SpindleStatus &spindle) { return spindle.isOn; });
    const double velocity = std::abs(status.trajectory.current_velocity);
    const bool cutting = feeding && turning && velocity > 0 && status.tool.in_spindle > 0;
    return cutting ? tools::CutLife{elapsed_s, velocity * elapsed_s} : tools::CutLife{};
}

/// Modal codes of the current move, which comes from `source`; without a run those of the interpreter.
/// `executed`: it is the block to which an abort would return, not an earlier one of a reverse run.
gcode::ActiveCodes codes_in_force(const ProgramReader &reader, const ProgramRun &run,
                                  const motion::SourceTag &source, bool executed) {
    const ModalCodeHistory &trail = reader.codes();
    const bool read_ahead = run.isRunning() && run.phase() != RunPhase::SEARCHING &&
                            run.phase() != RunPhase::STARTING && !trail.isEmpty();
    const int line = run.isProgram() ? source.line : 0;
    if (read_ahead && executed && reader.gcode() != nullptr) {
        return numbered(reader.executed_codes(), line);
    }
    if (read_ahead) {
        return trail.at(source.block, line);
    }
    // An MDI line has no number, nor has the start-up code.
    const gcode::ActiveCodes read = reader.interpreter().active_codes();
    return numbered(read, run.kind() != RunKind::MDI && !trail.isEmpty() ? read.g[0] : 0);
}

CodesStatus shown(const gcode::ActiveCodes &codes) {
    return {codes.g, codes.m, codes.settings};
}

}  // namespace

void Task::Show::tools() {
    task.parts_.tools.step();
    while (const auto warning = task.parts_.tools.take_warning()) {
        task.post(MessageKind::OPERATOR_ERROR, *warning);
    }
    const auto read = task.reload_command_ != 0 ? task.parts_.tools.reload_result() : std::nullopt;
    if (read.has_value()) {
        const std::string reason = read->has_value() ? std::string() : read->error().str();
        task.desk_.tell(std::exchange(task.reload_command_, 0),
                        reason.empty() ? Progress::DONE : Progress::FAILED, reason);
        if (!reason.empty()) {
            task.post(MessageKind::OPERATOR_ERROR, reason);
        }
    }
    task.parts_.tools.note_cut(task.status_.tool.in_spindle, cut_since(task.status_, task.now_ns_));
    const auto table = task.tools_.step(task.parts_.tools);
    if (table.has_value() && !task.desk_.publish_tools(*table)) {
        task.post(MessageKind::OPERATOR_ERROR, "the tool table is too large to be shown to clients");
    }
}

void Task::Show::states() {
    TaskStatus &shown_task = task.status_.task;
    shown_task.state = task.state_.state();
    shown_task.mode = task.mode_.mode();
    shown_task.isOptionalStop = task.world_.isOptionalStopOn();
    shown_task.isBlockDelete = task.world_.isBlockDeleteOn();
    shown_task.isPaused = task.run_.isHeld();
    shown_task.isStoppedByProgram = task.run_.hold() == Hold::STOPPED;
    shown_task.interp_state = task.run_.shown();
    shown_task.isAway = task.run_.hold() == Hold::AWAY;
    shown_task.queued_mdi = task.mdi_queue_.size();
    constexpr int INTERPRETER_ERROR = 5;  // LinuxCNC's number
    shown_task.error_code = task.run_.error() != nullptr ? INTERPRETER_ERROR : 0;
    task.status_.settings = task.shown_settings_.shown();
    task.status_.io.coolant.isMistOn = task.io_.outputs.coolant_mist;
    task.status_.io.coolant.isFloodOn = task.io_.outputs.coolant_flood;
    task.status_.tool.isPersonAsked = task.parts_.io_port.isPersonAsked();
    task.status_.io.aux = {task.io_.isEstopRequested(), task.io_.isChainClosed()};
    task.status_.tool.isFaulted = task.io_.outputs.toolchanger_faulted;
    if (task.status_.io.lube.hasOil && !task.io_.hasOil()) {
        task.post(MessageKind::OPERATOR_ERROR,
                  "lubricant level is low: pin iocontrol.0.lube_level is FALSE. Refill the lubricant");
    }
    task.status_.io.lube = {task.io_.outputs.lube, task.io_.hasOil()};
}

void Task::Show::sequencer() {
    TaskStatus &shown_task = task.status_.task;
    shown_task.exec_state = task.run_.isRunning() ? task.sequencer_.exec_state() : ExecState::DONE;
    shown_task.waiting = task.homing_.isUnderWay() ? Waiting{WaitFor::HOMING, task.homing_.joint()}
                                                   : task.sequencer_.waiting_for();
    shown_task.delay_left_s = task.sequencer_.dwell_left_s(task.now_ns_);
    shown_task.isInputTimedOut = task.sequencer_.input().timed_out;
    shown_task.motion_line = task.sequencer_.sent().line();
}

void Task::Show::program() {
    TaskStatus &shown_task = task.status_.task;
    shown_task.blocks = task.reader_.canon().blocks();
    if (task.run_.isRunning()) {
        shown_task.read_line = task.reader_.interpreter().line();
        shown_task.call_level = task.reader_.interpreter().call_level();
    }
    shown_task.block.assign(task.reader_.canon().block_text());
    if (!task.run_.isRunning()) {
        show_announced(task.reader_.canon(), task.status_.offsets);
    }
    const motion::Status &motion = task.motion_.status();
    const bool moving = motion.active_path_id != 0;
    const motion::SourceTag under_way = task.sequencer_.place().source;
    const bool executed = !moving || motion.source.block == under_way.block;
    task.status_.codes =
        shown(codes_in_force(task.reader_, task.run_, moving ? motion.source : under_way, executed));
    task.approach_.show(task.status_.approach, task.status_.offsets,
                        shown(task.reader_.interpreter().active_codes()));
}

void Task::Show::publish() {
    ++task.status_.cycle;
    task.status_.time_ns = task.now_ns_;
    const PartMask told = tell_motion(task.motion_.status(), task.motion_.fresh_parts(),
                                      task.settings_.axis_mask, task.status_);
    task.desk_.publish(task.status_, told);
}

void Task::Show::all() {
    states();
    sequencer();
    program();
    tools();
    // A tool that is being prepared is not ready yet; no tool (T0) is ready at once.
    const int selected = task.sequencer_.selected_tool_index();
    const bool none = selected == 0 && !task.parts_.tools.isRandom();
    const bool ready = none || task.io_.action() != io::ToolAction::PREPARING;
    task.status_.tool.in_spindle = task.io_.outputs.tool_number;
    task.status_.tool.from_pocket = task.io_.outputs.tool_from_pocket;
    task.status_.tool.prepared_index = ready ? selected : task.status_.tool.prepared_index;
    task.status_.tool.table_version = task.tools_.version();
    const tools::CutLife life = task.parts_.tools.life(task.io_.outputs.tool_number);
    task.status_.tool.cut_time_s = life.time_s;
    task.status_.tool.cut_length = life.length;
    ProgramResume{task}.show_journal();
    publish();
    ProgramResume{task}.note_place();
}

}  // namespace mw::task
