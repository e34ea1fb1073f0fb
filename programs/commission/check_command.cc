// SPDX-License-Identifier: GPL-2.0-or-later
// millwright commission check, tune, report: the steps at the machine, and their findings.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "programs/commission/commissioner.hh"
#include "programs/commission/operator_line.hh"
#include "programs/commission/operator_messages.hh"
#include "programs/commission/parts.hh"
#include "programs/commission/record_file.hh"
#include "programs/commission/report.hh"
#include "programs/setup/changed_machine.hh"

namespace mw::programs::commission {
namespace {

bool isTuning(const commissioning::Step &step) {
    return step.name == "tune" || step.name == "limits";
}

bool isCheck(const commissioning::Step &step) {
    return !isTuning(step);
}

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&now, &utc);
    return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min);
}

int reject(const char *command, const std::string &why, int status) {
    fmt::print(stderr, "millwright commission {}: {}\n", command, language::shown(why));
    return status;
}

struct CheckWords {
    const char *command;
    bool isSimulated = false, isFast = false, isRepeated = false, isScreen = false, areAll = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            std::string("millwright commission ") + command + " FOLDER [options]",
            "Starts the machine in FOLDER and guides you through the steps. Each step shows instructions and "
            "hazards, and moves one\naxis slowly, only while the space bar is pressed. Completed steps are "
            "not repeated. Corrected values are written\ninto the machine's files.\nA script writes lines "
            "instead: confirm, hold SECONDS, number VALUE, choice TEXT, cannot.\n");
        line.flag("--simulate", "run in virtual time, for a machine with a simulated board", isSimulated);
        line.flag("--fast", "with --simulate: run faster than real time", isFast);
        line.flag("--all", "the steps of check and tune", areAll);
        line.flag("--messages", "for a screen: JSON lines instead of text (docs/reference/api.md)", isScreen);
        line.flag("--again", "repeat all steps", isRepeated);
        line.rest(rest);
        line.footer("exit status: 0 the steps are done without a fault, 1 a fault, 2 wrong usage\n");
        return line;
    }
};

/// Runs the steps. An error ends the session.
class CheckSession {
  public:
    CheckSession(CheckWords &words, Commissioner &commissioner, OperatorChannel &channel)
        : words_(words), commissioner_(commissioner), operator_(channel) {}

    Result<> run() {
        commissioning::Guide &guide = commissioner_.guide();
        std::size_t shown = guide.current();
        const auto start = std::chrono::steady_clock::now();
        const std::int64_t start_ns = commissioner_.machine().now_ns();
        std::int64_t passed_ns = 0, last_ns = start_ns;
        while (!guide.isOver()) {
            if (stop_signal != 0) {
                guide.stop();
                return fail("stopped by " + stop_signal_name());
            }
            constexpr double S_PER_NS = 1e-9;
            if (!operator_.look(guide, static_cast<double>(passed_ns) * S_PER_NS)) {
                guide.stop();
                return fail("the input has ended: the machine is switched off");
            }
            if (auto done = commissioner_.cycle(); !done.has_value()) {
                return done;
            }
            // A restarted machine has a new clock.
            const std::int64_t now_ns = commissioner_.machine().now_ns();
            passed_ns += std::max<std::int64_t>(0, now_ns - last_ns);
            last_ns = now_ns;
            if (words_.isSimulated && !words_.isFast) {
                std::this_thread::sleep_until(start + std::chrono::nanoseconds(passed_ns));
            }
            for (; shown < guide.current() || (guide.isFaulted() && shown == guide.current()); ++shown) {
                if (guide.findings()[shown].has_value()) {
                    operator_.show_finding(guide.steps()[shown], *guide.findings()[shown]);
                }
            }
        }
        return {};
    }

  private:
    CheckWords &words_;
    Commissioner &commissioner_;
    OperatorChannel &operator_;
};

