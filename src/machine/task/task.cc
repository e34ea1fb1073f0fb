// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/task.hh"

#include <algorithm>

#include <fmt/format.h>

#include "gcode/interpreter/scripts/user_codes.hh"
#include "machine/task/program_resume.hh"
#include "machine/task/run/shown_offsets.hh"
#include "machine/task/task_apart.hh"
#include "machine/task/task_show.hh"
#include "motion/interface/texts.hh"

namespace mw::task {

Task::Task(const Parts &parts, Settings settings)
    : settings_(std::move(settings)), parts_(parts), desk_(parts.mailbox), motion_(parts.channels),
      io_(settings_.changer_protocol), senders_(settings_.confinement),
      mdi_queue_(settings_.mdi_queued_commands),
      world_({settings_.machine_units, settings_.axis_mask, settings_.num_spindles}),
      reader_({world_, parts.tools, parts.parameters},
              {settings_.machine_units, settings_.tool_change_place, settings_.parameter_file,
               settings_.sequencer.tool_change_with_spindle_on, settings_.interpreter_plugin,
               settings_.interpreter}),
      parameter_file_(settings_.parameter_file, reader_, parts.journal), recovery_(parts.journal),
      on_abort_(settings_.interpreter_plugin.empty() ? settings_.interpreter.on_abort_command
                                                     : std::string()),
      user_program_(settings_.user_program_awaited ? UserProgram::Waits::IN_CALL : UserProgram::Waits::NEVER),
      sequencer_(reader_.queue(), motion_, io_, parts.tools, make_events(), settings_.sequencer),
      planner_mode_({[this](const motion::SetParameter &p) { return motion_.send(p); },
                     [this](MessageKind kind, const std::string &text) { post(kind, text); }}),
      shown_settings_(settings_.shown) {}

SequencerEvents Task::make_events() {
    SequencerEvents events;
    events.message = [this](MessageKind kind, const std::string &text) { post(kind, text); };
    events.print = [this](const std::string &text) { post(MessageKind::OPERATOR_TEXT, text); };
    events.stop = [this](const gcode::ProgramStop &stop, int line) { return on_stop(stop, line); };
    events.end = [this] { run_.change(RunEvent::READ); };
    events.fail = [this](const std::string &text) { run_.note_failure(text); };
    events.offsets = [this](const gcode::UseOffsets &item) { show(item, status_.offsets); };
    events.tool_offset = [this](const gcode::UseToolOffset &item) {
        status_.offsets.tool = item.offset;
        io_.set_tool_offset(item.offset);
        return motion_.send(motion::SetToolOffset{item.offset});
    };
    events.planner_mode = [this](const gcode::UsePlanner &item) -> std::optional<motion::CommandId> {
        const int smooth = settings_.sequencer.smooth_planner;
        if (item.isSmooth && smooth == 0) {
            run_.note_failure("G64 R above 0 needs the jerk-limited planner, which [TRAJ]SMOOTH_PLANNER = "
                              "0 does not allow; use G64 R0 or no R");
            return std::nullopt;
        }
        return planner_mode_.set(item.isSmooth ? smooth : 0);
    };
    events.confinement = [this] { return senders_.confinement(); };
    events.start_user_code = [this](const gcode::UserCode &item) {
        const std::string name = fmt::format("M{}", item.code);
        const auto find = [folders = settings_.interpreter.user_m_path,
                           code = item.code]() -> Result<std::string> {
            const std::string path = gcode::find_user_program(folders, code);
            return path.empty()
                       ? Result<std::string>(fail(fmt::format("M{}: its program no longer exists", code)))
                       : path;
        };
        user_program_.start(name, find, item.p, item.q);
    };
    events.user_code_result = [this]() -> std::optional<Result<>> {
        if (user_program_.isRunning()) {
            return std::nullopt;
        }
        return user_program_.take_result();
    };
    return events;
}

void Task::configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables) {
    for (const auto &table : tables) {
        motion_.send_table(table);
    }
    planner_mode_.configure(parameters);
    for (const motion::SetParameter &parameter : parameters) {
        shown_settings_.note(parameter);
        sent_settings_.last = motion_.send(parameter);
    }
    motion_.send(motion::SetNumJoints{settings_.num_joints});
    sent_settings_.last = motion_.send(motion::SetWatchdog{true, settings_.watchdog_s});
}

