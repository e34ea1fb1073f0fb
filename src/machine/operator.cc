// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/operator.hh"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::machine {
namespace {

constexpr auto SHOW_EVERY = std::chrono::milliseconds(100);
constexpr std::int64_t STOP_TIMEOUT_NS = 30000000000;

// Set by the signal handler; handlers have no other way to tell.
volatile std::sig_atomic_t stop_signal = 0;

void on_signal(int number) {
    stop_signal = number;
}

void catch_signals(bool isCatching) {
    struct sigaction action{};
    action.sa_handler = isCatching ? on_signal : SIG_DFL;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Operator::Operator(Machine &machine, const MachineConfig &config, diag::Sink &sink, double patience_s)
    : machine_(machine), config_(config), sink_(sink),
      patience_ns_(static_cast<std::int64_t>(patience_s * 1e9)) {
    stop_signal = 0;
    catch_signals(true);
}

Operator::~Operator() {
    catch_signals(false);
}

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
    isShowingProgress_ = ::isatty(STDERR_FILENO) != 0;
    const auto status = wait_for(machine_.task().submit(task::RunProgram{}), "the program", each_cycle);
    figures_.cycle_time_s = static_cast<double>(machine_.now_ns() - start_ns) * 1e-9;
    figures_.wall_time_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
    figures_.blocks = machine_.task().status().blocks;
    show_progress(true);
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
        each_cycle();
        show_messages();
        show_progress(false);
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
        if (task.status().isPaused) {
            ++figures_.stops_passed;
            sink_.note(fmt::format("program stop at line {} passed", task.status().stop_line));
            task.submit(task::ResumeProgram{});
        }
        if (hasProgress()) {
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
    catch_signals(false);
    machine_.task().submit(task::AbortAll{});
    const std::int64_t deadline_ns = machine_.now_ns() + STOP_TIMEOUT_NS;
    do {
        machine_.cycle();
    } while (!machine_.task().motion_status().isInPosition && machine_.now_ns() < deadline_ns);
    return fail("stopped by a signal");
}

void Operator::switch_off() {
    task::Task &task = machine_.task();
    task.submit(task::AbortAll{});
    const std::int64_t deadline_ns = machine_.now_ns() + STOP_TIMEOUT_NS;
    machine_.cycle();
    machine_.cycle();
    while (!task.motion_status().isInPosition && task.motion_status().isEnabled &&
           machine_.now_ns() < deadline_ns) {
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
        if (isShowingProgress_) {
            fmt::print(stderr, "\r\033[K");
        }
        switch (message.kind) {
        case task::MessageKind::OPERATOR_ERROR:
            last_error_ = message.text;
            fmt::print(stderr, "{}\n", printable(message.text));
            break;
        case task::MessageKind::OPERATOR_DISPLAY: fmt::print("{}\n", printable(message.text)); break;
        case task::MessageKind::OPERATOR_TEXT: fmt::print("{}\n", printable(message.text)); break;
        }
    }
}

void Operator::show_progress(bool isLast) {
    const auto now = std::chrono::steady_clock::now();
    if (!isShowingProgress_ || (!isLast && now - last_shown_ < SHOW_EVERY)) {
        return;
    }
    last_shown_ = now;
    if (isLast) {
        fmt::print(stderr, "\r\033[K");
        isShowingProgress_ = false;
        return;
    }
    constexpr int WIDTH = 40;
    const int line = machine_.task().status().motion_line;
    const int filled = program_lines_ > 0 ? std::min(WIDTH, WIDTH * line / program_lines_) : 0;
    fmt::print(stderr, "\r[{}{}] line {} of {}\033[K", std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(WIDTH - filled), ' '), line, program_lines_);
}

OperatorFigures Operator::figures() const {
    OperatorFigures figures = figures_;
    figures.warnings =
        static_cast<int>(std::count_if(sink_.all().begin(), sink_.all().end(),
                                       [](const auto &d) { return d.severity == diag::Severity::WARNING; }));
    return figures;
}

}  // namespace mw::machine
