// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/operator.hh"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/stop_signals.hh"

namespace mw::app {
namespace {

constexpr std::int64_t STOP_TIMEOUT_NS = 30000000000;

}  // namespace

Operator::Operator(machine::Machine &machine, const machine::MachineConfig &config, diag::Sink &sink,
                   const OperatorOptions &options)
    : machine_(machine), config_(config), sink_(sink), panel_(machine, config, sink, options.attendance),
      patience_ns_(static_cast<std::int64_t>(options.patience_s * 1e9)) {}

Result<> Operator::ask(task::Command command, const std::string &what) {
    return wait_for(machine_.task().submit(std::move(command)), what, [] {});
}

Result<> Operator::switch_on() {
    auto status = ask(task::SetState{task::State::ESTOP_RESET}, "reset of the emergency stop");
    return status.has_value() ? ask(task::SetState{task::State::ON}, "switching the machine on") : status;
}

Result<> Operator::home_all() {
    const auto homed = ask(task::HomeJoint{-1}, "homing");
    for (int joint = 0; joint < config_.num_joints; ++joint) {
        const auto i = static_cast<std::size_t>(joint);
        if (!homed.has_value() && machine_.task().motion_status().isEnabled &&
            !machine_.task().motion_status().joint[i].isHomed && stop_signal == 0) {
            const auto one = ask(task::HomeJoint{joint}, "homing joint " + std::to_string(joint));
            if (!one.has_value()) {
                return one;
            }
        }
    }
    return machine_.task().motion_status().isAllHomed ? Result<>{} : homed;
}

Result<> Operator::set_switches(const ProgramSwitches &switches) {
    const auto status = ask(task::SetOptionalStop{switches.isOptionalStopOn}, "setting the optional stop");
    return status.has_value() ? ask(task::SetBlockDelete{switches.isBlockDeleteOn}, "setting block delete")
                              : status;
}

Result<> Operator::open_program(const std::string &path) {
    const auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    program_lines_ = static_cast<int>(std::count(text->begin(), text->end(), '\n'));
    auto status = ask(task::SetMode{task::Mode::AUTO}, "auto mode");
    return status.has_value() ? ask(task::OpenProgram{path}, "opening the program") : status;
}

Result<> Operator::run_program(const std::function<void()> &each_cycle) {
    const auto wall_start = std::chrono::steady_clock::now();
    const std::int64_t start_ns = machine_.now_ns();
    panel_.begin_program(program_lines_);
    const auto status = wait_for(machine_.task().submit(task::RunProgram{}), "the program", each_cycle);
    figures_.cycle_time_s = static_cast<double>(machine_.now_ns() - start_ns) * 1e-9;
    figures_.wall_time_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
    figures_.blocks = machine_.task().status().blocks;
    figures_.stops_passed = panel_.stops_passed();
    panel_.end_program();
    return status;
}

Result<> Operator::wait_for(task::RequestId id, const std::string &what,
                            const std::function<void()> &each_cycle) {
    task::Task &task = machine_.task();
    std::int64_t deadline_ns = machine_.now_ns() + patience_ns_;
    mark_ = {};
    last_error_.clear();
    while (true) {
        machine_.cycle();
        if (auto health = machine_.health(); !health) {
            return health;
        }
        each_cycle();
        show_messages();
        panel_.step();
        const task::Progress progress = task.progress(id);
        if (progress == task::Progress::DONE) {
            return {};
        }
        if (progress != task::Progress::STARTED) {
            const std::string reason = task.reason(id);
            const bool isTold = !last_error_.empty();
            return fail(isTold ? "" : what + " failed" + (reason.empty() ? "" : ": " + reason));
        }
        if (stop_signal != 0) {
            return stop_on_signal();
        }
        if (hasProgress() || panel_.isWaitingForPerson()) {
            deadline_ns = machine_.now_ns() + patience_ns_;
        } else if (machine_.now_ns() > deadline_ns) {
            const std::string waiting = task.status().waiting.what;
            return fail(
                fmt::format("{}: no progress for {:g} s", what, static_cast<double>(patience_ns_) * 1e-9), {},
                waiting.empty() ? "motion is waiting" : "waiting for " + waiting);
        }
    }
}

bool Operator::hasProgress() {
    const motion::Status &motion = machine_.task().motion_status();
    Mark now{machine_.task().status().blocks, motion.carte_pos_cmd, {}};
    for (std::size_t i = 0; i < now.joints.size(); ++i) {
        now.joints[i] = motion.joint[i].pos_cmd;
    }
    const bool isDwelling = machine_.task().status().waiting.what == "the end of a dwell";
    const bool isChanged = !(now == mark_) || isDwelling;
    mark_ = now;
    return isChanged;
}

Result<> Operator::stop_on_signal() {
    machine_.task().submit(task::AbortAll{});
    const std::int64_t deadline_ns = machine_.now_ns() + STOP_TIMEOUT_NS;
    do {
        machine_.cycle();
    } while (!machine_.task().motion_status().isInPosition && machine_.now_ns() < deadline_ns &&
             machine_.health());
    return fail("stopped by " + stop_signal_name());
}

void Operator::switch_off() {
    if (!machine_.health()) {
        return;  // There is nothing left that could be switched.
    }
    task::Task &task = machine_.task();
    task.submit(task::AbortAll{});
    const std::int64_t deadline_ns = machine_.now_ns() + STOP_TIMEOUT_NS;
    machine_.cycle();
    machine_.cycle();
    while (!task.motion_status().isInPosition && task.motion_status().isEnabled &&
           machine_.now_ns() < deadline_ns && machine_.health()) {
        machine_.cycle();
    }
    task.submit(task::SetState{task::State::ESTOP});
    for (int i = 0; i < 3; ++i) {
        machine_.cycle();
    }
    show_messages();
}

void Operator::show_messages() {
    task::Message message;
    while (machine_.task().poll_message(message)) {
        panel_.show(message);
        if (message.kind == task::MessageKind::OPERATOR_ERROR) {
            last_error_ = message.text;
        }
    }
}

OperatorFigures Operator::figures() const {
    OperatorFigures figures = figures_;
    figures.warnings =
        static_cast<int>(std::count_if(sink_.all().begin(), sink_.all().end(),
                                       [](const auto &d) { return d.severity == diag::Severity::WARNING; }));
    return figures;
}

}  // namespace mw::app