Result<bool> Task::isConfigured() const {
    const bool answered = motion_.isAnswered(sent_settings_.last) && motion_.areTablesAnswered();
    if (answered && !sent_settings_.refused.empty()) {
        return fail("a setting was rejected: " + sent_settings_.refused);
    }
    return answered;
}

Result<> Task::start() {
    motion_.update();
    const auto loaded = reader_.load();
    if (!loaded.has_value()) {
        return loaded;
    }
    parameter_file_.note_loaded();
    show_first_tool(parts_.tools, io_);
    synch_interpreter();
    planner_mode_.announce();
    if (const std::string offer = recovery_.find(); !offer.empty()) {
        post(MessageKind::OPERATOR_TEXT, offer);
    }
    Result<> begun = reader_.interpreter().begin();
    reader_.begin_history();
    for (const std::string &warning : reader_.interpreter().warnings()) {
        post(MessageKind::OPERATOR_TEXT, warning);
    }
    return begun;
}

Result<> Task::save_parameters() {
    if (apart_.isOn) {
        return fail("the numbered parameters are not saved: the interpreter is still busy");
    }
    return parameter_file_.save();
}

void Task::synch_interpreter() {
    gcode::MachineSnapshot machine = snapshot_of(motion_.status(), io_.outputs, sequencer_);
    machine.position = reader_.canon().exact(machine.position);
    machine.probed_position = machine.isProbeTripped ? machine.probed_position : machine.position;
    world_.show(machine);
    reader_.synch(machine.position);
}

void Task::step(std::int64_t now_ns) {
    now_ns_ = now_ns;
    static_cast<void>(Meanwhile{*this}.end());
    take_motion_news();
    sequencer_.sent().follow(motion_.status());
    if (const auto failure = sequencer_.logs().take_failure()) {
        run_.isRunning() ? run_.note_failure(failure->str())
                         : post(MessageKind::OPERATOR_ERROR, failure->str());
    }
    for (const auto &delay :
         {sequencer_.logs().take_delay(), user_program_.take_delay(now_ns), recovery_.take_delay(now_ns)}) {
        if (delay.has_value()) {
            post(MessageKind::OPERATOR_ERROR, *delay);
        }
    }
    sequencer_.on_tool_event(io_.step(parts_.io_port.read()));
    ProgramResume{*this}.watch_hold();  // a loaded tool is known before a command continues with it
    update_state();
    carry_out_commands();
    end_requests();
    if (const auto failure = run_.take_failure()) {
        fail_program({diagnostics::Severity::ERROR, {*failure}}, AbortReason::EXECUTION_ERROR);
    }
    check_run_mode();
    step_clean_up();
    step_run();
    ProgramResume{*this}.watch_hold();
    // Calls that wait in the queue without a run are settings for displays; they move nothing.
    planner_mode_.step(!run_.isRunning() && motion_.isPathComplete());
    if (run_.phase() == RunPhase::IDLE && motion_.status().isInPosition) {
        io_.set_tool_offset(reader_.canon().tool_offset().value_or(io_.outputs.tool_offset));
    }
    parts_.io_port.write(io_.outputs);
    Show{*this}.all();
}

