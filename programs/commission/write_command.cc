// SPDX-License-Identifier: GPL-2.0-or-later
// millwright commission describe, write: the answers about a machine, and its files.
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/text.hh"
#include "programs/commission/parts.hh"
#include "programs/setup/changed_machine.hh"
#include "programs/setup/new_machine.hh"

namespace mw::programs::commission {
namespace {

namespace fs = std::filesystem;

struct WriteWords {
    bool isEditKept = false, isNewTaken = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright commission write FOLDER [KEY=VALUE ...] [options]",
            "Writes the files of a machine into a new folder, or again into the folder of a machine with "
            "other answers.\nYour edits of the files are kept. If an edit and a new answer change the same "
            "lines, nothing is written and the conflict is shown.\n");
        line.flag("--keep", "conflicts: keep the edited lines", isEditKept);
        line.flag("--replace", "conflicts: use the new lines; the edited file is saved as FILE~", isNewTaken);
        line.rest(rest);
        line.footer("exit status: 0 written, 1 rejected or a conflict, 2 wrong usage\n");
        return line;
    }
    ConflictRule rule() const {
        return isNewTaken   ? ConflictRule::TAKE_NEW
               : isEditKept ? ConflictRule::KEEP_EDITED
                            : ConflictRule::REPORT;
    }
};

struct DescribeWords {
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line("millwright commission describe [FOLDER] [KEY=VALUE ...]",
                                  "Prints the questions about a machine: key, answer, text, range and the "
                                  "reason of the preset.\nWith FOLDER: for the machine in this folder.\n");
        line.rest(rest);
        line.footer("exit status: 0 all answers are valid, 1 an answer is not valid, 2 wrong usage\n");
        return line;
    }
};

bool isFolder(const options::Words &words) {
    return !words.empty() && words[0].find('=') == std::string::npos;
}

/// The recorded answers of a folder, replaced by those of the command line where given.
Result<setup::Answers> answers_of(const options::Words &words, bool isRecorded) {
    setup::Answers answers;
    if (isRecorded) {
        auto recorded = recorded_answers(words[0]);
        if (!recorded.has_value()) {
            return recorded;
        }
        answers = std::move(*recorded);
    }
    std::string lines;
    for (std::size_t i = isFolder(words) ? 1 : 0; i < words.size(); ++i) {
        lines += words[i] + '\n';
    }
    auto given = read_answers(lines, "");
    if (!given.has_value()) {
        return fail(given.error().message);
    }
    return isRecorded ? changed_answers(answers, *given) : *given;
}

int report_faults(const setup::Planned &planned, const char *command) {
    for (const setup::Fault &fault : planned.faults) {
        fmt::print(stderr, "millwright commission {}: {}: {}\n", command, printable(fault.key), fault.text);
    }
    return planned.faults.empty() ? 0 : 1;
}

int reject(const char *command, const std::string &why, int status) {
    fmt::print(stderr, "millwright commission {}: {}\n", command, language::shown(why));
    return status;
}

bool isMachineThere(const std::string &folder) {
    std::error_code error;
    return fs::exists(fs::path(folder) / ANSWERS_FILE, error);
}

void show(const setup::Answers &answers) {
    const auto asked = setup::questions(answers);
    for (const setup::Question &question : asked) {
        fmt::print("{} = {}\n    {}{}", question.key, setup::answer_of(asked, answers, question.key),
                   question.text, setup::range_of(question));
        fmt::print("\n    {} is the preset. {}\n", question.preset, question.reason);
    }
}

}  // namespace

int command_describe(const std::vector<std::string> &arguments) {
    DescribeWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    if (const auto parsed = words.line().parse(arguments); !parsed.has_value()) {
        return reject("describe", parsed.error().str(), 2);
    }
    const auto answers = answers_of(words.rest, isFolder(words.rest));
    if (!answers.has_value()) {
        return reject("describe", answers.error().str(), 2);
    }
    show(*answers);
    return report_faults(setup::plan_of(*answers), "describe");
}

int command_write(const std::vector<std::string> &arguments) {
    WriteWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || !isFolder(words.rest) || (words.isEditKept && words.isNewTaken)) {
        return reject("write",
                      !parsed.has_value()     ? parsed.error().str()
                      : !isFolder(words.rest) ? "needs a folder: millwright commission write FOLDER kind=mill"
                                              : "--keep and --replace cannot be combined",
                      2);
    }
    const std::string &folder = words.rest[0];
    const bool present = isMachineThere(folder);
    const auto answers = answers_of(words.rest, present);
    if (!answers.has_value()) {
        return reject("write", answers.error().str(), 2);
    }
    const auto planned = setup::plan_of(*answers);
    if (!planned.faults.empty()) {
        return report_faults(planned, "write");
    }
    if (!present) {
        const auto made = make_machine(folder, planned.plan, *answers);
        if (!made.has_value()) {
            return reject("write", made.error().str(), 1);
        }
        fmt::print("{}\n", made->ini);
        return 0;
    }
    const auto change = change_machine(folder, planned.plan, *answers, words.rule());
    if (!change.has_value()) {
        return reject("write", change.error().str(), 1);
    }
    fmt::print("{}", change_text(*change));
    if (!change->isWritten) {
        return reject("write",
                      "nothing is written because of the conflicts; --keep or --replace resolves them", 1);
    }
    return 0;
}

}  // namespace mw::programs::commission
