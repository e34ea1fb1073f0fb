// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/terminal_panel.hh"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <fmt/format.h>

#include "base/diagnostics/sink.hh"
#include "base/language/language.hh"
#include "base/output_relay.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "machine/config/machine_config.hh"
#include "messages/client/shown_message.hh"

namespace mw::programs {
namespace {

constexpr auto WRITE_EVERY = std::chrono::milliseconds(100);
constexpr auto KEYS_EVERY = std::chrono::milliseconds(10);

/// Tool position in the program's coordinates. [machine units]
geometry::Pose program_position(const messages::MachineStatus &status) {
    geometry::Pose p = status.trajectory.position_cmd - status.offsets.tool - status.offsets.g5x;
    const double angle = -status.offsets.rotation_xy_deg * std::numbers::pi / 180.0;
    const double x = p[0] * std::cos(angle) - p[1] * std::sin(angle);
    p[1] = p[0] * std::sin(angle) + p[1] * std::cos(angle);
    p[0] = x;
    return p - status.offsets.g92;
}

}  // namespace

TerminalPanel::TerminalPanel(MachineAccess &machine, const machine::MachineConfig &config,
                             diagnostics::Sink &sink, Attendance attendance)
    : machine_(machine), config_(config), sink_(sink), attendance_(attendance),
      has_line_(OutputRelay::isTerminal(STDERR_FILENO)) {
    if (attendance_ == Attendance::TERMINAL) {
        keyboard_.emplace();
    }
}

bool TerminalPanel::confirm(const std::string &question) {
    if (!keyboard_.has_value()) {
        return false;
    }
    fmt::print(stderr, "{} [y/n] ", language::shown(question));
    std::optional<char> key;
    while (stop_signal == 0 && machine_.health()) {
        machine_.cycle();
        key = keyboard_->read();
        if (key == 'y' || key == 'Y' || key == 'n' || key == 'N') {
            break;
        }
    }
    const bool yes = key == 'y' || key == 'Y';
    fmt::print(stderr, "{}\n", yes ? "yes" : "no");
    return yes;
}

void TerminalPanel::begin_program(int lines) {
    lines_ = lines;
    line_ = 0;
    running_ = true;
    stops_told_ = status().task.stops;
    if (attendance_ == Attendance::TERMINAL) {
        fmt::print(stderr, "{}",
                   language::shown("keys: h or space: hold, r: resume, a: abort, t: tool changed\n"));
    }
}

void TerminalPanel::end_program() {
    clear_line();
    running_ = false;
}

void TerminalPanel::step() {
    const auto now = std::chrono::steady_clock::now();
    if (keyboard_.has_value() && now - last_key_ >= KEYS_EVERY) {
        last_key_ = now;
        while (const std::optional<char> key = keyboard_->read()) {
            take_key(*key);
        }
    }
    look_at_stop();
    look_at_approach();
    if (running_ && has_line_ && now - last_written_ >= WRITE_EVERY) {
        last_written_ = now;
        write_line();
    }
}

void TerminalPanel::post(const messages::Command &command) {
    const auto posted = machine_.client().post(command);
    if (!posted.has_value()) {
        sink_.warning(posted.error().str());
    }
}

void TerminalPanel::take_key(char key) {
    switch (key) {
    case 'h':
    case ' ': post(messages::PauseProgram{}); break;
    case 'r':
        if (const std::uint64_t proposed = status().approach.number; proposed != 0) {
            post(messages::ConfirmApproach{proposed});
        } else {
            post(messages::ResumeProgram{});
        }
        break;
    case 'a': post(messages::AbortAll{}); break;
    case 't':
        if (status().tool.isPersonAsked) {
            post(messages::ConfirmToolChange{});
        }
        break;
    default: break;
    }
}

void TerminalPanel::look_at_stop() {
    const messages::MachineStatus &status = this->status();
    if (!status.task.isPaused || !status.task.isStoppedByProgram || status.task.stops == stops_told_) {
        return;
    }
    stops_told_ = status.task.stops;
    clear_line();
    if (attendance_ == Attendance::SIMULATED) {
        ++stops_passed_;
        sink_.note(
            fmt::format("program stop at line {} passed by the simulated operator", status.task.stop_line));
        post(messages::ResumeProgram{});
    } else if (attendance_ == Attendance::TERMINAL) {
        sink_.note(fmt::format("program stop at line {}: key r continues", status.task.stop_line));
    } else {
        sink_.note(fmt::format("program stop at line {}: waiting for {}", status.task.stop_line,
                               config_.has_halui ? "pin halui.program.resume"
                                                 : "a signal, since there is neither a terminal nor halui"));
    }
}

/// Called when task's message describes the approach.
void TerminalPanel::look_at_approach() {
    const std::uint64_t proposed = status().approach.number;
    if (proposed == 0 || proposed == approach_told_) {
        return;
    }
    approach_told_ = proposed;
    clear_line();
    if (attendance_ == Attendance::SIMULATED) {
        sink_.note("the simulated operator confirmed the approach");
        post(messages::ConfirmApproach{proposed});
    } else if (attendance_ == Attendance::TERMINAL) {
        sink_.note("key r confirms the approach, a cancels it");
    } else {
        sink_.note(
            std::string("the approach waits for ") +
            (config_.has_halui ? "pin halui.program.resume" : "a signal, because no one can confirm it"));
    }
}

bool TerminalPanel::isWaitingForPerson() const {
    const messages::MachineStatus &status = this->status();
    const bool held = status.task.isPaused && attendance_ != Attendance::SIMULATED;
    return held || status.tool.isPersonAsked;
}

void TerminalPanel::show(const client::Client::Message &message) {
    clear_line();
    const bool is_error = message.kind == messages::MessageKind::OPERATOR_ERROR;
    fmt::print(is_error ? stderr : stdout, "{}\n", printable(client::shown_message(message)));
    if (attendance_ != Attendance::SIMULATED) {
        std::fflush(stdout);  // a person may be asked for input
    }
}

void TerminalPanel::clear_line() {
    if (running_ && has_line_) {
        fmt::print(stderr, "\r\033[K");
    }
}

/// Motion has no line between moves.
int TerminalPanel::line_reached() {
    const messages::MachineStatus &status = this->status();
    const int line = status.task.isStoppedByProgram ? status.task.stop_line : status.task.motion_line;
    line_ = line > 0 ? line : line_;
    return line_;
}

std::string TerminalPanel::progress_text() {
    constexpr int WIDTH = 40;
    const int line = line_reached();
    const int filled = lines_ > 0 ? std::clamp(WIDTH * line / lines_, 0, WIDTH) : 0;
    return fmt::format("[{}{}] line {} of {}", std::string(static_cast<std::size_t>(filled), '#'),
                       std::string(static_cast<std::size_t>(WIDTH - filled), ' '), line, lines_);
}

std::string TerminalPanel::position_text() const {
    const geometry::Pose p = program_position(status());
    std::string text;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((config_.axis_mask & (1U << axis)) != 0) {
            text += fmt::format(" {}{:.{}f}", geometry::AXIS_LETTERS[axis], p[axis], config_.metric ? 3 : 4);
        }
    }
    return text;
}

void TerminalPanel::write_line() {
    if (attendance_ == Attendance::SIMULATED) {
        fmt::print(stderr, "\r{}\033[K", progress_text());
        return;
    }
    const messages::MachineStatus &status = this->status();
    const int line = line_reached();
    const int percent = lines_ > 0 ? std::clamp(100 * line / lines_, 0, 100) : 0;
    const std::string waiting = messages::waiting_text(status.task.waiting);
    const std::string state = status.tool.isPersonAsked ? "tool change"
                              : status.task.isPaused    ? "held"
                              : waiting.empty()         ? "runs"
                                                        : "waits for " + waiting;
    fmt::print(stderr, "\rline {} of {} ({} %) {} F{:.0f} {}\033[K", line, lines_, percent, position_text(),
               status.trajectory.current_velocity * 60.0, state);
}

}  // namespace mw::programs
