// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/status_writer.hh"

#include "machine/task/control/run_journal.hh"
#include "machine/task/link/motion_status.hh"

namespace mw::task {
namespace {

/// Modal codes of the current move, which comes from `source`; without a run those of the interpreter.
/// `executed`: the move belongs to the block to which an abort would return, not to an earlier block of a
/// reverse run.
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
    // MDI lines and the start-up code have no number.
    const gcode::ActiveCodes read = reader.interpreter().active_codes();
    return numbered(read, run.kind() != RunKind::MDI && !trail.isEmpty() ? read.g[0] : 0);
}

CodesStatus shown(const gcode::ActiveCodes &codes) {
    return {codes.g, codes.m, codes.settings};
}

}  // namespace

void StatusWriter::write_states() {
    const ProgramRun &run = run_.run;
    TaskStatus &task = status_.task;
    task.state = parts_.modes.state();
    task.mode = parts_.modes.mode();
    task.isOptionalStop = run_.world.isOptionalStopOn();
    task.isBlockDelete = run_.world.isBlockDeleteOn();
    task.program = run.program();
    task.isPaused = run.isHeld();
    task.isStoppedByProgram = run.hold() == Hold::STOPPED;
    task.interp_state = run.shown();
    task.isAway = run.hold() == Hold::AWAY;
    task.queued_mdi = run_.mdi.size();
    task.stop_line = run_.actions.stops().line;
    task.stops = run_.actions.stops().count;
    task.programs_ended = parts_.end.programs_ended();
    constexpr int INTERPRETER_ERROR = 5;  // LinuxCNC's number
    task.error_code = run.error() != nullptr ? INTERPRETER_ERROR : 0;
    status_.offsets = run_.actions.offsets();
    status_.settings = parts_.settings.shown();
}

void StatusWriter::write_devices() {
    const io::DiscreteIo &io = run_.io;
    status_.io.coolant.isMistOn = io.outputs.coolant_mist;
    status_.io.coolant.isFloodOn = io.outputs.coolant_flood;
    status_.tool.isPersonAsked = parts_.io_pins.isPersonAsked();
    status_.io.aux = {io.isEstopRequested(), io.isChainClosed()};
    status_.tool.isFaulted = io.outputs.toolchanger_faulted;
    if (status_.io.lube.hasOil && !io.hasOil()) {
        run_.port.post_error(
            "lubricant level is low: pin iocontrol.0.lube_level is FALSE. Refill the lubricant");
    }
    status_.io.lube = {io.outputs.lube, io.hasOil()};
}

void StatusWriter::write_sequencer() {
    const Sequencer &sequencer = run_.sequencer;
    TaskStatus &task = status_.task;
    task.exec_state = run_.run.isRunning() ? sequencer.exec_state() : ExecState::DONE;
    task.waiting = parts_.manual.isHoming() ? Waiting{WaitFor::HOMING, parts_.manual.homed_joint()}
                                            : sequencer.waiting_for();
    task.delay_left_s = sequencer.dwell_left_s(run_.port.now_ns());
    task.isInputTimedOut = sequencer.input().timed_out;
    task.motion_line = run_.sequencer.sent().line();
}

void StatusWriter::write_program() {
    const ProgramReader &reader = run_.reader;
    TaskStatus &task = status_.task;
    task.blocks = reader.canon().blocks();
    if (run_.run.isRunning()) {
        task.read_line = reader.interpreter().line();
        task.call_level = reader.interpreter().call_level();
    }
    task.block.assign(reader.canon().block_text());
    const motion::Status &motion = run_.port.motion();
    const bool moving = motion.active_path_id != 0;
    const motion::SourceTag under_way = run_.sequencer.place().source;
    const bool executed = !moving || motion.source.block == under_way.block;
    status_.codes = shown(codes_in_force(reader, run_.run, moving ? motion.source : under_way, executed));
    parts_.resume.approach().show(status_.approach, status_.offsets,
                                  shown(reader.interpreter().active_codes()));
}

void StatusWriter::publish() {
    ++status_.cycle;
    status_.time_ns = run_.port.now_ns();
    const PartMask told =
        tell_motion(run_.port.motion(), run_.port.link().fresh_parts(), run_.settings.axis_mask, status_);
    run_.port.server().publish(status_, told);
}

void StatusWriter::write() {
    write_states();
    write_devices();
    write_sequencer();
    write_program();
    parts_.tools.step(status_);
    parts_.tools.show(status_.tool);
    show_journal(run_, status_.recovery);
    publish();
    journal_place(run_);
}

void StatusWriter::write_during_call() {
    write_states();
    write_devices();
    write_sequencer();
    if (run_.calls.isStopped()) {  // the run has ended, although its call has not ended yet
        status_.task.interp_state = InterpState::IDLE;
        status_.task.exec_state = ExecState::DONE;
        status_.task.isPaused = status_.task.isStoppedByProgram = false;
        status_.task.waiting = {};
    }
    publish();
}

}  // namespace mw::task
