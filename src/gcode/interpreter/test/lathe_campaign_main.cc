// SPDX-License-Identifier: GPL-2.0-or-later
// A campaign of random turning jobs on simulated stock. lathe_campaign --first N --count M --log FILE
// [--processes P] [--commit HASH]: one line per seed in the log; seeds in the log are not run again. Prints
// the rejected jobs by reason, and the failed ones. Status 1 when a job failed. `--seed N` prints the program
// and result of one job.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/options/command_line.hh"
#include "base/text.hh"
#include "lathe_campaign.hh"

namespace mw::gcode::test {
namespace {

struct Task {
    unsigned first = 1, count = 1000, processes = 2;
    std::optional<unsigned> single;
    std::string log, commit;
};

std::optional<unsigned> number_in(std::string_view text) {
    const auto number = parse_uint(text);
    return number.has_value() && *number < 0xffffffffU ? std::optional<unsigned>(*number) : std::nullopt;
}

std::string kind_of(const testing::LatheJob &job) {
    return fmt::format("{}{}{} D{:.2f}", job.isInside ? "inside" : "outside",
                       job.isMonotonic ? " monotonic" : " falling", job.hasArcs ? " arcs" : "",
                       job.largest_allowance());
}

std::string line_of(unsigned seed) {
    const testing::LatheJob job = testing::make_lathe_job(seed);
    const LatheVerdict verdict = run_lathe_job(job);
    std::string codes;
    for (const testing::JobCycle &cycle : job.cycles) {
        codes += (codes.empty() ? "G" : "+G") + cycle.code;
    }
    const std::string result = !verdict.refusal.empty() ? "refused " + verdict.refusal
                               : !verdict.fault.empty() ? "FAILED " + verdict.fault
                                                        : "ok";
    return fmt::format("{} {} {} {} moves | {}\n", seed, codes, kind_of(job), verdict.moves, result);
}

/// Runs every `processes`-th seed.
bool work(const Task &task, unsigned part, const std::set<unsigned> &done) {
    const int file = ::open(task.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) {
        std::perror(task.log.c_str());
        return false;
    }
    for (unsigned seed = task.first; seed < task.first + task.count; ++seed) {
        if (seed % task.processes != part || done.contains(seed)) {
            continue;
        }
        const std::string line = line_of(seed);
        if (::write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
            std::perror(task.log.c_str());
            return false;
        }
    }
    return ::close(file) == 0;
}

/// The lines of a log, by seed.
std::map<unsigned, std::string> read_log(const std::string &name) {
    std::map<unsigned, std::string> lines;
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
        if (const auto seed = number_in(line.substr(0, line.find(' ')))) {
            lines[*seed] = line;
        }
    }
    return lines;
}

/// Prints the results of the seeds; false when one failed.
bool summarise(const Task &task) {
    std::map<std::string, unsigned> refusals;
    unsigned jobs = 0, refused = 0, failed = 0, monotonic_refused = 0, monotonic = 0;
    for (const auto &[seed, line] : read_log(task.log)) {
        if (seed < task.first || seed >= task.first + task.count) {
            continue;
        }
        ++jobs;
        const std::string result = line.substr(line.find(" | ") + 3);
        const std::size_t d = line.find(" D");
        const bool easy = line.contains(" monotonic") && std::stod(line.substr(d + 2)) <= 0.5;
        monotonic += easy ? 1 : 0;
        if (result.starts_with("refused ")) {
            ++refused;
            monotonic_refused += easy ? 1 : 0;
            ++refusals[result.substr(8)];
        } else if (result != "ok") {
            ++failed;
            std::printf("%s\n", line.c_str());
        }
    }
    for (const auto &[text, count] : refusals) {
        std::printf("%6u rejected: %s\n", count, text.c_str());
    }
    std::printf("%u jobs, %u failed, %u rejected (%.2f %%); monotonic with D up to 0.5: %u, %u rejected\n",
                jobs, failed, refused, jobs == 0 ? 0.0 : 100.0 * refused / jobs, monotonic,
                monotonic_refused);
    return failed == 0 && jobs == task.count;
}

int run(const Task &task) {
    if (task.single) {
        const testing::LatheJob job = testing::make_lathe_job(*task.single);
        std::printf("%s", job.program.c_str());
        for (const testing::Stroke &stroke : job.contour.strokes) {
            std::printf("u %.4f h %.4f to u %.4f h %.4f%s\n", stroke.from.u, stroke.from.h, stroke.to.u,
                        stroke.to.h, stroke.isArc ? " arc" : "");
        }
        std::printf("start u %.4f h %.4f\n%s", job.start.u, job.start.h, line_of(*task.single).c_str());
        return 0;
    }
    if (!task.commit.empty()) {
        std::ofstream(task.log, std::ios::app) << "# commit " << task.commit << " seeds " << task.first
                                               << " to " << task.first + task.count - 1 << '\n';
    }
    std::set<unsigned> done;
    for (const auto &[seed, line] : read_log(task.log)) {
        done.insert(seed);
    }
    std::vector<pid_t> children;
    for (unsigned part = 0; part < task.processes; ++part) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::_exit(work(task, part, done) ? 0 : 1);
        }
        children.push_back(child);
    }
    bool sound = true;
    for (const pid_t child : children) {
        int status = 0;
        sound =
            ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 && sound;
    }
    return summarise(task) && sound ? 0 : 1;
}

}  // namespace
}  // namespace mw::gcode::test

int main(int argc, char **argv) {
    mw::gcode::test::Task task;
    std::int64_t single = -1;
    mw::options::CommandLine line(
        "lathe_campaign --first N --count M --log FILE [--processes P] [--commit HASH]\n"
        "       lathe_campaign --seed N",
        "One line for each seed in the log; seeds that it has are not run again.\n");
    line.number("--first", "N", "seed to begin with (default 1)", task.first, 0, UINT32_MAX - 1);
    line.number("--count", "M", "so many seeds (default 1000)", task.count, 0, UINT32_MAX - 1);
    line.text("--log", "FILE", "where the verdicts go", task.log);
    line.number("--processes", "P", "at a time (default 2)", task.processes, 1, 1024);
    line.text("--commit", "HASH", "what is run, for the log", task.commit);
    line.number("--seed", "N", "print one job's program and its verdict", single, 0, UINT32_MAX - 1);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || (task.log.empty() && single < 0)) {
        std::fprintf(stderr, "%s\n%s", parsed ? "--log is missing" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    if (single >= 0) {
        task.single = static_cast<unsigned>(single);
    }
    return mw::gcode::test::run(task);
}
