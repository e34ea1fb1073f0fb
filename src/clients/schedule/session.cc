// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/schedule/session.hh"

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/schedule/words.hh"

namespace mw::schedule {
namespace {

constexpr const char *PROTOCOL = "1.1";
/// Line ends as in LinuxCNC.
constexpr const char *AFTER_SET = "\n\r", *AFTER_REFUSED_GET = "\r\n\r\n";

}  // namespace

void Session::step(double) {
    while (!isOver_ && output_.size() < MAX_WAITING) {
        const auto line = input_.next();
        if (!line.has_value()) {
            break;
        }
        if (line->isTooLong) {
            refuse("LINE", fmt::format("the line has more than {} bytes", rsh::MAX_LINE));
        } else {
            carry_out(line->text);
        }
    }
    isOver_ = isOver_ || (input_.isOver() && input_.waiting() == 0);
}

void Session::carry_out(const std::string &line) {
    const rsh::Words words = split_words(line);
    const std::string command = to_upper(words[0]);
    if (own_.greeted && own_.isEchoing && command != "HELLO") {
        output_ += line + "\r\n";
    }
    const rsh::Words behind(words.begin() + 1, words.end());
    if (command == "HELLO") {
        hello(behind);
    } else if (command == "GET") {
        get(behind);
    } else if (command == "SET") {
        set(behind);
    } else if (command == "HELP") {
        for (const std::string &text : help(behind.empty() ? "" : to_upper(behind[0]))) {
            say(text);
        }
    } else if (command == "QUIT") {
        isOver_ = true;
    } else if (command == "SHUTDOWN") {
        shut_down();
    } else {
        refuse(printable(command), fmt::format("Unknown command '{}'", printable(words[0])));
    }
}

void Session::hello(const rsh::Words &words) {
    constexpr std::size_t PASSWORD_NAME_AND_VERSION = 3;
    if (words.size() < PASSWORD_NAME_AND_VERSION ||
        !rsh::isSamePassword(words[0], shared_.settings.connect_password)) {
        own_.greeted = own_.isEnabled = false;
        say("HELLO NAK");
        return;
    }
    own_.greeted = true;
    own_.protocol = words[2];
    say(fmt::format("HELLO ACK {} {}", shared_.settings.name, PROTOCOL));
}

void Session::get(const rsh::Words &words) {
    if (words.empty()) {
        say("GET NAK", AFTER_REFUSED_GET);
        return;
    }
    const std::string name = to_upper(words[0]);
    const auto answer = answer_to(name, {shared_, own_, {words.begin() + 1, words.end()}});
    if (!answer.has_value()) {
        if (own_.isVerbose) {
            say("error: " + answer.error().str());
        }
        say(fmt::format("GET {} NAK", printable(name)), AFTER_REFUSED_GET);
        return;
    }
    for (const std::string &line : *answer) {
        say(line);
    }
}

void Session::set(const rsh::Words &words) {
    if (words.empty() || !own_.greeted) {
        say("SET NAK");
        return;
    }
    const std::string name = to_upper(words[0]);
    const auto done = carry_out_order(name, {shared_, own_, {words.begin() + 1, words.end()}});
    if (!done.has_value()) {
        refuse(printable(name), done.error().str());
    } else if (own_.isVerbose) {
        say(fmt::format("SET {} ACK", name), AFTER_SET);
    }
}

void Session::shut_down() {
    if (!own_.greeted || !own_.isEnabled) {
        refuse("SHUTDOWN", "Connection must be 'ENABLED' for SHUTDOWN");
        return;
    }
    isOver_ = wantsShutdown_ = true;
}

void Session::say(const std::string &line, const char *end) {
    output_ += line;
    output_ += end;
}

void Session::refuse(const std::string &order, const std::string &why) {
    if (own_.isVerbose) {
        say("error: " + why);
    }
    say(fmt::format("SET {} NAK", order), AFTER_SET);
}

}  // namespace mw::schedule
