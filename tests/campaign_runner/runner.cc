// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign_runner/runner.hh"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::campaign_runner {
namespace {

namespace files = std::filesystem;

files::path folder_of(pid_t process) {
    return files::temp_directory_path() / fmt::format("mw_campaign_{}", process);
}

/// The process of a session.
[[noreturn]] void work_alone(Campaign &campaign, const Order &order, unsigned seed, const std::string &kept,
                             int out) {
    const auto folder = folder_of(::getpid());
    files::remove_all(folder);
    files::create_directory(folder);
    std::string line = campaign.run(seed, kept, folder, order.isTold);
    std::ranges::replace(line, '\n', ' ');
    line += '\n';
    if (order.isTold) {
        std::printf("files in %s\n", folder.c_str());
    } else {
        files::remove_all(folder);
    }
    std::fflush(stdout);
    ::_exit(::write(out, line.data(), line.size()) == static_cast<ssize_t>(line.size()) ? 0 : 1);
}

/// False when nothing was received for too long.
bool read_line(int in, double patience_s, std::string &line) {
    char buffer[4096];
    pollfd waiting{in, POLLIN, 0};
    while (line.find('\n') == std::string::npos) {
        if (::poll(&waiting, 1, static_cast<int>(patience_s * 1000)) <= 0) {
            return false;
        }
        const ssize_t size = ::read(in, buffer, sizeof buffer);
        if (size <= 0) {
            return true;
        }
        line.append(buffer, static_cast<std::size_t>(size));
    }
    return true;
}

/// Runs the seed in a separate process; returns one line.
std::string drive(Campaign &campaign, const Order &order, unsigned seed, const std::string &kept) {
    int ends[2];
    if (::pipe(ends) != 0) {
        return "FAILED no pipe";
    }
    std::fflush(stdout);  // the child has a copy of the unwritten data
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        work_alone(campaign, order, seed, kept, ends[1]);
    }
    ::close(ends[1]);
    std::string line;
    const bool isLate = !read_line(ends[0], order.patience_s, line);
    if (isLate) {
        ::kill(child, SIGKILL);
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!line.empty()) {
        return line.substr(0, line.find('\n'));
    }
    files::remove_all(folder_of(child));
    return isLate ? "FAILED hang: no verdict in time"
                  : fmt::format("FAILED crash: status {}", WIFSIGNALED(status) ? WTERMSIG(status) : status);
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

std::string shrunk(Campaign &campaign, const Order &order, unsigned seed, const std::string &rule) {
    Order quiet = order;
    quiet.isTold = false;
    return shrink(campaign.acts_of(seed), [&](const std::string &kept) {
        return rule_of(drive(campaign, quiet, seed, kept)) == rule;
    });
}

void tell_failure(Campaign &campaign, const Order &order, unsigned seed, const std::string &verdict) {
    std::printf("seed %u: %s\n", seed, verdict.substr(verdict.find("FAILED")).c_str());
    if (order.isShrunk) {
        const std::string plan =
            campaign.isPlanTheUsualOne() ? "" : fmt::format(" --plan {}", campaign.plan());
        std::printf("  replay: script/campaign %s --first %u%s --kept %s --tell\n", campaign.name().c_str(),
                    seed, plan.c_str(), shrunk(campaign, order, seed, rule_of(verdict)).c_str());
    }
    std::fflush(stdout);
}

/// Runs every `processes`-th seed; returns the number of failures.
int work(Campaign &campaign, const Order &order, unsigned part, const std::set<unsigned> &done) {
    const int file = ::open(order.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) {
        std::perror(order.log.c_str());
        return 1;
    }
    int failed = 0;
    for (unsigned seed = order.first; seed < order.first + order.count; ++seed) {
        if (seed % order.processes != part || done.contains(seed)) {
            continue;
        }
        const std::string verdict = drive(campaign, order, seed, "");
        const std::string line = fmt::format("{} {}\n", seed, verdict);
        if (::write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
            std::perror(order.log.c_str());
            return 1;
        }
        if (!rule_of(verdict).empty()) {
            ++failed;
            tell_failure(campaign, order, seed, verdict);
        }
    }
    ::close(file);
    return failed;
}

/// The header "# commit ID plan N" precedes the lines of a program; logs from before there were several plans
/// name no plan.
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

bool isLogOfThisPlan(const Campaign &campaign, const Order &order) {
    for (const unsigned plan : plans_in(order.log)) {
        if (plan != campaign.plan()) {
            std::fprintf(stderr,
                         "%s has seeds of plan %u, which are other sessions than those of plan %u: "
                         "begin another log, or this one with --anew\n",
                         order.log.c_str(), plan, campaign.plan());
            return false;
        }
    }
    return true;
}

}  // namespace

int run(Campaign &campaign, options::CommandLine &line, int argc, char **argv) {
    Order order;
    order.add_to(line);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || !order.trouble().empty()) {
        std::fprintf(stderr, "%s\n%s", parsed ? order.trouble().c_str() : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    return run(campaign, order);
}

std::string rule_of(const std::string &verdict) {
    const std::size_t at = verdict.find("FAILED ");
    return at == std::string::npos ? std::string() : verdict.substr(at + 7, verdict.find(':', at) - at - 7);
}

void Order::add_to(options::CommandLine &line) {
    line.number("--first", "S", "seed to begin with (default 1)", first, 0, UINT32_MAX - 1);
    line.number("--count", "N", "so many seeds (default 100)", count, 0, UINT32_MAX - 1);
    line.text("--log", "FILE", "where the verdicts go", log);
    line.number("--processes", "P", "at a time (default 2)", processes, 1, 1024);
    line.text("--commit", "ID", "what was built, for the log", commit);
    line.text("--kept", "PARTS", "runs only these parts of the first seed", kept);
    line.flag("--tell", "runs the first seed and prints the events", isTold);
    line.flag("--anew", "starts a new log", isAnew);
    line.flag("--no-shrink", "does not look for a shorter run that fails too", isShrunk, false);
    line.number("--patience", "S", "for one run [s] (default 120)", patience_s, 1, 1e6);
}

std::string Order::trouble() const {
    return log.empty() && !isTold && kept.empty() ? "--log is missing" : "";
}

int run(Campaign &campaign, const Order &order) {
    if (order.isTold || !order.kept.empty()) {
        const std::string verdict = drive(campaign, order, order.first, order.kept);
        std::printf("%u %s\n", order.first, verdict.c_str());
        return rule_of(verdict).empty() ? 0 : 1;
    }
    if (order.isAnew) {
        files::remove(order.log);
    }
    if (!isLogOfThisPlan(campaign, order)) {
        return 2;
    }
    const std::set<unsigned> done = seeds_in(order.log);
    std::ofstream(order.log, std::ios::app)
        << "# commit " << (order.commit.empty() ? "unknown" : order.commit) << " plan " << campaign.plan()
        << '\n';
    std::vector<pid_t> children;
    for (unsigned part = 0; part < order.processes; ++part) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::_exit(work(campaign, order, part, done) == 0 ? 0 : 1);
        }
        children.push_back(child);
    }
    bool isSound = true;
    for (const pid_t child : children) {
        int status = 0;
        isSound =
            ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 && isSound;
    }
    std::ifstream log(order.log);
    campaign.print_sum(log);
    return isSound ? 0 : 1;
}

}  // namespace mw::campaign_runner
