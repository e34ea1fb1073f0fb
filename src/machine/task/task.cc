// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/task.hh"

#include <fmt/format.h>

#include "motion/interface/texts.hh"

namespace mw::task {

Task::Task(const Parts &parts, Settings settings)
    : settings_(std::move(settings)), io_pins_(parts.io_port), port_(parts.channels, parts.mailbox),
      io_(settings_.changer_protocol), senders_(settings_.confinement),
      mdi_queue_(settings_.mdi_queued_commands),
      world_({settings_.machine_units, settings_.axis_mask, settings_.num_spindles}),
      reader_({world_, parts.tools, parts.parameters},
              {settings_.machine_units, settings_.tool_change_place, settings_.parameter_file,
               settings_.sequencer.tool_change_with_spindle_on, settings_.interpreter_plugin,
               settings_.interpreter}),
      parameter_file_(settings_.parameter_file, reader_, parts.journal), recovery_(parts.journal),
      planner_mode_({[this](const motion::SetParameter &p) { return port_.send(p); },
                     [this](MessageKind kind, const std::string &text) { post(kind, text); }}),
      calls_(port_, reader_),
      actions_({settings_, port_, io_, world_, reader_, run_, senders_, planner_mode_}),
      sequencer_(reader_.queue(), port_.link(), io_, parts.tools, actions_.events(), settings_.sequencer),
      parts_{settings_, port_,  io_,      parts.tools, world_,          reader_,   run_,
             senders_,  calls_, actions_, sequencer_,  parameter_file_, recovery_, mdi_queue_},
      end_(parts_, {[this] { modes_.note_stop(); }, [this] { abandon_requests(); }}), runs_(parts_, end_),
      modes_(port_, io_, end_, calls_), manual_(port_, io_, sequencer_, modes_, settings_.num_spindles),
      resume_(parts_, runs_, end_, modes_), motion_settings_(port_, settings_), tools_(parts_),
      commands_(parts_, {io_pins_, runs_, end_, resume_, modes_, manual_, motion_settings_, tools_}),
      status_(parts_, {io_pins_, runs_, end_, resume_, modes_, manual_, motion_settings_, tools_}) {}

void Task::configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables) {
    planner_mode_.configure(parameters);
    motion_settings_.configure(parameters, tables);
}

Result<> Task::start() {
    port_.link().update();
    const auto loaded = runs_.load();
    if (!loaded.has_value()) {
        return loaded;
    }
    planner_mode_.announce();
    return runs_.begin_interpreter();
}

void Task::step(std::int64_t now_ns) {
    port_.begin_cycle(now_ns);
    static_cast<void>(calls_.end());
    take_motion_news();
    take_inputs();
    modes_.follow_machine();
    commands_.execute_commands();
    end_requests();
    end_.step();
    step_run();
    write_outputs();
    status_.write();
}

void Task::step_apart(std::int64_t now_ns) {
    port_.begin_cycle(now_ns);
    const TaskStatus &shown = status_.status().task;
    calls_.step(run_.isProgram() ? fmt::format("{}:{}", shown.program.str(), shown.read_line)
                                 : std::string("the last request"));
    take_motion_news();
    const io::ToolEvent event = io_.step(io_pins_.read());
    if (event != io::ToolEvent::NONE) {
        calls_.after_call([this, event] { sequencer_.on_tool_event(event); });
    }
    modes_.follow_machine();
    commands_.execute_during_call();
    end_requests();
    sequencer_.sent().follow(port_.motion());
    runs_.execute_during_call();
    io_pins_.write(io_.outputs);
    status_.write_during_call();
}

void Task::take_motion_news() {
    const MotionLink::News news = port_.update();
    for (const motion::Fault &fault : news.faults) {
        motion::Fault told = fault;
        told.source.line = run_.isProgram() ? fault.source.line : 0;  // an MDI line has no number
        end_.report(motion::fault_text(told), fault.source, !motion::isOnlyTold(fault.kind),
                    AbortReason::MOTION_FAULT);
    }
    for (const MotionLink::Refusal &refusal : news.refused) {
        const motion::Answer &answer = refusal.answer;
        const std::string text = motion::reason_text(answer);
        motion_settings_.note_refusal(refusal);
        if (modes_.isRetried(answer, text)) {
            continue;
        }
        if (port_.refuse_order(answer.id, text)) {
            end_.report(text, refusal.source, answer.isPath, AbortReason::EXECUTION_ERROR);
        }
        modes_.refuse(answer.id, text);
        manual_.refuse(answer.id, text);
    }
}

void Task::take_inputs() {
    sequencer_.sent().follow(port_.motion());
    runs_.check_files();
    sequencer_.on_tool_event(io_.step(io_pins_.read()));
    resume_.watch_pause();  // a loaded tool is recorded before a command continues with it
}

/// Called when the work of the requests was aborted.
void Task::abandon_requests() {
    resume_.forget_proposal();
    manual_.abort();
    modes_.abort();
}

void Task::end_requests() {
    modes_.end_requests(run_.isRunning());
    manual_.step();
    port_.end_orders();
}

void Task::step_run() {
    if (!run_.isRunning() || port_.motion().mode != motion::Mode::COORD) {
        return;
    }
    runs_.apply_rights();
    if (!resume_.step()) {
        runs_.read_ahead();
    }
    runs_.execute();
    commands_.execute_queued_lines();
}

void Task::write_outputs() {
    resume_.watch_pause();
    // Calls that are queued without a run are settings for displays; they move nothing.
    planner_mode_.step(!run_.isRunning() && port_.link().isPathComplete());
    if (run_.phase() == RunPhase::IDLE && port_.motion().isInPosition) {
        io_.set_tool_offset(reader_.canon().tool_offset().value_or(io_.outputs.tool_offset));
    }
    if (!run_.isRunning()) {
        actions_.show_announced_offsets();
    }
    io_pins_.write(io_.outputs);
}

}  // namespace mw::task
