// SPDX-License-Identifier: GPL-2.0-or-later
// What task tells at the end of its cycle.
#include <algorithm>
#include <cmath>

#include "task/link/motion_status.hh"
#include "task/run/shown_offsets.hh"
#include "task/task_start.hh"

namespace mw::task {
namespace {

/// What the tool in the spindle has cut since that status: the axes fed while a spindle turned.
tool::CutLife cut_since(const Status &status, std::int64_t now_ns) {
    constexpr double S_PER_NS = 1e-9;
    const double elapsed_s = static_cast<double>(now_ns - status.time_ns) * S_PER_NS;
    const MoveKind kind = status.trajectory.move_kind;
    const bool isFeeding = kind == MoveKind::FEED || kind == MoveKind::ARC;
    const bool isTurning =
        std::ranges::any_of(status.spindles, [](const SpindleStatus &spindle) { return spindle.isOn; });
    const double velocity = std::abs(status.trajectory.current_velocity);
    const bool isCutting = isFeeding && isTurning && velocity > 0 && status.tool.in_spindle > 0;
    return isCutting ? tool::CutLife{elapsed_s, velocity * elapsed_s} : tool::CutLife{};
}

/// Modal codes of the move that runs, which comes from `source`; where nothing runs, those of the
/// interpreter. `isExecuted`: it is the block that an abort would return to, and no earlier one on a path run
/// in reverse.
interp::ActiveCodes codes_in_force(const ProgramReader &reader, const ProgramRun &run,
                                   const motion::SourceTag &source, bool isExecuted) {
    const CodesTrail &trail = reader.codes();
    const bool isReadAhead = run.isRunning() && run.phase() != RunPhase::SEARCHING &&
                             run.phase() != RunPhase::STARTING && !trail.isEmpty();
    const int line = run.isProgram() ? source.line : 0;
    if (isReadAhead && isExecuted && reader.gcode() != nullptr) {
        return numbered(reader.executed_codes(), line);
    }
    if (isReadAhead) {
        return trail.at(source.block, line);
    }
    // A line of MDI has no number, nor has the start-up code.
    const interp::ActiveCodes read = reader.interpreter().active_codes();
    return numbered(read, run.kind() != RunKind::MDI && !trail.isEmpty() ? read.g[0] : 0);
}

CodesStatus shown(const interp::ActiveCodes &codes) {
    return {codes.g, codes.m, codes.settings};
}

}  // namespace

void Task::step_tools() {
    parts_.tools.step();
    while (const auto warning = parts_.tools.take_warning()) {
        post(MessageKind::OPERATOR_ERROR, *warning);
    }
    const auto read = reload_command_ != 0 ? parts_.tools.reload_result() : std::nullopt;
    if (read.has_value()) {
        const std::string reason = read->has_value() ? std::string() : read->error().str();
        desk_.tell(std::exchange(reload_command_, 0), reason.empty() ? Progress::DONE : Progress::FAILED,
                   reason);
        if (!reason.empty()) {
            post(MessageKind::OPERATOR_ERROR, reason);
        }
    }
    parts_.tools.note_cut(status_.tool.in_spindle, cut_since(status_, now_ns_));
    const auto table = tools_.step(parts_.tools);
    if (table.has_value() && !desk_.publish_tools(*table)) {
        post(MessageKind::OPERATOR_ERROR, "the tool table is too large to be shown to clients");
    }
}

void Task::update_status() {
    TaskStatus &task = status_.task;
    task.state = state_.state();
    task.mode = mode_.mode();
    task.isOptionalStop = world_.isOptionalStopOn();
    task.isBlockDelete = world_.isBlockDeleteOn();
    task.blocks = reader_.canon().blocks();
    task.isPaused = run_.isHeld();
    task.isStoppedByProgram = run_.hold() == Hold::STOPPED;
    task.interp_state = run_.shown();
    task.exec_state = run_.isRunning() ? sequencer_.exec_state() : ExecState::DONE;
    task.isAway = run_.hold() == Hold::AWAY;
    task.queued_mdi = mdi_queue_.size();
    if (run_.isRunning()) {
        task.read_line = reader_.interpreter().line();
        task.call_level = reader_.interpreter().call_level();
    }
    task.waiting =
        homing_.isUnderWay() ? Waiting{WaitFor::HOMING, homing_.joint()} : sequencer_.waiting_for();
    task.delay_left_s = sequencer_.dwell_left_s(now_ns_);
    task.isInputTimedOut = sequencer_.input().isTimedOut;
    constexpr int INTERPRETER_ERROR = 5;  // as clients know it
    task.error_code = run_.error() != nullptr ? INTERPRETER_ERROR : 0;
    task.block.assign(reader_.canon().block_text());
    status_.settings = shown_settings_.shown();
    if (!run_.isRunning()) {
        show_announced(reader_.canon(), status_.offsets);
    }
    const motion::Status &motion = motion_.status();
    const bool isMoving = motion.active_path_id != 0;
    const motion::SourceTag under_way = sequencer_.place().source;
    task.motion_line = sequencer_.sent().line();
    const bool isExecuted = !isMoving || motion.source.block == under_way.block;
    status_.codes = shown(codes_in_force(reader_, run_, isMoving ? motion.source : under_way, isExecuted));
    approach_.show(status_.approach, status_.offsets, shown(reader_.interpreter().active_codes()));
    step_tools();
    // A tool that is being looked for is not ready yet; no tool (T0) is ready at once.
    const int selected = sequencer_.selected_tool_index();
    const bool isNone = selected == 0 && !parts_.tools.isRandom();
    const bool isReady = isNone || io_.action() != io::ToolAction::PREPARING;
    status_.tool = {io_.outputs.tool_number, io_.outputs.tool_from_pocket,
                    isReady ? selected : status_.tool.prepared_index, tools_.version()};
    const tool::CutLife life = parts_.tools.life(io_.outputs.tool_number);
    status_.tool.cut_time_s = life.time_s;
    status_.tool.cut_length = life.length;
    status_.io.coolant.isMistOn = io_.outputs.coolant_mist;
    status_.io.coolant.isFloodOn = io_.outputs.coolant_flood;
    status_.tool.isPersonAsked = parts_.io_port.isPersonAsked();
    status_.io.aux = {io_.isEstopRequested(), io_.isChainClosed()};
    status_.tool.isFaulted = io_.outputs.toolchanger_faulted;
    if (status_.io.lube.hasOil && !io_.hasOil()) {
        post(MessageKind::OPERATOR_ERROR, "the lubrication wants oil: pin iocontrol.0.lube_level is FALSE");
    }
    status_.io.lube = {io_.outputs.lube, io_.hasOil()};
    Start{*this}.show_journal();
    ++status_.cycle;
    status_.time_ns = now_ns_;
    const PartMask told = tell_motion(motion_.status(), motion_.fresh_parts(), settings_.axis_mask, status_);
    desk_.publish(status_, told);
    Start{*this}.note_place();
}

}  // namespace mw::task