void Task::step_run() {
    if (!run_.isRunning() || motion_.status().mode != motion::Mode::COORD) {
        return;
    }
    run_interpreter();
    if (!run_.isHeld()) {
        sequencer_.step(now_ns_);
    }
    reader_.follow(sequencer_);
    // The step that executes the last block ends the program: there is no block left to pause before.
    const bool executed = run_.phase() == RunPhase::FINISHING && sequencer_.isIdle();
    const bool is_written = sequencer_.logs().isSettled() && parts_.tools.isSettled();
    if (executed && is_written && !run_.isHeld() && !run_.hasFailed()) {
        finish_run(Progress::DONE, {});
    } else if (run_.hold() == Hold::STEPPING && sequencer_.isStepDone() && (is_written || !executed)) {
        run_.change(RunEvent::STEP_DONE);
    }
    while (!run_.isRunning()) {  // MDI lines follow at once: nothing comes between them
        const auto line = mdi_queue_.next();
        if (!line.has_value()) {
            break;
        }
        carry_out({line->command, 0, line->tap ? Command(*line->tap) : Command(Mdi{line->text}), false,
                   line->authority, 0});
    }
}

/// Ends a run that motion does not accept.
void Task::check_run_mode() {
    const bool is_out =
        run_.isRunning() && run_.hold() != Hold::AWAY && motion_.status().mode != motion::Mode::COORD;
    if (mode_.run_watch().step(is_out, now_ns_)) {
        fail_program(
            {diagnostics::Severity::ERROR, {"motion is not in coordinated mode: set the mode again"}},
            AbortReason::EXECUTION_ERROR);
    }
}

SourcePlace Task::place_of(const motion::SourceTag &source) const {
    const bool in_file = run_.isProgram() && source.line > 0;
    return in_file ? SourcePlace{file_name(source.file_index), source.line, 1} : SourcePlace{};
}

void Task::take_motion_news() {
    const MotionLink::News news = motion_.update();
    if (motion_.watch().step(motion_.status().cycle, now_ns_)) {
        post(MessageKind::OPERATOR_ERROR, "motion (millwright-rt) has not responded for 0.25 s: stops are "
                                          "not executed. Use the emergency stop switch of the machine");
    }
    const auto fail_or_post = [this](bool of_run, const std::string &text, const motion::SourceTag &source,
                                     AbortReason reason) {
        if (of_run && run_.isRunning() && apart_.isOn) {
            post(MessageKind::OPERATOR_ERROR, text);
            Meanwhile{*this}.stop_work(text, reason);
        } else if (of_run && run_.isRunning()) {
            fail_program({diagnostics::Severity::ERROR, {text, place_of(source), {}}, {}, {}}, reason);
        } else {
            post(MessageKind::OPERATOR_ERROR, text);
        }
    };
    for (const motion::Fault &fault : news.faults) {
        motion::Fault told = fault;
        told.source.line = run_.isProgram() ? fault.source.line : 0;  // a line of MDI has no number
        fail_or_post(!motion::isOnlyTold(fault.kind), motion::fault_text(told), fault.source,
                     AbortReason::MOTION_FAULT);
    }
    for (const auto &[answer, source, is_table] : news.refused) {
        if (sent_settings_.refused.empty() && !answer.isPath &&
            (is_table || answer.id <= sent_settings_.last)) {
            sent_settings_.refused = motion::reason_text(answer);
        }
        if (answer.reason == motion::Reason::MOVING && mode_.waits_for_rest(answer.id, now_ns_)) {
            continue;
        }
        const std::string text = motion::reason_text(answer);
        if (answer.reason != motion::Reason::MOVING && mode_.isForJointsToo(answer.id)) {
            mode_.fall_back(motion_.send(motion::SetMode{motion::Mode::FREE}));
            post(MessageKind::OPERATOR_TEXT, text);
            continue;
        }
        const auto order = orders_.refuse(answer.id, text);
        if (order.has_value()) {
            tell(order->ending);
        }
        if (!order.has_value() || order->reader == RefusalIsFor::EVERYBODY) {
            fail_or_post(answer.isPath, text, source, AbortReason::EXECUTION_ERROR);
        }
        tell(state_.refuse(answer.id, text));
        tell(mode_.refuse(answer.id, text));
        if (const auto refused = homing_.refuse(answer.id, text)) {
            tell(refused);
            desk_.refuse(homing_.drop(), "the joint before it was not homed");
        }
    }
}

