// SPDX-License-Identifier: GPL-2.0-or-later
// Random sessions at random machines, docs/motion/campaign.md. Every seed runs in a process of its own, so
// that nothing is carried over and a crash is a verdict.
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/text.hh"
#include "campaign/session.hh"
#include "options/command_line.hh"

namespace mw::campaign {
namespace {

struct Task {
    unsigned first = 1, count = 100, processes = 2, plan = PLAN_VERSION;
    std::string log, kept, commit, trace;
    std::set<std::string> known;
    bool isTold = false, isShrunk = true, isAnew = false;
    double patience_s = 120;
};

std::string line_of(const Verdict &v) {
    std::string out =
        fmt::format("{:.1f} s {} stops {}/{} programs {} timed {}/{} refused stop {:.2f} {:016x} {}",
                    v.seconds, v.stops, v.ended, v.programs, v.timed, v.refused, v.commands, v.slowest_stop,
                    v.hash, v.fault.empty() ? "ok" : "FAILED " + v.fault);
    for (const auto &[rule, count] : v.known) {
        out += fmt::format(" | {} x known: {}", count, rule);
    }
    for (const auto &[name, e] : v.extensions) {
        out += e.ran > 0 ? fmt::format(" | with {} {} {}", name, e.ran, e.judged) : std::string();
    }
    for (const auto &[reason, count] : v.refusals) {
        out += fmt::format(" | {} x {}", count, reason);
    }
    std::ranges::replace(out, '\n', ' ');
    return out;
}

/// In a process of its own; one line.
std::string drive(const Task &task, unsigned seed, const std::string &kept) {
    int ends[2];
    if (::pipe(ends) != 0) {
        return "FAILED no pipe";
    }
    std::fflush(stdout);  // the child has a copy of what is not written yet
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        const auto folder =
            std::filesystem::temp_directory_path() / fmt::format("mw_campaign_{}", ::getpid());
        std::filesystem::create_directory(folder);
        const Plan plan = reduced(make_plan(seed, task.plan), kept);
        const std::string line =
            line_of(Session(plan, folder, {task.isTold ? stdout : nullptr, task.trace, task.known}).run()) +
            '\n';
        if (!task.isTold) {
            std::filesystem::remove_all(folder);
        } else {
            std::printf("files in %s\n", folder.c_str());
        }
        std::fflush(stdout);
        const bool isWritten =
            ::write(ends[1], line.data(), line.size()) == static_cast<ssize_t>(line.size());
        ::_exit(isWritten ? 0 : 1);
    }
    ::close(ends[1]);
    std::string line;
    char buffer[4096];
    pollfd waiting{ends[0], POLLIN, 0};
    bool isLate = false;
    while (line.find('\n') == std::string::npos) {
        if (::poll(&waiting, 1, static_cast<int>(task.patience_s * 1000)) <= 0) {
            ::kill(child, SIGKILL);
            isLate = true;
            break;
        }
        const ssize_t size = ::read(ends[0], buffer, sizeof buffer);
        if (size <= 0) {
            break;
        }
        line.append(buffer, static_cast<std::size_t>(size));
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (line.empty()) {
        std::filesystem::remove_all(std::filesystem::temp_directory_path() /
                                    fmt::format("mw_campaign_{}", child));
        return isLate
                   ? "FAILED hang: no verdict in time"
                   : fmt::format("FAILED crash: status {}", WIFSIGNALED(status) ? WTERMSIG(status) : status);
    }
    return line.substr(0, line.find('\n'));
}

/// "limit" of "... FAILED limit: joint 0 ..."; empty when all held.
std::string rule_of(const std::string &line) {
    const std::size_t at = line.find("FAILED ");
    return at == std::string::npos ? std::string() : line.substr(at + 7, line.find(':', at) - at - 7);
}

/// A part of an act as reduced() reads it.
struct Kept {
    std::size_t act = 0;
    std::vector<std::size_t> troubles;
    std::size_t from = 0, to = 0;
    bool areBlocksCut = false;

