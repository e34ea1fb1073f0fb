// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/tcl/shell.hh"

#include <chrono>
#include <thread>

#include "base/language/language.hh"
#include "base/text.hh"
#include "clients/rsh/answers.hh"

namespace mw::tcl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds LOOK_EVERY{2};

double now_s() {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

Shell::Shell(client::Viewer viewer, rsh::Joining joining, ini::IniFile ini)
    : ini_(std::make_unique<ini::IniFile>(std::move(ini))), view_(std::move(viewer)),
      commander_(std::move(joining)) {
    settings_.dialect = rsh::Dialect::NEWER;
    settings_.ini = ini_.get();
    own.waiting_for_done = false;
    if (view_.read().has_value()) {
        settings_.num_joints = view_.status().trajectory.num_joints;
        settings_.num_spindles = view_.status().trajectory.num_spindles;
    }
    own.lines = view_.unread();
}

void Shell::set_ini(ini::IniFile ini) {
    ini_ = std::make_unique<ini::IniFile>(std::move(ini));
    settings_.ini = ini_.get();
}

Result<> Shell::update() {
    const auto read = view_.read();
    const auto machine = view_.check_machine();
    if (!machine.has_value() || !read.has_value()) {
        return machine.has_value() ? read : machine;
    }
    if (own.kept != nullptr) {
        *own.kept = view_.status();
    }
    return {};
}

Result<> Shell::look() {
    return own.kept == nullptr ? update() : Result<>();
}

Result<std::string> Shell::told(const std::string &question, const Words &words) {
    const auto answering = rsh::answering(settings_, question);
    if (answering == nullptr) {
        return fail("there is no question " + question);
    }
    const auto answer = answering({settings_, view_, own, status(), words});
    if (!answer.has_value()) {
        return std::unexpected(answer.error());
    }
    return answer->empty() ? std::string() : rsh::behind_words(answer->front(), 1);
}

Result<std::string> Shell::ask(const std::string &order, const Words &words) {
    const rsh::Order *const found = rsh::find_order(settings_, order);
    if (found == nullptr) {
        return fail("there is no order " + order);
    }
    std::string rest;
    for (const std::string &word : words) {
        rest += (rest.empty() ? "" : " ") + word;
    }
    commander_.begin_order();
    auto waiting = found->ordering({settings_, view_, own, commander_, errors_, words, rest});
    // An unknown word is an error of the program; a command that the machine rejects is an answer.
    return waiting.has_value() ? finish(std::move(*waiting)) : std::unexpected(waiting.error());
}

Result<std::string> Shell::send(const messages::Command &command) {
    commander_.begin_order();
    const auto serial = commander_.post(command);
    return serial.has_value() ? finish({rsh::Until::AS_SET, {*serial}, {}, false}) : serial.error().str();
}

Result<std::string> Shell::jog(const rsh::JogTarget &target, double velocity) {
    commander_.begin_order();
    const auto serial = commander_.jog(target, velocity);
    return serial.has_value() ? finish({rsh::Until::TAKEN, {*serial}, {}, false}) : serial.error().str();
}

Result<std::string> Shell::stop_jog(const rsh::JogTarget &target) {
    commander_.begin_order();
    const auto serial = commander_.stop_jog(target);
    return serial.has_value() ? finish({rsh::Until::TAKEN, {*serial}, {}, false}) : serial.error().str();
}

void Shell::keep_jogging() {
    commander_.keep_jogging(now_s());
}

Result<bool> Shell::isOver(const rsh::Waiting &waiting, bool untilDone) {
    const bool to_end =
        waiting.until == rsh::Until::ENDED || (untilDone && waiting.until != rsh::Until::TAKEN);
    for (const client::Serial serial : waiting.serials) {
        const bool has_ended = commander_.outcome(serial).progress != messages::Progress::STARTED;
        const bool is_shown = view_.status().last_command >= serial;
        if (!is_shown || (to_end && !has_ended)) {
            return false;
        }
    }
    return waiting.isOver && untilDone ? waiting.isOver(view_.status()) : true;
}

/// Waits until the status shows the result of the command.
Result<std::string> Shell::finish(rsh::Waiting waiting) {
    const double end_s = own.timeout_s > 0 ? now_s() + own.timeout_s : 0;
    while (true) {
        const auto read = view_.read();
        const auto machine = view_.check_machine();
        if (!machine.has_value() || !read.has_value()) {
            return machine.has_value() ? read.error().str() : machine.error().str();
        }
        const auto over = isOver(waiting, own.waiting_for_done);
        if (!over.has_value()) {
            return over.error().str();
        }
        if (*over) {
            break;
        }
        if (end_s > 0 && now_s() > end_s) {
            return std::string("timeout");
        }
        commander_.keep_jogging(now_s());
        std::this_thread::sleep_for(LOOK_EVERY);
    }
    for (const client::Serial serial : waiting.serials) {
        const client::Outcome outcome = commander_.outcome(serial);
        if (outcome.progress == messages::Progress::REFUSED ||
            outcome.progress == messages::Progress::FAILED) {
            return outcome.reason;
        }
    }
    return std::string();
}

Result<std::string> Shell::wait(bool untilDone) {
    rsh::Waiting waiting;
    waiting.until = untilDone ? rsh::Until::ENDED : rsh::Until::TAKEN;
    waiting.serials = commander_.last();
    const auto ended = finish(std::move(waiting));
    return ended.has_value() && *ended == "timeout" ? ended : Result<std::string>("");
}

std::optional<std::string> Shell::next_line(messages::MessageKind kind) {
    static_cast<void>(view_.read());
    auto line = view_.next_line(kind, own.lines);
    // As client::shown_message(): texts of programs are not translated.
    return line.has_value() && kind != messages::MessageKind::OPERATOR_DISPLAY ? language::shown(*line)
                                                                               : line;
}

}  // namespace mw::tcl
