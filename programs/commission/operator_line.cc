// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/commission/operator_line.hh"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/language/language.hh"
#include "base/text.hh"

namespace mw::programs {

using commissioning::Act;
using commissioning::Ask;
using commissioning::Prompt;

bool read_standard_input(std::string &input) {
    std::array<char, 4096> part{};
    pollfd look{STDIN_FILENO, POLLIN, 0};
    while (::poll(&look, 1, 0) > 0) {
        const ssize_t size = ::read(STDIN_FILENO, part.data(), part.size());
        if (size > 0) {
            input.append(part.data(), static_cast<std::size_t>(size));
        } else if (size == 0 || errno != EINTR) {
            return false;
        }
    }
    return true;
}

OperatorLine::OperatorLine() : keyboard_(Keyboard::isThere() ? std::make_unique<Keyboard>() : nullptr) {}

std::string OperatorLine::shown(std::string_view english) const {
    return keyboard_ != nullptr ? language::shown(english) : std::string(english);
}

void OperatorLine::show(const commissioning::Guide &guide) {
    const Prompt &prompt = guide.prompt();
    if (prompt.text.empty()) {
        return;
    }
    for (const std::string &hazard : prompt.hazards) {
        fmt::print("! {}\n", shown(hazard));
    }
    fmt::print("[{}] {}: {}{}{}\n", prompt.step, ask_name(prompt.ask), shown(prompt.text),
               prompt.unit.empty() ? "" : " [" + prompt.unit + "]",
               prompt.choices.empty() ? "" : fmt::format(" ({})", fmt::join(prompt.choices, ", ")));
    if (!prompt.watch.empty()) {
        fmt::print("    Watch: {}\n", shown(prompt.watch));
    }
    std::fflush(stdout);
}

/// False at the end of the input.
bool OperatorLine::read(double now_s) {
    if (keyboard_ != nullptr) {
        isSpaceHeld_ = false;
        while (const auto key = keyboard_->read()) {
            const bool is_space = *key == ' ' && input_.empty();
            isSpaceHeld_ = isSpaceHeld_ || is_space;
            input_ += is_space ? "" : std::string(1, *key == '\r' ? '\n' : *key);
        }
        if (isSpaceHeld_) {
            constexpr double RELEASED_S = 0.25;
            pressed_for_ = now_s > space_seen_s_ + RELEASED_S ? shown_ : pressed_for_;
            space_seen_s_ = now_s;
        }
        return true;
    }
    return read_standard_input(input_);
}

void OperatorLine::take(commissioning::Guide &guide, double now_s, const std::string &line) {
    const std::string_view words = trim(line);
    const std::size_t space = std::min(words.find(' '), words.size());
    const std::string_view verb = words.substr(0, space), rest = trim(words.substr(space));
    const auto number = parse_double(rest);
    const Prompt &prompt = guide.prompt();
    Act act;
    if (verb == "hold") {
        held_until_s_ = now_s + number.value_or(1);
        return;
    }
    if (verb == "cannot") {
        act.type = Act::Type::CANNOT;
    } else if (verb == "number" || (prompt.ask == Ask::NUMBER && parse_double(words).has_value())) {
        act = {.type = Act::Type::NUMBER,
               .number = verb == "number" ? number.value_or(0) : *parse_double(words),
               .choice = ""};
        if (verb == "number" && !number.has_value()) {
            fmt::print("? '{}' is not a number\n", printable(std::string(rest)));
            return;
        }
    } else if (verb == "choice" || prompt.ask == Ask::CHOICE) {
        act = {
            .type = Act::Type::CHOICE, .number = 0, .choice = std::string(verb == "choice" ? rest : words)};
    }
    if (!guide.act(guide.prompt_number(), act)) {
        fmt::print("? '{}' is not a valid answer; valid are: {}, or cannot\n", printable(std::string(words)),
                   ask_name(prompt.ask));
        std::fflush(stdout);
    }
}

void OperatorLine::show_finding(const commissioning::Step &step, const commissioning::Finding &finding) {
    fmt::print("{}: {}{}\n", shown(step.title),
               finding.fault == commissioning::Fault::NONE
                   ? "passed"
                   : "FAULT: " + shown(commissioning::fault_name(finding.fault)),
               finding.detail.empty() ? "" : " (" + shown(finding.detail) + ")");
    for (const commissioning::Value &value : finding.values) {
        fmt::print("    {}: {:.6g} {}\n", shown(value.name), value.number, value.unit);
    }
    if (finding.fault != commissioning::Fault::NONE) {
        fmt::print("    {}\n", shown(commissioning::fault_remedy(finding.fault)));
    }
    std::fflush(stdout);
}

void OperatorLine::show_end(const commissioning::Guide &guide, const std::string &error) {
    if (error.empty() && !guide.isFaulted()) {
        fmt::print("{}\n",
                   guide.isReady()
                       ? "The machine is ready."
                       : "These steps are done. `millwright commission report` shows the remaining steps.");
    }
}

bool OperatorLine::look(commissioning::Guide &guide, double now_s) {
    if (guide.prompt_number() != shown_) {
        shown_ = guide.prompt_number();
        held_until_s_ = -1;
        // Characters typed before the question are not an answer to it.
        while (keyboard_ != nullptr && keyboard_->read().has_value()) {
        }
        input_ = keyboard_ != nullptr ? "" : input_;
        show(guide);
    }
    isEnded_ = isEnded_ || !read(now_s);
    const bool is_answered = guide.prompt().ask != Ask::NOTHING && guide.prompt().ask != Ask::ACTION;
    const std::size_t end = input_.find('\n');
    // A script that is ahead of the machine waits for the next question.
    if (is_answered && held_until_s_ < now_s && end != std::string::npos) {
        const std::string line = input_.substr(0, end);
        input_.erase(0, end + 1);
        if (!line.starts_with('#')) {
            take(guide, now_s, line);
        }
    }
    if (now_s < held_until_s_ || isSpaceHeld_) {
        static_cast<void>(guide.act(isSpaceHeld_ ? pressed_for_ : shown_, {Act::Type::HOLD, 0, ""}));
    }
    return !isEnded_ || !input_.empty() || now_s < held_until_s_ || !is_answered;
}

}  // namespace mw::programs
