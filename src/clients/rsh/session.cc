// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/session.hh"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/rsh/answers.hh"
#include "clients/rsh/help.hh"

namespace mw::rsh {
namespace {

constexpr const char *PROTOCOL = "1.1";

}  // namespace

Session::Session(const Settings &settings, SharedView &shared, Joining joining)
    : settings_(settings), shared_(shared), commander_(std::move(joining)) {
    own_.lines = shared.unread();
    own_.waiting_for_done = !settings.isOld();
    ++shared_.num_sessions;
}

Session::~Session() {
    --shared_.num_sessions;
}

void Session::take(std::string_view bytes) {
    input_.take(bytes);
}

std::optional<std::string> Session::next_line() {
    while (auto line = input_.next()) {
        if (!line->isTooLong) {
            return std::move(line->text);
        }
        refuse("LINE", fmt::format("the line has more than {} bytes", MAX_LINE));
    }
    return std::nullopt;
}

void Session::step(double now_s) {
    commander_.keep_jogging(now_s);
    look_at_wait(now_s);
    while (!wait_.has_value() && !isOver_ && output_.size() < MAX_WAITING) {
        const auto line = next_line();
        if (!line.has_value()) {
            break;
        }
        carry_out(*line, now_s);
        look_at_wait(now_s);
    }
    const bool answered = !wait_.has_value() && input_.waiting() == 0;
    if (input_.isOver() && answered) {
        commander_.stop_jogs();
        isOver_ = true;
    }
}

void Session::carry_out(const std::string &line, double now_s) {
    const Words words = split_words(line);
    const std::string command = to_upper(words[0]);
    if (own_.greeted && own_.isEchoing && command != "HELLO") {
        output_ += line + "\r\n";
    }
    const Words behind(words.begin() + 1, words.end());
    if (command == "HELLO") {
        hello(behind);
    } else if (command == "GET") {
        get(behind);
    } else if (command == "SET") {
        set(behind, behind_words(line, 2), now_s);
    } else if (command == "HELP") {
        for (const std::string &text : help(settings_, behind.empty() ? "" : to_upper(behind[0]))) {
            say(text);
        }
    } else if (command == "QUIT") {
        if (!settings_.isOld()) {
            say("QUIT ACK");
        }
        isOver_ = true;
    } else if (command == "SHUTDOWN") {
        shut_down();
    } else if (!settings_.isOld()) {
        tell_error(fmt::format("Unknown command '{}'", printable(words[0])));
        say(printable(command) + " NAK");
    }
}

void Session::hello(const Words &words) {
    constexpr std::size_t PASSWORD_AND_NAME = 2;
    if (words.size() < PASSWORD_AND_NAME || !isSamePassword(words[0], settings_.connect_password)) {
        if (!settings_.isOld()) {
            own_.greeted = own_.isEnabled = false;
        }
        say("HELLO NAK");
        return;
    }
    own_.greeted = true;
    own_.protocol = words.size() > PASSWORD_AND_NAME && settings_.isOld() ? words[2] : PROTOCOL;
    say(fmt::format("HELLO ACK {} {}", settings_.name, PROTOCOL));
}

void Session::get(const Words &words) {
    if (words.empty()) {
        tell_error("GET needs a question");
        say("GET NAK");
        return;
    }
    const std::string name = to_upper(words[0]);
    const Words behind(words.begin() + 1, words.end());
    const Answering answering = rsh::answering(settings_, name);
    const bool is_local = name == "ERROR" && !errors_.empty();
    if (is_local) {
        say("ERROR " + errors_.front());
        errors_.pop_front();
        return;
    }
    const messages::MachineStatus &status = own_.kept != nullptr ? *own_.kept : shared_.status();
    const Answer answer = answering == nullptr ? fail(fmt::format("Unknown question '{}'", printable(name)))
                                               : answering({settings_, shared_, own_, status, behind});
    const bool only_order = answering == nullptr && find_order(settings_, name) != nullptr;
    if (only_order && !settings_.isOld()) {
        return;  // scripts use GET for settings without a value, and expect no line
    }
    if (!answer.has_value()) {
        tell_error(answer.error().str());
        say(fmt::format("GET {} NAK", printable(name)), settings_.isOld() ? "\r\n\r\n" : "\r\n");
        return;
    }
    for (const std::string &line : *answer) {
        say(line);
    }
}

std::optional<std::string> Session::lacks(const Order &order) const {
    if (order.needs >= Needs::HELLO && !own_.greeted) {
        return fmt::format("HELLO must come before SET {}", order.name);
    }
    if (order.needs >= Needs::ENABLE && !own_.isEnabled) {
        return fmt::format("Connection must be 'ENABLED' for SET {}", order.name);
    }
    if (order.needs >= Needs::MACHINE_ON && shared_.status().task.state != messages::State::ON) {
        return fmt::format("Machine must be 'ON' for SET {}", order.name);
    }
    return std::nullopt;
}

void Session::set(const Words &words, const std::string &rest, double now_s) {
    const bool mute = settings_.isOld() && !own_.greeted;
    if (words.empty() || mute) {
        tell_error(mute ? "HELLO must come before SET" : "SET needs an order");
        say("SET NAK", mute || !settings_.isOld() ? "\r\n" : "\n\r");
        return;
    }
    const std::string name = to_upper(words[0]);
    const Order *const order = find_order(settings_, name);
    if (order == nullptr) {
        refuse(printable(name), fmt::format("Unknown order '{}'", printable(name)));
        return;
    }
    if (const auto lack = lacks(*order)) {
        refuse(name, *lack);
        return;
    }
    commander_.begin_order();
    const Words behind(words.begin() + 1, words.end());
    auto waiting = order->ordering({settings_, shared_, own_, commander_, errors_, behind, rest});
    if (!waiting.has_value()) {
        refuse(name, waiting.error().str());
        return;
    }
    if (waiting->until == Until::AS_SET && !own_.waiting_for_done) {
        waiting->until = Until::TAKEN;
    }
    wait_.emplace(Wait{name, std::move(*waiting), own_.timeout_s > 0 ? now_s + own_.timeout_s : 0, 0});
}

void Session::shut_down() {
    if (!own_.greeted || !own_.isEnabled) {
        tell_error("Connection must be 'ENABLED' for SHUTDOWN");
        say("SHUTDOWN NAK");
        return;
    }
    if (!settings_.isOld()) {
        say("SHUTDOWN ACK");
    }
    commander_.stop_jogs();
    isOver_ = wantsShutdown_ = true;
}

bool Session::isProbeWithoutContact(const client::Outcome &outcome) const {
    return wait_->what.isProbe && outcome.progress == messages::Progress::FAILED &&
           outcome.reason.find("without making contact") != std::string::npos;
}

std::optional<Result<>> Session::end_of(const Waiting &waiting) {
    for (const client::Serial serial : waiting.serials) {
        const client::Outcome outcome = commander_.outcome(serial);
        const bool taken =
            outcome.progress != messages::Progress::STARTED || shared_.status().last_command >= serial;
        const bool taken_enough = waiting.until == Until::TAKEN || waiting.until == Until::WHATEVER_TAKEN;
        const bool ended = taken_enough ? taken : outcome.progress != messages::Progress::STARTED;
        if (!ended) {
            return std::nullopt;
        }
        const bool bad =
            outcome.progress == messages::Progress::REFUSED || outcome.progress == messages::Progress::FAILED;
        const bool may_be_bad = waiting.until == Until::WHATEVER || waiting.until == Until::WHATEVER_TAKEN ||
                                isProbeWithoutContact(outcome) || (settings_.isOld() && taken_enough);
        if (bad && !may_be_bad) {
            return Result<>(fail(""));
        }
    }
    if (!waiting.isOver) {
        return Result<>();
    }
    const auto isOver = waiting.isOver(shared_.status());
    if (!isOver.has_value()) {
        return Result<>(std::unexpected(isOver.error()));
    }
    return *isOver ? std::optional(Result<>()) : std::nullopt;
}

void Session::look_at_wait(double now_s) {
    if (!wait_.has_value()) {
        return;
    }
    const auto end = end_of(wait_->what);
    const bool late = wait_->end_s > 0 && now_s >= wait_->end_s;
    if (!end.has_value() && !late) {
        return;
    }
    // Cycles until the status shows the change of an order.
    constexpr std::uint64_t CYCLES_TO_SHOW = 3;
    const bool is_shown = !end.has_value() || wait_->what.serials.empty() || !own_.waiting_for_done;
    if (!is_shown && wait_->shown_cycle == 0) {
        wait_->shown_cycle = shared_.status().cycle + CYCLES_TO_SHOW;
    }
    if (!is_shown && shared_.status().cycle < wait_->shown_cycle) {
        return;
    }
    const std::string order = wait_->order;
    if (!end.has_value()) {
        refuse(order, fmt::format("it has not ended within {:f} seconds", own_.timeout_s));
    } else if (end->has_value()) {
        consent(order);
    } else {
        refuse(order, end->error().str());
    }
    wait_.reset();
}

void Session::say(const std::string &line, const char *end) {
    if (own_.isTimed) {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        output_ += fmt::format("{:.6f} ", std::chrono::duration<double>(now).count());
    }
    output_ += line;
    output_ += end;
}

void Session::tell_error(const std::string &text) {
    if (own_.isVerbose && !settings_.isOld() && !text.empty()) {
        say("error: " + text);
    }
}

void Session::consent(const std::string &order) {
    if (own_.isVerbose) {
        say(fmt::format("SET {} ACK", order), settings_.isOld() ? "\n\r" : "\r\n");
    }
}

void Session::refuse(const std::string &order, const std::string &why) {
    tell_error(why);
    say(fmt::format("SET {} NAK", order), settings_.isOld() ? "\n\r" : "\r\n");
}

}  // namespace mw::rsh