    std::string str() const {
        std::string out = std::to_string(act) + (troubles.empty() ? "x" : "");
        for (const std::size_t t : troubles) {
            out += "." + std::to_string(t);
        }
        return out + (areBlocksCut ? fmt::format(":{}-{}", from, to) : std::string());
    }
};

std::string str(const std::vector<Kept> &all) {
    std::string out;
    for (const Kept &k : all) {
        out += (out.empty() ? "" : ",") + k.str();
    }
    return out;
}

/// Leaves out acts, troubles and blocks as long as the same rule is broken.
std::string shrink(const Task &task, unsigned seed, const std::string &rule) {
    const Plan plan = make_plan(seed, task.plan);
    std::vector<Kept> best;
    for (std::size_t n = 0; n < plan.acts.size(); ++n) {
        Kept k{n, {}, 0, plan.acts[n].blocks.size(), false};
        for (std::size_t t = 0; t < plan.acts[n].troubles.size(); ++t) {
            k.troubles.push_back(t);
        }
        best.push_back(k);
    }
    Task quiet = task;
    quiet.isTold = false;
    const auto try_it = [&](const std::vector<Kept> &shorter) {
        const bool isSame = !shorter.empty() && rule_of(drive(quiet, seed, str(shorter))) == rule;
        best = isSame ? shorter : best;
        return isSame;
    };
    for (std::size_t n = best.size(); n-- > 0;) {
        std::vector<Kept> shorter = best;
        shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(n));
        try_it(shorter);
    }
    for (std::size_t n = 0; n < best.size(); ++n) {
        for (std::size_t t = best[n].troubles.size(); t-- > 0;) {
            std::vector<Kept> shorter = best;
            shorter[n].troubles.erase(shorter[n].troubles.begin() + static_cast<std::ptrdiff_t>(t));
            try_it(shorter);
        }
        for (std::size_t step = best[n].to / 2; step > 0; step /= 2) {
            for (bool isEnd : {true, false}) {
                std::vector<Kept> shorter = best;
                shorter[n].areBlocksCut = true;
                isEnd ? shorter[n].to -= std::min(step, shorter[n].to) : shorter[n].from += step;
                if (shorter[n].from <= shorter[n].to) {
                    try_it(shorter);
                }
            }
        }
    }
    return str(best);
}

std::set<unsigned> seeds_in(const std::string &name) {
    std::set<unsigned> seeds;
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
        if (const auto seed = parse_uint(line.substr(0, line.find(' ')))) {
            seeds.insert(static_cast<unsigned>(*seed));
        }
    }
    return seeds;
}

/// Every `processes`-th seed; how many failed.
int work(const Task &task, unsigned part, const std::set<unsigned> &done) {
    const int file = ::open(task.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) {
        std::perror(task.log.c_str());
        return 1;
    }
    int failed = 0;
    for (unsigned seed = task.first; seed < task.first + task.count; ++seed) {
        if (seed % task.processes != part || done.contains(seed)) {
            continue;
        }
        const std::string verdict = drive(task, seed, "");
        const std::string line = fmt::format("{} {}\n", seed, verdict);
        if (::write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
            std::perror(task.log.c_str());
            return 1;
        }
        const std::string rule = rule_of(verdict);
        if (!rule.empty()) {
            ++failed;
            std::printf("seed %u: %s\n", seed, verdict.substr(verdict.find("FAILED")).c_str());
            if (task.isShrunk) {
                const std::string plan =
                    task.plan == PLAN_VERSION ? "" : fmt::format(" --plan {}", task.plan);
                std::printf("  replay: script/campaign motion --first %u%s --kept %s --tell\n", seed,
                            plan.c_str(), shrink(task, seed, rule).c_str());
            }
            std::fflush(stdout);
        }
    }
    ::close(file);
    return failed;
}

