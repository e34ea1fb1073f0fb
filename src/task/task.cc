// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/task.hh"

#include <fmt/format.h>

#include "interp/plugin.hh"
#include "interp/user_codes.hh"
#include "motion/api/texts.hh"
#include "task/motion_status.hh"

namespace mw::task {
namespace {

/// A machine runs its programs: #<_task>, self.task of scripts, and M99 in the main program begins it again.
Settings for_machine(Settings settings) {
    settings.interpreter.isTask = true;
    return settings;
}

}  // namespace

Task::Task(const Parts &parts, Settings settings)
    : settings_(for_machine(std::move(settings))), parts_(parts), desk_(parts.mailbox),
      motion_(parts.channels), canon_(queue_, settings_.tool_change_place),
      frame_(canon_, settings_.machine_units),
      interp_(std::make_unique<interp::Interpreter>(frame_, *this, parts.tools, parts.parameters,
                                                    settings_.interpreter)),
      user_program_(settings_.isClockHeldByUserPrograms),
      sequencer_(queue_, motion_, io_, parts.tools, make_events(), settings_.sequencer),
      planner_mode_({[this](const motion::SetParameter &p) { return motion_.send(p); },
                     [this](MessageKind kind, const std::string &text) { post(kind, text); }}) {}

Task::~Task() = default;

SequencerEvents Task::make_events() {
    SequencerEvents events;
    events.message = [this](MessageKind kind, const std::string &text) { post(kind, text); };
    events.print = [this](const std::string &text) { post(MessageKind::OPERATOR_TEXT, text); };
    events.stop = [this](const interp::ProgramStop &stop, int line) { return on_stop(stop, line); };
    events.end = [this] { change_run(RunEvent::READ); };
    events.fail = [this](const std::string &text) {
        pending_failure_ = pending_failure_.empty() ? text : pending_failure_;
    };
    events.offsets = [this](const interp::UseOffsets &item) {
        status_.offsets.g5x_index = item.g5x_index;
        status_.offsets.g5x = item.g5x;
        status_.offsets.g92 = item.g92;
        status_.offsets.rotation_xy_deg = item.rotation_xy_deg;
    };
    events.tool_offset = [this](const interp::UseToolOffset &item) {
        status_.offsets.tool = item.offset;
        return motion_.send(motion::SetToolOffset{item.offset});
    };
    events.planner_mode = [this](const interp::UsePlanner &item) -> std::optional<motion::CommandId> {
        const int smooth = settings_.sequencer.smooth_planner;
        if (item.isSmooth && smooth == 0) {
            pending_failure_ =
                "G64 R above 0 asks for the jerk-limited planner, which [TRAJ]SMOOTH_PLANNER = 0 "
                "does not allow; use G64 R0 or no R";
            return std::nullopt;
        }
        return planner_mode_.set(item.isSmooth ? smooth : 0);
    };
    events.start_user_code = [this](const interp::UserCode &item) -> Result<> {
        const std::string path = interp::find_user_program(settings_.interpreter, item.code);
        return path.empty() ? fail("M" + std::to_string(item.code) + ": its program is gone")
                            : user_program_.start(path, item.p, item.q);
    };
    events.user_code_result = [this]() -> std::optional<Result<>> {
        if (user_program_.isRunning()) {
            return std::nullopt;
        }
        return user_program_.take_result();
    };
    return events;
}

void Task::configure(const std::vector<motion::SetParameter> &parameters) {
    planner_mode_.configure(parameters);
    for (const motion::SetParameter &parameter : parameters) {
        last_setting_ = motion_.send(parameter);
    }
    last_setting_ = motion_.send(motion::SetWatchdog{true, settings_.watchdog_s});
}

Result<> Task::start() {
    motion_.update();
    if (!settings_.interpreter_plugin.empty()) {
        auto opened = interp::open_plugin(settings_.interpreter_plugin,
                                          {frame_, *this, parts_.tools, parts_.parameters});
        if (!opened) {
            opened.error().message = "[TASK]INTERPRETER: " + opened.error().message;
            return std::unexpected(opened.error());
        }
        interp_ = std::move(*opened);
    }
    if (!settings_.parameter_file.empty()) {
        const auto loaded = interp_->load_parameters(settings_.parameter_file);
        if (!loaded.has_value()) {
            return loaded;
        }
    }
    synch_interpreter();
    planner_mode_.announce();
    Result<> begun = interp_->begin();
    for (const std::string &warning : interp_->warnings()) {
        post(MessageKind::OPERATOR_TEXT, warning);
    }
    return begun;
}

void Task::synch_interpreter() {
    canon_.set_position(motion_.status().carte_pos_cmd);
    frame_.set_position(motion_.status().carte_pos_cmd);
    interp_->synch();
}

Result<> Task::save_parameters() const {
    return settings_.parameter_file.empty() ? Result<>{} : interp_->save_parameters(settings_.parameter_file);
}

void Task::step(std::int64_t now_ns) {
    now_ns_ = now_ns;
    take_motion_news();
    take_io();
    update_state();
    carry_out_commands();
    update_pending();
    if (!pending_failure_.empty()) {
        fail_program({diag::Severity::ERROR, {std::exchange(pending_failure_, {})}},
                     AbortReason::EXECUTION_ERROR);
    }
    check_run_mode();
    step_clean_up();
    if (isRunning() && motion_.status().mode == motion::Mode::COORD) {
        run_interpreter();
        if (!run_.isHeld()) {
            sequencer_.step(now_ns_);
        }
        if (run_.hold() == Hold::STEPPING && sequencer_.isStepDone()) {
            change_run(RunEvent::STEP_DONE);
        }
        if (run_.phase() == RunPhase::FINISHING && sequencer_.isIdle() && !run_.isHeld()) {
            finish_run(Progress::DONE, {});
        }
    }
    planner_mode_.step(!isRunning() && sequencer_.isIdle());
    parts_.io_port.write(io_.outputs);
    update_status();
}

/// A run goes on in coordinated mode only; one that motion does not let in ends.
void Task::check_run_mode() {
    constexpr std::int64_t LONGEST_NS = 1000000000;
    const bool isOut = isRunning() && motion_.status().mode != motion::Mode::COORD;
    out_of_mode_since_ns_ = !isOut ? -1 : out_of_mode_since_ns_ < 0 ? now_ns_ : out_of_mode_since_ns_;
    if (isOut && now_ns_ - out_of_mode_since_ns_ > LONGEST_NS) {
        fail_program({diag::Severity::ERROR, {"motion is not in coordinated mode: set the mode again"}},
                     AbortReason::EXECUTION_ERROR);
    }
}

SourcePlace Task::place_of(const motion::SourceTag &source) const {
    const std::string file = isRunning() && run_kind_ == RunKind::PROGRAM && source.line > 0
                                 ? canon_.file_name(source.file_index)
                                 : "";
    return {file, source.line, source.line > 0 ? 1 : 0};
}

void Task::take_motion_news() {
    const MotionLink::News news = motion_.update();
    for (const motion::Fault &fault : news.faults) {
        const std::string text = motion::fault_text(fault);
        if (isRunning()) {
            fail_program({diag::Severity::ERROR, {text, place_of(fault.source), {}}, {}, {}},
                         AbortReason::MOTION_FAULT);
        } else {
            post(MessageKind::OPERATOR_ERROR, text);
        }
    }
    for (const auto &[answer, source] : news.refused) {
        const std::string text = motion::reason_text(answer);
        if (answer.isPath && isRunning()) {
            fail_program({diag::Severity::ERROR, {text, place_of(source), {}}, {}, {}},
                         AbortReason::EXECUTION_ERROR);
        } else {
            post(MessageKind::OPERATOR_ERROR, text);
        }
        if (answer.id == enable_command_) {
            finish(state_request_, Progress::REFUSED, text);
        }
        if (answer.id == mode_command_) {
            finish(mode_request_, Progress::REFUSED, text);
        }
        if (answer.id == home_command_) {
            finish(home_request_, Progress::REFUSED, text);
        }
    }
}

void Task::take_io() {
    const io::ToolEvent event = io_.step(parts_.io_port.read());
    if (event != io::ToolEvent::NONE) {
        tool_fault_.reset();
    }
    if (event == io::ToolEvent::FAULT) {
        tool_fault_ = io_.fault_reason();
    }
    sequencer_.on_tool_event(event);
}

void Task::update_state() {
    const bool isClosed = io_.isChainClosed();
    const bool isLeavingEstop = state_request_ != 0 && wanted_state_ == State::ESTOP_RESET;
    if (!isClosed && status_.task.state != State::ESTOP && !isLeavingEstop) {
        io_.enter_estop();
        motion_.send(motion::Disable{});
        finish(state_request_, Progress::FAILED, "the e-stop chain opened");
        if (isRunning()) {
            finish_run(Progress::FAILED, "the e-stop chain opened");
        }
        status_.task.state = State::ESTOP;
        abort_work(AbortReason::ESTOP_CHAIN);
        post(MessageKind::OPERATOR_ERROR, "emergency stop: pin iocontrol.0.emc-enable-in is FALSE");
    } else if (status_.task.state == State::ESTOP && isClosed && !io_.isEstopRequested()) {
        status_.task.state = State::ESTOP_RESET;
        begin_clean_up(AbortReason::STATE_ESTOP_RESET);
    }
    const bool isEnabled = motion_.status().isEnabled;
    if (status_.task.state == State::ON && !isEnabled) {
        status_.task.state = State::ESTOP_RESET;
        if (isRunning()) {
            finish_run(Progress::FAILED, "the machine went off");
        }
        abort_work(AbortReason::STATE_NOT_ON);
    } else if (status_.task.state == State::ESTOP_RESET && isEnabled && wanted_state_ == State::ON) {
        status_.task.state = State::ON;
    }
}

void Task::update_pending() {
    if (state_request_ != 0) {
        if (status_.task.state == wanted_state_) {
            finish(state_request_, Progress::DONE, {});
        } else if (now_ns_ > state_deadline_ns_) {
            const bool isChain = wanted_state_ == State::ESTOP_RESET;
            finish(state_request_, Progress::FAILED,
                   isChain ? "pin iocontrol.0.emc-enable-in stays FALSE: the e-stop chain is open"
                           : "the motion controller does not enable: is pin motion.enable TRUE?");
        }
    }
    const motion::Status &motion = motion_.status();
    if (mode_request_ != 0 && motion_.isAnswered(mode_command_) && motion.mode == wanted_motion_mode_) {
        status_.task.mode = wanted_mode_;
        finish(mode_request_, Progress::DONE, {});
    } else if (mode_request_ != 0 && now_ns_ > mode_deadline_ns_) {
        finish(mode_request_, Progress::FAILED, "the motion controller has not changed its mode");
    }
    if (home_request_ != 0 && motion_.isAnswered(home_command_) && !motion.isHoming) {
        const bool isHomed = homing_joint_ < 0
                                 ? motion.isAllHomed
                                 : motion.joint[static_cast<std::size_t>(homing_joint_)].isHomed;
        finish(home_request_, isHomed ? Progress::DONE : Progress::FAILED,
               isHomed ? "" : "homing did not finish");
    }
}

/// The result of a probe that has tripped goes into the file of (probeopen).
void Task::log_probe() {
    constexpr int RESULT = 5061, SUCCESS = 5070, AXES = 9;
    if (!sequencer_.take_probe() || interp_->parameter(SUCCESS) == 0.0) {
        return;
    }
    std::string line;
    for (int axis = 0; axis < AXES; ++axis) {
        line += (axis == 0 ? "" : " ") + fmt::format("{:.6f}", interp_->parameter(RESULT + axis));
    }
    sequencer_.log_probe(line);
}

bool Task::isReadAheadAllowed() const {
    return run_.phase() != RunPhase::FINISHING && run_.hold() != Hold::STOPPED &&
           queue_.size() < settings_.read_ahead_items;
}

/// What an abort has stopped may still brake: a run begins where the machine is at rest.
bool Task::begin_run() {
    if (!motion_.status().isInPosition) {
        return false;
    }
    change_run(RunEvent::BEGUN);
    synch_interpreter();
    if (run_kind_ == RunKind::MDI) {
        on_step_result(interp_->execute(mdi_line_));
    }
    return true;
}

void Task::run_interpreter() {
    if (run_.phase() == RunPhase::STARTING && !begin_run()) {
        return;
    }
    for (int i = 0; i < settings_.blocks_per_cycle && isRunning() && isReadAheadAllowed(); ++i) {
        if (run_.phase() == RunPhase::SYNCHING) {
            if (!sequencer_.isIdle()) {
                return;
            }
            change_run(RunEvent::SYNCED);
            synch_interpreter();
            log_probe();
        }
        on_step_result(interp_->step());
    }
}

void Task::on_step_result(interp::Step result) {
    switch (result) {
    case interp::Step::OK: break;
    case interp::Step::SYNC: change_run(RunEvent::SYNC); break;
    case interp::Step::PROGRAM_END:
    case interp::Step::FILE_END: change_run(RunEvent::READ); break;
    case interp::Step::FAILED:
        fail_program(interp_->error(), run_kind_ == RunKind::MDI ? AbortReason::INTERPRETER_ERROR_MDI
                                                                 : AbortReason::INTERPRETER_ERROR);
        break;
    }
}

bool Task::on_stop(const interp::ProgramStop &stop, int line) {
    if (stop.isOptional && !status_.task.isOptionalStop) {
        return false;
    }
    status_.task.stop_line = line;
    ++status_.task.stops;
    change_run(RunEvent::PROGRAM_STOP);
    return true;
}

/// Of events that the run's own parts tell: one that comes too late changes nothing.
void Task::change_run(RunEvent event) {
    static_cast<void>(run_.take(event));
}

void Task::finish_run(Progress progress, const std::string &reason) {
    if (isRunning() && run_kind_ == RunKind::PROGRAM) {
        interp_->close();
        ++status_.task.programs_ended;
    } else if (isRunning() && progress == Progress::DONE && interp_->isMoveHeld()) {
        post(MessageKind::OPERATOR_TEXT,
             "cutter compensation holds this move back until the next one or G40 says where it ends");
    }
    change_run(RunEvent::END);
    sequencer_.end_step();
    finish(run_request_, progress, reason);
}

void Task::finish(mailbox::Serial &id, Progress progress, const std::string &reason) {
    if (id != 0) {
        tell(id, progress, reason);
    }
    id = 0;
}

void Task::tell(mailbox::Serial id, Progress progress, const std::string &reason) {
    desk_.tell(id, progress, reason);
    if (id == status_.last_command) {
        status_.last_progress = progress;
    }
}

void Task::publish_tools() {
    const std::uint64_t version = parts_.tools.version();
    if (version == tools_version_) {
        return;
    }
    tools_version_ = version;
    status_.tool.table_version = version;
    msgs::ToolTable table{version, {}};
    for (int i = 0; i < parts_.tools.count(); ++i) {
        const interp::ToolEntry entry = parts_.tools.entry(i);
        table.tools.push_back({entry.toolno, entry.pocketno, entry.offset, entry.diameter, entry.frontangle,
                               entry.backangle, entry.orientation, entry.comment});
    }
    if (!desk_.publish_tools(table)) {
        post(MessageKind::OPERATOR_ERROR, "the tool table is too large to be shown to clients");
    }
}

void Task::update_status() {
    const motion::Status &motion = motion_.status();
    status_.task.motion_line = motion.source.line;
    status_.task.blocks = canon_.blocks();
    status_.io.coolant.isMistOn = io_.outputs.coolant_mist;
    status_.io.coolant.isFloodOn = io_.outputs.coolant_flood;
    status_.tool.in_spindle = io_.outputs.tool_number;
    status_.task.isPaused = run_.isHeld();
    status_.task.isStoppedByProgram = run_.hold() == Hold::STOPPED;
    status_.task.interp_state = InterpState::IDLE;
    if (isRunning()) {
        status_.task.interp_state = run_.isHeld()                         ? InterpState::PAUSED
                                    : run_.phase() == RunPhase::FINISHING ? InterpState::WAITING
                                                                          : InterpState::READING;
        status_.task.read_line = interp_->line();
        status_.task.call_level = interp_->call_level();
    }
    status_.task.waiting = isRunning() ? sequencer_.waiting_for() : Waiting{};
    if (home_request_ != 0) {
        status_.task.waiting = {WaitFor::HOMING, homing_joint_};
    }
    ++status_.cycle;
    status_.time_ns = now_ns_;
    const interp::ActiveCodes codes = interp_->active_codes();
    status_.codes = {codes.g, codes.m, codes.settings};
    status_.tool.from_pocket = io_.outputs.tool_from_pocket;
    status_.tool.prepared_index = sequencer_.selected_index();
    status_.tool.isPersonAsked = parts_.io_port.isPersonAsked();
    status_.io.aux = {io_.isEstopRequested(), io_.isChainClosed()};
    status_.io.lube.isOn = io_.outputs.lube;
    tell_motion(motion, settings_.axis_mask, status_);
    publish_tools();
    desk_.publish(status_);
}

interp::MachineSnapshot Task::snapshot() const {
    const motion::Status &motion = motion_.status();
    interp::MachineSnapshot s;
    s.position = motion.carte_pos_cmd;
    // A probe that has missed counts as having come to its end.
    s.probed_position = motion.isProbeTripped ? motion.probed_pos : motion.carte_pos_cmd;
    s.isProbeTripped = motion.isProbeTripped;
    s.input_value = sequencer_.input_value();
    s.isInputTimedOut = sequencer_.isInputTimedOut();
    s.isMistOn = io_.outputs.coolant_mist;
    s.isFloodOn = io_.outputs.coolant_flood;
    s.isFeedOverrideEnabled = motion.isFeedOverrideEnabled;
    s.isFeedHoldEnabled = motion.isFeedHoldEnabled;
    s.isAdaptiveFeedEnabled = motion.isAdaptiveFeedEnabled;
    s.isSpeedOverrideEnabled = motion.spindle[0].isOverrideEnabled;
    for (std::size_t i = 0; i < s.spindle_speed.size(); ++i) {
        s.spindle_speed[i] = sequencer_.spindle_speed(static_cast<int>(i));
        s.spindle_direction[i] = sequencer_.spindle_direction(static_cast<int>(i));
    }
    s.tool_in_spindle = io_.outputs.tool_number;
    s.isToolFaulted = tool_fault_.has_value();
    s.tool_fault_reason = tool_fault_.value_or(0);
    s.selected_pocket = sequencer_.selected_index();
    return s;
}

}  // namespace mw::task