void Task::update_state() {
    const MachineState::News news =
        state_.step({io_.isChainClosed(), io_.isEstopRequested(), motion_.status().isEnabled});
    tell(news.ended);
    switch (news.event) {
    case MachineState::Event::NONE: break;
    case MachineState::Event::CHAIN_OPENED:
        io_.enter_estop();
        motion_.send(motion::Disable{});
        Meanwhile{*this}.stop_work("the e-stop chain opened", AbortReason::ESTOP_CHAIN);
        post(MessageKind::OPERATOR_ERROR, "emergency stop: pin iocontrol.0.emc-enable-in is FALSE");
        break;
    case MachineState::Event::ESTOP_RESET:
        if (apart_.isOn) {
            apart_.later.emplace_back([this] { begin_clean_up(AbortReason::STATE_ESTOP_RESET); });
        } else {
            begin_clean_up(AbortReason::STATE_ESTOP_RESET);
        }
        break;
    case MachineState::Event::WENT_OFF:
        Meanwhile{*this}.stop_work("the machine was switched off", AbortReason::STATE_NOT_ON);
        break;
    }
}

void Task::step_homing() {
    const auto ended = homing_.step(motion_.isAnswered(homing_.order()), motion_.status());
    tell(ended);
    const bool failed = ended.has_value() && ended->progress != Progress::DONE;
    if (failed || state_.state() != State::ON || mode_.mode() != Mode::MANUAL) {
        desk_.refuse(homing_.drop(),
                     "the joint before it was not homed, or the machine is no longer in manual mode");
    }
    if (const auto turn = homing_.take_turn()) {
        homing_.begin(turn->joint, turn->command, motion_.send(motion::Home{turn->joint}));
    } else if (ended.has_value() && mode_.mode() == Mode::MANUAL && !mode_.isChanging() &&
               motion_.status().isAllHomed) {
        motion_.send(motion::SetMode{motion::Mode::TELEOP});  // axes can be jogged from now on
    }
}

void Task::end_requests() {
    tell(state_.end_request(now_ns_));
    const motion::Status &motion = motion_.status();
    mode_.watch_rest(!motion.isInPosition && !motion_.watch().isSilent(), now_ns_);
    if (mode_.isWaitingForRest() && motion.isInPosition) {
        mode_.ask_again(motion_.send(motion::SetMode{mode_.wanted_motion_mode()}), now_ns_);
    }
    tell(mode_.step(motion_.isAnswered(mode_.order()), motion.mode, now_ns_));
    if (!run_.isRunning()) {
        mode_.follow(motion.mode);
    }
    step_homing();
    const auto answered = [this](motion::CommandId order) { return motion_.isAnswered(order); };
    while (const auto ended = orders_.next(answered, now_ns_)) {
        if (ended->progress == Progress::FAILED) {
            post(MessageKind::OPERATOR_ERROR, ended->reason);  // Python clients do not receive the reason
        }
        tell(ended);
    }
}

/// After an abort motion may still brake: a run begins at standstill.
bool Task::begin_run() {
    if (!motion_.status().isInPosition) {
        return false;
    }
    if (run_.from_line() > 1 || run_.isRecovery()) {
        run_.isRecovery() ? ProgramResume{*this}.begin_recovery() : ProgramResume{*this}.begin();
        return true;
    }
    run_.change(RunEvent::BEGUN);
    synch_interpreter();
    reader_.note_codes();
    ProgramResume{*this}.prepare_journal();
    ProgramResume{*this}.begin_journal(1);
    if (const auto tap = mdi_queue_.take_tap()) {
        reader_.canon().begin_read();
        reader_.canon().begin_block({});
        reader_.canon().take(*tap);
        run_.change(RunEvent::READ);
    } else if (run_.kind() == RunKind::MDI) {
        const gcode::Step result = reader_.execute(run_.line());
        if (!Meanwhile{*this}.end_step(result)) {
            on_step_result(result);
        }
    }
    return true;
}

