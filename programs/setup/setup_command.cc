// SPDX-License-Identifier: GPL-2.0-or-later
// millwright setup: creates a new machine from answers.
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "programs/commands.hh"
#include "programs/setup/new_machine.hh"

namespace mw::programs {
namespace {

struct SetupWords {
    std::string answers;
    bool tried = true, questions_shown = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright setup FOLDER [KEY=VALUE ...] [options]",
            "Writes the configuration of a new machine into a folder: commented INI and HAL files, a tool "
            "table, a first program;\nthen starts it in virtual time and runs that program. Keys without an "
            "answer use presets; kind= is mill, router, gantry,\nlathe, foam, plasma, mill4 or mill5, units= "
            "mm or inch, drives= simulated, stepper or servo.\n");
        line.flag("--questions",
                  "print all keys of this machine type with presets and ranges, and write nothing",
                  questions_shown);
        line.text("--answers", "FILE", "file with lines of 'key = value'; the command line overrides them",
                  answers);
        line.flag("--no-check", "do not start the machine", tried, false);
        line.rest(rest);
        line.footer(
            "exit status: 0 the configuration was written and runs, 1 rejected or failed, 2 wrong usage\n");
        return line;
    }
};

Result<setup::Answers> answers_of(const SetupWords &words) {
    setup::Answers answers;
    if (!words.answers.empty()) {
        const auto text = read_file(words.answers);
        auto read = text.has_value() ? read_answers(*text, words.answers) : std::unexpected(text.error());
        if (!read.has_value()) {
            return read;
        }
        answers = std::move(*read);
    }
    std::string lines;
    for (std::size_t i = words.questions_shown ? 0 : 1; i < words.rest.size(); ++i) {
        lines += words.rest[i] + '\n';
    }
    auto given = read_answers(lines, "");
    if (!given.has_value()) {
        return fail(given.error().message);
    }
    for (auto &[key, value] : *given) {
        answers[key] = std::move(value);
    }
    return answers;
}

void show_questions(const setup::Answers &answers) {
    const auto asked = setup::questions(answers);
    for (const setup::Question &question : asked) {
        fmt::print("{} = {}   # {}{}\n", question.key, setup::answer_of(asked, answers, question.key),
                   question.text, setup::range_of(question));
    }
}

Result<> make_and_try(const SetupWords &words, const setup::Answers &answers, const setup::Plan &plan) {
    const auto machine = make_machine(words.rest[0], plan, answers);
    if (!machine.has_value()) {
        return std::unexpected(machine.error());
    }
    fmt::print("{}\n", machine->ini);
    if (!words.tried) {
        return {};
    }
    const auto trial = try_machine(*machine);
    if (!trial.has_value()) {
        return std::unexpected(trial.error());
    }
    fmt::print("{}", printable(trial->output));
    if (!trial->good) {
        return fail("the test run of the first program failed; the files of the machine are kept");
    }
    fmt::print("It runs in virtual time. To start it with its screen: linuxcnc {}\n",
               shell_word(machine->ini));
    return {};
}

}  // namespace

int command_setup(const std::vector<std::string> &arguments) {
    SetupWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || (words.rest.empty() && !words.questions_shown)) {
        fmt::print(stderr, "millwright setup: {}\n",
                   parsed.has_value() ? "needs a folder: millwright setup FOLDER kind=mill"
                                      : parsed.error().str());
        return 2;
    }
    const auto answers = answers_of(words);
    if (!answers.has_value()) {
        fmt::print(stderr, "millwright setup: {}\n", language::shown(answers.error().str()));
        return 2;
    }
    if (words.questions_shown) {
        show_questions(*answers);
        return 0;
    }
    const auto planned = setup::plan_of(*answers);
    for (const setup::Fault &fault : planned.faults) {
        fmt::print(stderr, "millwright setup: {}: {}\n", printable(fault.key), fault.text);
    }
    if (!planned.faults.empty()) {
        return 1;
    }
    catch_stop_signals();
    const auto made = make_and_try(words, *answers, planned.plan);
    if (!made.has_value()) {
        fmt::print(stderr, "millwright setup: {}\n", language::shown(made.error().str()));
    }
    return made.has_value() ? 0 : 1;
}

}  // namespace mw::programs