/// "# commit ID plan N" heads what a program has added; before there were several plans it named none.
std::set<unsigned> plans_in(const std::string &name) {
    std::set<unsigned> plans;
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("# commit ")) {
            const std::size_t at = line.find(" plan ");
            plans.insert(at == std::string::npos
                             ? 1U
                             : static_cast<unsigned>(std::strtoul(line.c_str() + at + 6, nullptr, 10)));
        }
    }
    return plans;
}

struct Sum {
    std::uint64_t runs = 0, failed = 0, shorter = 0, stops = 0, ended = 0, programs = 0, timed = 0,
                  refused = 0, commands = 0;
    double seconds = 0, slowest = 0;
    std::map<std::string, std::uint64_t> refusals;
    struct Extension {
        std::uint64_t sessions = 0, ran = 0, judged = 0;
    };
    std::map<std::string, Extension> extensions;
};

/// "backlash 3 12"
void add_extension(Sum &sum, const std::string &text) {
    const std::size_t judged = text.find_last_of(' ', text.find_last_not_of(' '));
    const std::size_t ran = text.find_last_of(' ', judged - 1);
    Sum::Extension &e = sum.extensions[text.substr(0, ran)];
    ++e.sessions;
    e.ran += std::strtoul(text.c_str() + ran, nullptr, 10);
    e.judged += std::strtoul(text.c_str() + judged, nullptr, 10);
}

/// Of all lines of the log.
void print_sum(const std::string &log) {
    Sum sum;
    std::ifstream file(log);
    constexpr double LONG_ENOUGH_S = 10;
    for (std::string line; std::getline(file, line);) {
        unsigned seed = 0;
        double seconds = 0, slowest = 0;
        unsigned stops = 0, ended = 0, programs = 0, timed = 0, refused = 0, commands = 0;
        const int read =
            std::sscanf(line.c_str(), "%u %lf s %u stops %u/%u programs %u timed %u/%u refused stop %lf",
                        &seed, &seconds, &stops, &ended, &programs, &timed, &refused, &commands, &slowest);
        if (line.starts_with('#') || read < 1) {
            continue;
        }
        ++sum.runs;
        sum.failed += line.find("FAILED") != std::string::npos ? 1 : 0;
        sum.shorter += seconds < LONG_ENOUGH_S ? 1 : 0;
        sum.seconds += seconds;
        sum.stops += stops;
        sum.ended += ended;
        sum.programs += programs;
        sum.timed += timed;
        sum.refused += refused;
        sum.commands += commands;
        sum.slowest = std::max(sum.slowest, slowest);
        std::istringstream rest(line);
        std::string part;
        std::getline(rest, part, '|');
        while (std::getline(rest, part, '|')) {
            if (part.starts_with(" with ")) {
                add_extension(sum, part.substr(6));
                continue;
            }
            const std::size_t x = part.find(" x ");
            const std::size_t end = part.find_last_not_of(' ') + 1;
            sum.refusals[part.substr(x + 3, end - x - 3)] +=
                static_cast<std::uint64_t>(std::atoi(part.c_str()));
        }
    }
    std::printf("%llu runs, %llu failed, %.0f s of machine time (%llu shorter than 10 s), %llu stops\n"
                "%llu programs, %llu to their end, %llu of these in the time that was estimated\n"
                "the slowest stop took %.2f of what the limits need\n%llu commands, %llu refused or ended by "
                "a stop\n",
                static_cast<unsigned long long>(sum.runs), static_cast<unsigned long long>(sum.failed),
                sum.seconds, static_cast<unsigned long long>(sum.shorter),
                static_cast<unsigned long long>(sum.stops), static_cast<unsigned long long>(sum.programs),
                static_cast<unsigned long long>(sum.ended), static_cast<unsigned long long>(sum.timed),
                sum.slowest, static_cast<unsigned long long>(sum.commands),
                static_cast<unsigned long long>(sum.refused));
    for (const auto &[name, e] : sum.extensions) {
        std::printf("%s: in %llu runs, %llu times, judged %llu times\n", name.c_str(),
                    static_cast<unsigned long long>(e.sessions), static_cast<unsigned long long>(e.ran),
                    static_cast<unsigned long long>(e.judged));
    }
    for (const auto &[reason, count] : sum.refusals) {
        std::printf("%8llu %s\n", static_cast<unsigned long long>(count), reason.c_str());
    }
}

