// SPDX-License-Identifier: GPL-2.0-or-later
// millwright recover: shows the program that a running machine offers after a power cut, and continues it.
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/text.hh"
#include "hal/core/instance.hh"
#include "messages/client/client.hh"
#include "messages/client/shown_message.hh"
#include "programs/commands.hh"

namespace mw::programs {
namespace {

/// Maximum waits for an answer and for the calculation of a program, which takes many task cycles.
constexpr double ANSWER_S = 5.0, CALCULATED_S = 600.0;

struct RecoverWords {
    bool forgetting = false, agreed = false, only_shown = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright recover [options]",
            "Shows the program that a power cut, a crash or an emergency stop has interrupted, and the line "
            "where it can continue.\nAsks for confirmation of the approach, then continues the program. The "
            "machine must run ('millwright start'), be on\nand homed. The program continues after this "
            "command has ended.\n");
        line.flag("--show", "only show the interrupted program", only_shown);
        line.flag("--forget", "discard the interrupted program", forgetting);
        line.flag("--yes", "move along the approach without confirmation: make sure that it is clear",
                  agreed);
        line.rest(rest);
        line.footer("exit status: 0 done or nothing to continue, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
};

class Recovering {
  public:
    explicit Recovering(client::Client client) : client_(std::move(client)) {}

    Result<> run(const RecoverWords &words) {
        if (const auto read = client_.wait_status(ANSWER_S); !read.has_value()) {
            return read;
        }
        static_cast<void>(client_.read_status());
        const messages::RecoveryStatus &offer = client_.status().recovery;
        if (offer.program.empty()) {
            fmt::print("{}", language::shown("no program was interrupted\n"));
            return {};
        }
        fmt::print("{}", language::shown(fmt::format("{} was interrupted at line {}\n",
                                                     printable(offer.program.str()), offer.line)));
        if (!offer.isOffered) {
            fmt::print("{}", language::shown(fmt::format("it cannot be continued there: {}\n",
                                                         printable(offer.refusal.str()))));
        }
        if (words.forgetting) {
            return ask(messages::ForgetRecovery{});
        }
        if (words.only_shown) {
            return {};
        }
        return go_on(words.agreed);
    }

  private:
    Result<> ask(const messages::Command &command) {
        const auto posted = client_.post(command);
        if (!posted.has_value()) {
            return std::unexpected(posted.error());
        }
        const auto outcome = client_.wait(*posted, ANSWER_S);
        if (!outcome.has_value()) {
            return std::unexpected(outcome.error());
        }
        return outcome->progress == messages::Progress::DONE ? Result<>{} : fail(outcome->reason);
    }

    Result<> go_on(bool agreed) {
        while (client_.next_message(client::Viewer::Reading::LOOKS_ON)
                   .has_value()) {  // discards earlier messages
        }
        if (const auto set = ask(messages::SetMode{messages::Mode::AUTO}); !set.has_value()) {
            return set;
        }
        const auto posted = client_.post(messages::RecoverProgram{});
        if (!posted.has_value()) {
            return std::unexpected(posted.error());
        }
        const auto ended = [&] {
            return client_.outcome(*posted).progress != messages::Progress::STARTED ||
                   (client_.read_status().has_value() && client_.status().approach.number != 0);
        };
        if (const auto waited = client_.wait_until(ended, CALCULATED_S); !waited.has_value()) {
            return waited;
        }
        if (client_.outcome(*posted).progress != messages::Progress::STARTED) {
            return fail(client_.outcome(*posted).reason);
        }
        while (const auto message = client_.next_message(client::Viewer::Reading::LOOKS_ON)) {
            fmt::print("{}\n", printable(client::shown_message(*message)));
        }
        if (!agreed && !hasAgreed()) {
            const auto dropped = ask(messages::AbortAll{});
            return dropped.has_value()
                       ? fail("not confirmed: nothing has moved, and the program can still be continued")
                       : dropped;
        }
        return ask(messages::ConfirmApproach{client_.status().approach.number});
    }

    static bool hasAgreed() {
        if (::isatty(STDIN_FILENO) == 0) {
            return false;
        }
        fmt::print("{}", language::shown("make this move and continue? [y/N] "));
        std::fflush(stdout);
        std::string answer;
        return std::getline(std::cin, answer) && (answer == "y" || answer == "Y");
    }

    client::Client client_;
};

}  // namespace

int command_recover(const std::vector<std::string> &arguments) {
    RecoverWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    auto parsed = words.line().parse(arguments);
    if (parsed.has_value() && !words.rest.empty()) {
        parsed = fail("recover takes no arguments", {}, "millwright recover --help");
    }
    if (!parsed.has_value()) {
        fmt::print(stderr, "millwright recover: {}\n", language::shown(parsed.error().str()));
        return 2;
    }
    auto client = client::Client::connect(hal::default_instance());
    const auto done = client.has_value() ? Recovering(std::move(*client)).run(words)
                                         : Result<>(std::unexpected(client.error()));
    if (!done.has_value()) {
        fmt::print(stderr, "millwright recover: {}\n", language::shown(done.error().str()));
    }
    return done.has_value() ? 0 : 1;
}

}  // namespace mw::programs