int run_steps(const char *command, const std::vector<std::string> &arguments,
              bool (*isWanted)(const commissioning::Step &)) {
    CheckWords words{.command = command, .rest = {}};
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || words.rest.size() != 1) {
        return reject(command, parsed.has_value() ? "needs the folder of a machine" : parsed.error().str(),
                      2);
    }
    const std::string &folder = words.rest[0];
    const auto answers = recorded_answers(folder);
    const auto record = read_record(folder);
    if (!answers.has_value() || !record.has_value()) {
        return reject(command, answers.has_value() ? record.error().str() : answers.error().str(), 1);
    }
    const setup::Plan plan = setup::plan_of(*answers).plan;
    if (words.isSimulated && plan.hasBoard() && !plan.wiring.isSimulated) {
        return reject(
            command,
            "the board of this machine is real, and --simulate would write practice values into its "
            "files: practise with a machine of board.simulated=yes",
            2);
    }
    catch_stop_signals();
    // Programs of HAL files search for the machine's files in the current folder.
    std::error_code error;
    const std::string machine_folder = std::filesystem::absolute(folder, error).string();
    std::filesystem::current_path(machine_folder, error);
    const std::unique_ptr<OperatorChannel> channel =
        words.isScreen ? std::unique_ptr<OperatorChannel>(std::make_unique<OperatorMessages>())
                       : std::make_unique<OperatorLine>();
    CommissionSetup setup{.folder = machine_folder,
                          .clock_virtual = words.isSimulated,
                          .known = words.isRepeated ? std::vector<commissioning::Finding>{}
                                                    : valid_findings(*record, *answers),
                          .isWanted = words.areAll ? nullptr : isWanted,
                          .prepare = {},
                          .on_start = {},
                          .wrap = {}};
    auto commissioner = Commissioner::open(std::move(setup));
    if (!commissioner.has_value()) {
        channel->show_failure(commissioner.error().str());
        return reject(command, commissioner.error().str(), 1);
    }
    const auto ran = CheckSession(words, **commissioner, *channel).run();
    (*commissioner)->stop();
    const commissioning::Guide &guide = (*commissioner)->guide();
    const auto written = write_record(machine_folder, guide, now_text(), MW_VERSION);
    const std::string why = !ran.has_value()       ? ran.error().str()
                            : !written.has_value() ? written.error().str()
                                                   : "";
    channel->show_end(guide, why);
    if (!why.empty() || guide.isFaulted()) {
        return reject(command, why.empty() ? "stopped at a fault; the same command continues there" : why, 1);
    }
    return 0;
}

struct ReportWords {
    std::string html;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line("millwright commission report FOLDER [options]",
                                  "Prints the commissioning report: values, dates, versions, an acceptance "
                                  "checklist and a signature field.\n");
        line.text("--html", "FILE", "write a printable HTML page instead", html);
        line.rest(rest);
        line.footer("exit status: 0 done, 1 rejected, 2 wrong usage\n");
        return line;
    }
};

}  // namespace

int command_check(const std::vector<std::string> &words) {
    return run_steps("check", words, isCheck);
}

int command_tune(const std::vector<std::string> &words) {
    return run_steps("tune", words, isTuning);
}

int command_report(const std::vector<std::string> &arguments) {
    ReportWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || words.rest.size() != 1) {
        return reject("report", parsed.has_value() ? "needs the folder of a machine" : parsed.error().str(),
                      2);
    }
    const auto answers = recorded_answers(words.rest[0]);
    const auto record = read_record(words.rest[0]);
    if (!answers.has_value() || !record.has_value()) {
        return reject("report", answers.has_value() ? record.error().str() : answers.error().str(), 1);
    }
    const ReportFacts facts{words.rest[0], MW_VERSION, now_text() + " UTC", *answers, *record};
    if (words.html.empty()) {
        fmt::print("{}", report_text(facts));
        return 0;
    }
    const auto written = write_file_atomically(words.html, report_html(facts));
    return written.has_value() ? 0 : reject("report", written.error().str(), 1);
}

}  // namespace mw::programs::commission