void Task::run_interpreter() {
    if (gcode::Interpreter *const gcode = reader_.gcode(); gcode != nullptr) {
        gcode->limits().confined = senders_.isRunConfined();
    }
    if (run_.phase() == RunPhase::STARTING && !begin_run()) {
        return;
    }
    if (run_.phase() == RunPhase::SEARCHING) {
        ProgramResume{*this}.step();
        return;
    }
    world_.show(snapshot_of(motion_.status(), io_.outputs, sequencer_));
    const auto mayRead = [this] {
        return run_.isRunning() && run_.phase() != RunPhase::FINISHING && run_.hold() != Hold::STOPPED &&
               reader_.queue().size() < settings_.read_ahead_items &&
               reader_.count_ahead() < settings_.read_ahead_steps;
    };
    for (int i = 0; i < settings_.blocks_per_cycle && mayRead(); ++i) {
        if (run_.phase() == RunPhase::SYNCHING) {
            if (!sequencer_.isIdle()) {
                return;
            }
            run_.change(RunEvent::SYNCED);
            synch_interpreter();
            if (!run_.isProgram()) {  // values set by a program are saved at its end
                parameter_file_.keep();
            }
            const std::string probe = sequencer_.take_probe() ? reader_.probe_line() : "";
            if (!probe.empty()) {
                sequencer_.logs().write_probe(probe);
            }
        }
        const gcode::Step result = reader_.step();
        if (Meanwhile{*this}.end_step(result)) {
            return;
        }
        ProgramResume{*this}.note_doubt();
        on_step_result(result);
    }
}

void Task::on_step_result(gcode::Step result) {
    switch (result) {
    case gcode::Step::OK: break;
    case gcode::Step::SYNC: run_.change(RunEvent::SYNC); break;
    case gcode::Step::PROGRAM_END:
    case gcode::Step::FILE_END: run_.change(RunEvent::READ); break;
    case gcode::Step::FAILED:
        fail_program(reader_.interpreter().error(), run_.kind() == RunKind::MDI
                                                        ? AbortReason::INTERPRETER_ERROR_MDI
                                                        : AbortReason::INTERPRETER_ERROR);
        break;
    }
}

bool Task::on_stop(const gcode::ProgramStop &stop, int line) {
    // After the last block of an MDI line there is nothing to pause.
    const bool is_last =
        run_.kind() == RunKind::MDI && run_.phase() == RunPhase::FINISHING && reader_.queue().size() <= 1;
    if (is_last || (stop.optional && !world_.isOptionalStopOn())) {
        return false;
    }
    status_.task.stop_line = line;
    ++status_.task.stops;
    run_.change(RunEvent::PROGRAM_STOP);
    return true;
}

void Task::finish_run(Progress progress, const std::string &reason) {
    if (progress == Progress::FAILED) {
        reader_.follow(sequencer_);
        reader_.return_to_executed();
    }
    if (run_.isProgram()) {
        reader_.interpreter().close();
        ++status_.task.programs_ended;
    } else if (run_.isRunning() && progress == Progress::DONE && reader_.interpreter().isMoveHeld()) {
        post(MessageKind::OPERATOR_TEXT,
             "cutter compensation delays this move until the next move or G40 sets its end");
    }
    parameter_file_.keep();  // a touch-off must survive a crash
    sequencer_.set_stepping(false);
    recovery_.end();
    tell(run_.end(progress, reason));
}

void Task::tell(const std::optional<Ending> &ending) {
    if (ending.has_value()) {
        desk_.tell(ending->command, ending->progress, ending->reason);
    }
}

}  // namespace mw::task
