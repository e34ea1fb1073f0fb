// SPDX-License-Identifier: GPL-2.0-or-later
// The work of task while a call into the interpreter takes long: docs/developer/long_calls.md.
#include "machine/task/task_apart.hh"

#include <fmt/format.h>

#include "gcode/interpreter/scripts/script_stop.hh"
#include "machine/task/task_handler.hh"
#include "machine/task/task_show.hh"
#include "messages/mailbox/stops.hh"

namespace mw::task {
namespace {

/// Time after which a long call is reported to the operator.
constexpr std::int64_t TOLD_AFTER_NS = 1000000000;

/// True for commands that need neither the interpreter nor its queue.
bool isTakenApart(const Command &command) {
    const bool is_override = std::visit(
        []<class C>(const C &) {
            return command_lists::CarriedOutByMotion<C> || OneOf<C, SpindleOff, MistOff, FloodOff, LubeOff>;
        },
        command);
    return is_override || mailbox::isStop(command);
}

}  // namespace

void Task::Meanwhile::begin() {
    Apart &apart = task.apart_;
    if (!apart.isOn) {
        apart.isOn = true;
        apart.since_ns = task.now_ns_;
    }
    if (!apart.isTold && task.now_ns_ - apart.since_ns >= TOLD_AFTER_NS) {
        apart.isTold = true;
        const TaskStatus &shown = task.status_.task;
        const std::string place = task.run_.isProgram()
                                      ? fmt::format("{}:{}", shown.program.str(), shown.read_line)
                                      : std::string("the last request");
        task.post(MessageKind::OPERATOR_TEXT,
                  fmt::format("the interpreter has been busy for 1 s at or after {}: a slow disk, or Python. "
                              "Stops work; other commands wait until it has finished",
                              place));
    }
    if (apart.stopped && !apart.wait_reported && task.now_ns_ - apart.stopped_ns >= TOLD_AFTER_NS) {
        apart.wait_reported = true;
        const std::string place = gcode::script_stop().place();
        task.post(MessageKind::OPERATOR_ERROR,
                  fmt::format(
                      "the work is stopped, but the interpreter still waits{}: for a disk, or for a function "
                      "outside of Python such as time.sleep(). Other commands wait until it returns; if it "
                      "does not, end the machine",
                      place.empty() ? "" : " at " + place));
    }
}

void Task::Meanwhile::stop_work(const std::string &why, AbortReason reason, bool interrupted) {
    if (!task.apart_.isOn) {
        task.stop_run(why, interrupted);
        task.abort_work(reason);
        return;
    }
    task.reader_.call().fix_executed(task.sequencer_);
    task.motion_.abort();
    task.mode_.note_stop(task.now_ns_);
    task.sequencer_.stop_spindles();
    task.io_.set_flood(false);
    task.io_.set_mist(false);
    task.apart_.stopped = true;
    task.apart_.stopped_ns = task.now_ns_;
    gcode::script_stop().request();
    task.apart_.later.emplace_back([&here = task, why, reason, interrupted] {
        here.stop_run(why, interrupted);
        here.abort_work(reason);
    });
}

void Task::step_apart(std::int64_t now_ns) {
    now_ns_ = now_ns;
    Meanwhile{*this}.begin();
    take_motion_news();
    const io::ToolEvent event = io_.step(parts_.io_port.read());
    if (event != io::ToolEvent::NONE) {
        apart_.later.emplace_back([this, event] { sequencer_.on_tool_event(event); });
    }
    update_state();
    inbox_.add(desk_.take(now_ns_));
    while (const auto delivery = inbox_.next_of(isTakenApart)) {
        carry_out(*delivery);
    }
    Meanwhile{*this}.end_left_jogs();
    end_requests();
    sequencer_.sent().follow(motion_.status());
    const bool moving = run_.isRunning() && run_.hold() == Hold::GOING && !apart_.stopped;
    if (moving && motion_.status().mode == motion::Mode::COORD) {
        sequencer_.step(now_ns_, Sequencer::TravelRange::NO_TOOLS);
    }
    if (const auto failure = run_.take_failure()) {
        post(MessageKind::OPERATOR_ERROR, *failure);
        Meanwhile{*this}.stop_work(*failure, AbortReason::EXECUTION_ERROR);
    }
    parts_.io_port.write(io_.outputs);
    Show{*this}.states();
    Show{*this}.sequencer();
    if (apart_.stopped) {  // the run has ended, although the call still has to end
        status_.task.interp_state = InterpState::IDLE;
        status_.task.exec_state = ExecState::DONE;
        status_.task.isPaused = status_.task.isStoppedByProgram = false;
        status_.task.waiting = {};
    }
    Show{*this}.publish();
}

bool Task::Meanwhile::end() {
    if (!task.apart_.isOn) {
        return false;
    }
    const Apart apart = std::exchange(task.apart_, {});
    for (const auto &work : apart.later) {
        work();
    }
    task.reader_.call().fixed_executed.reset();
    return apart.stopped;
}

bool Task::Meanwhile::end_step(gcode::Step result) {
    const bool failed = task.apart_.stopped && result == gcode::Step::FAILED;
    const std::string failure = failed ? task.reader_.interpreter().error().what.str() : std::string();
    const bool stopped = end();
    if (failed) {
        task.post(MessageKind::OPERATOR_ERROR, failure);
    }
    return stopped;
}

void Task::Meanwhile::end_left_jogs() {
    for (const JogGuard::Left &left : task.senders_.left_jogs(task.motion_.status())) {
        if (!left.text.empty()) {
            task.post(MessageKind::OPERATOR_ERROR, left.text);
        }
        std::visit(Handler{task, 0}, left.stop);
    }
}

Result<Progress> Task::Meanwhile::settle(mailbox::Serial command) {
    // Clients receive it within 100 ms, including the period of a server between them.
    constexpr std::int64_t ANSWERED_WITHIN_NS = 60000000;
    const motion::CommandId order = task.motion_.open_order();
    if (!task.motion_.watch().isSilent() || order == 0) {
        return Progress::DONE;
    }
    task.orders_.begin(command, order, RefusalIsFor::EVERYBODY, task.now_ns_, ANSWERED_WITHIN_NS);
    return Progress::STARTED;
}

}  // namespace mw::task
