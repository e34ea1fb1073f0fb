// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/run_session.hh"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/diagnostics/sink.hh"
#include "base/duration.hh"
#include "base/stop_signals.hh"
#include "machine/config/machine_config.hh"

namespace mw::programs {
namespace {

constexpr std::int64_t STOP_TIMEOUT_NS = 30000000000;

}  // namespace

RunSession::RunSession(MachineAccess &machine, const machine::MachineConfig &config, diagnostics::Sink &sink,
                       const RunSessionOptions &options)
    : machine_(machine), config_(config), sink_(sink), panel_(machine, config, sink, options.attendance),
      patience_ns_(to_ns(options.patience_s)) {
    static_cast<void>(machine_.client().read_status());
}

void RunSession::cycle() {
    machine_.cycle();
    // If task has died in this time, health() reports it.
    static_cast<void>(machine_.client().read_status());
}

Result<> RunSession::ask(const messages::Command &command, const std::string &what) {
    return wait_for(machine_.client().post(command), what, [] {});
}

Result<> RunSession::switch_on() {
    if (status().task.state == messages::State::ON) {
        return {};
    }
    auto status = ask(messages::SetState{messages::State::ESTOP_RESET}, "reset of the emergency stop");
    return status.has_value() ? ask(messages::SetState{messages::State::ON}, "switching the machine on")
                              : status;
}

Result<> RunSession::home_all() {
    if (status().trajectory.isAllHomed) {
        return {};
    }
    const auto manual = status().task.mode == messages::Mode::MANUAL
                            ? Result<>{}
                            : ask(messages::SetMode{messages::Mode::MANUAL}, "manual mode");
    if (!manual.has_value()) {
        return manual;
    }
    if (status().trajectory.mode == messages::MotionMode::TELEOP) {
        const auto joints = ask(messages::SetTeleop{false}, "joint mode");
        if (!joints.has_value()) {
            return joints;
        }
    }
    const auto homed = ask(messages::HomeJoint{-1}, "homing");
    for (int joint = 0; joint < config_.num_joints; ++joint) {
        const auto i = static_cast<std::size_t>(joint);
        if (!homed.has_value() && status().trajectory.isEnabled && !status().joints[i].isHomed &&
            stop_signal == 0) {
            const auto one = ask(messages::HomeJoint{joint}, "homing joint " + std::to_string(joint));
            if (!one.has_value()) {
                return one;
            }
        }
    }
    return status().trajectory.isAllHomed ? Result<>{} : homed;
}

Result<> RunSession::set_switches(const ProgramSwitches &switches) {
    const auto status =
        ask(messages::SetOptionalStop{switches.optional_stop_on}, "setting the optional stop");
    return status.has_value()
               ? ask(messages::SetBlockDelete{switches.block_delete_on}, "setting block delete")
               : status;
}

Result<> RunSession::open_program(const std::string &path) {
    const auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    program_lines_ = static_cast<int>(std::count(text->begin(), text->end(), '\n'));
    auto status = ask(messages::SetMode{messages::Mode::AUTO}, "auto mode");
    return status.has_value() ? ask(messages::OpenProgram{path}, "opening the program") : status;
}

Result<> RunSession::run_program(int from_line, const std::function<void()> &each_cycle) {
    const auto wall_start = std::chrono::steady_clock::now();
    const std::int64_t start_ns = machine_.now_ns();
    panel_.begin_program(program_lines_);
    const auto status =
        wait_for(machine_.client().post(messages::RunProgram{from_line}), "the program", each_cycle);
    figures_.cycle_time_s = static_cast<double>(machine_.now_ns() - start_ns) * 1e-9;
    figures_.wall_time_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
    figures_.blocks = this->status().task.blocks;
    figures_.stops_passed = panel_.stops_passed();
    panel_.end_program();
    return status;
}

Result<> RunSession::wait_for(const Result<client::Serial> &posted, const std::string &what,
                              const std::function<void()> &each_cycle) {
    if (!posted.has_value()) {
        return std::unexpected(posted.error());
    }
    std::int64_t deadline_ns = machine_.now_ns() + patience_ns_;
    mark_ = {};
    last_error_.clear();
    while (true) {
        cycle();
        if (auto health = machine_.health(); !health) {
            return health;
        }
        each_cycle();
        show_messages();
        panel_.step();
        const client::Outcome outcome = machine_.client().outcome(*posted);
        if (outcome.progress == messages::Progress::DONE) {
            return {};
        }
        if (outcome.progress != messages::Progress::STARTED) {
            // Printed as a message to the operator; on a shared machine it may be about the work of other
            // clients.
            const bool reported = !last_error_.empty() && !machine_.isShared();
            const std::string &reason = outcome.reason;
            return std::unexpected(
                Error{what + " failed" + (reason.empty() ? "" : ": " + reason), {}, {}, reported});
        }
        if (stop_signal != 0) {
            return stop_on_signal();
        }
        if (hasProgress() || panel_.isWaitingForPerson()) {
            deadline_ns = machine_.now_ns() + patience_ns_;
        } else if (machine_.now_ns() > deadline_ns) {
            const std::string waiting = messages::waiting_text(status().task.waiting);
            return fail(
                fmt::format("{}: no progress for {:g} s", what, static_cast<double>(patience_ns_) * 1e-9), {},
                waiting.empty() ? "motion is waiting" : "waiting for " + waiting);
        }
    }
}

bool RunSession::hasProgress() {
    const messages::MachineStatus &shown = status();
    Mark now{shown.task.blocks, shown.trajectory.position_cmd, {}};
    for (std::size_t i = 0; i < now.joints.size(); ++i) {
        now.joints[i] = shown.joints[i].pos_cmd;
    }
    const bool dwelling = shown.task.waiting.what == messages::WaitFor::DWELL;
    const bool changed = !(now == mark_) || dwelling;
    mark_ = now;
    return changed;
}

Result<> RunSession::stop_on_signal() {
    static_cast<void>(machine_.client().post(messages::AbortAll{}));
    const std::int64_t deadline_ns = machine_.now_ns() + STOP_TIMEOUT_NS;
    do {
        cycle();
    } while (!status().trajectory.isInPosition && machine_.now_ns() < deadline_ns && machine_.health());
    return fail("stopped by " + stop_signal_name());
}

void RunSession::stop() {
    if (machine_.health()) {
        stop_motion(machine_);
        show_messages();
    }
}

void RunSession::switch_off() {
    if (machine_.health()) {  // otherwise there is nothing left to switch off
        programs::switch_off(machine_);
        show_messages();
    }
}

void RunSession::show_messages() {
    while (const auto message = machine_.client().next_message()) {
        panel_.show(*message);
        if (message->kind == messages::MessageKind::OPERATOR_ERROR) {
            last_error_ = message->text;
        }
    }
}

RunSessionFigures RunSession::figures() const {
    RunSessionFigures figures = figures_;
    figures.warnings =
        static_cast<int>(std::count_if(sink_.all().begin(), sink_.all().end(), [](const auto &d) {
            return d.severity == diagnostics::Severity::WARNING;
        }));
    return figures;
}

}  // namespace mw::programs