int run(const Task &task) {
    if (task.isTold || !task.kept.empty()) {
        Task told = task;
        const std::string verdict = drive(told, task.first, task.kept);
        std::printf("%u %s\n", task.first, verdict.c_str());
        return rule_of(verdict).empty() ? 0 : 1;
    }
    if (task.isAnew) {
        std::filesystem::remove(task.log);
    }
    for (const unsigned plan : plans_in(task.log)) {
        if (plan != task.plan) {
            std::fprintf(stderr,
                         "%s has seeds of plan %u, which stand for other sessions than those of plan %u: "
                         "begin another log, or this one with --anew\n",
                         task.log.c_str(), plan, task.plan);
            return 2;
        }
    }
    const std::set<unsigned> done = seeds_in(task.log);
    std::ofstream(task.log, std::ios::app)
        << "# commit " << (task.commit.empty() ? "unknown" : task.commit) << " plan " << task.plan << '\n';
    std::vector<pid_t> children;
    for (unsigned part = 0; part < task.processes; ++part) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::_exit(work(task, part, done) == 0 ? 0 : 1);
        }
        children.push_back(child);
    }
    bool isSound = true;
    for (const pid_t child : children) {
        int status = 0;
        isSound =
            ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 && isSound;
    }
    print_sum(task.log);
    return isSound ? 0 : 1;
}

}  // namespace
}  // namespace mw::campaign

int main(int argc, char **argv) {
    mw::campaign::Task task;
    mw::options::CommandLine line(
        "motion_campaign --first S --count N --log FILE [--processes P]",
        "Random sessions at random machines. One line for each seed in the log; seeds that "
        "it has are not run again. Ends with 1 when something was broken.\n");
    line.number("--first", "S", "seed to begin with (default 1)", task.first, 0, UINT32_MAX - 1);
    line.number("--count", "N", "so many seeds (default 100)", task.count, 0, UINT32_MAX - 1);
    line.text("--log", "FILE", "where the verdicts go", task.log);
    line.number("--processes", "P", "at a time (default 2)", task.processes, 1, 1024);
    line.number("--plan", "N", "what a seed stands for: 1, sessions of a minute, or 3 (default)", task.plan,
                1, mw::campaign::PLAN_VERSION);
    line.text("--commit", "ID", "what was built, for the log", task.commit);
    line.text("--kept", "PARTS", "runs only these parts of the first seed", task.kept);
    line.flag("--tell", "runs the first seed and tells what happens", task.isTold);
    line.text("--trace", "FILE", "with --tell: commands of joints and axes at every cycle", task.trace);
    line.take("--known", 1, "RULE", "known to be broken: counted, but no failure; may come several times",
              [&](const mw::options::Words &words) -> mw::Result<> {
                  task.known.insert(words[0]);
                  return {};
              });
    line.flag("--anew", "begins the log anew", task.isAnew);
    line.flag("--no-shrink", "does not look for a shorter run that fails too", task.isShrunk, false);
    line.number("--patience", "S", "for one run [s] (default 120)", task.patience_s, 1, 1e6);
    const auto parsed = line.parse({argv + 1, argv + argc});
    const bool isComplete = !task.log.empty() || task.isTold || !task.kept.empty();
    if (!parsed || !isComplete) {
        std::fprintf(stderr, "%s\n%s", parsed ? "--log is missing" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    constexpr unsigned REPLACED = 2;
    if (task.plan == REPLACED) {
        std::fputs("motion_campaign: nothing makes the sessions of plan 2 any more: use 1 or 3\n", stderr);
        return 2;
    }
    return mw::campaign::run(task);
}
