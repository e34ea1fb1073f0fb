// SPDX-License-Identifier: GPL-2.0-or-later
// Random sessions of operators at whole machines, docs/developer/task_campaign.md.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "campaign_runner/runner.hh"
#include "task_campaign/session.hh"

namespace mw::task_campaign {
namespace {

std::string line_of(const Verdict &v) {
    std::string out = fmt::format("{:.1f} s {} acts {} commands {} refused {} runs {} ended {} stopped {} "
                                  "crashes {} recovered {}",
                                  v.seconds, v.acts, v.commands, v.refused, v.runs, v.ended, v.stopped,
                                  v.crashes, v.recovered, v.fault.empty() ? "ok" : "FAILED " + v.fault);
    for (const auto &[name, count] : v.counts) {
        out += fmt::format(" | {} x of {}", count, name);
    }
    for (const auto &[reason, count] : v.refusals) {
        out += fmt::format(" | {} x {}", count, reason);
    }
    return out;
}

class TaskCampaign final : public campaign_runner::Campaign {
  public:
    std::string name() const override { return "task"; }
    unsigned plan() const override { return PLAN_VERSION; }
    std::string run(unsigned seed, const std::string &kept, const std::filesystem::path &folder,
                    bool isTold) override {
        const Plan plan = reduced(make_plan(seed), kept);
        return line_of(Session(plan, folder, isTold ? stdout : nullptr).run());
    }
    std::vector<campaign_runner::ActSize> acts_of(unsigned seed) const override {
        std::vector<campaign_runner::ActSize> sizes;
        for (const Act &act : make_plan(seed).acts) {
            sizes.push_back({act.troubles.size(), act.blocks.size()});
        }
        return sizes;
    }
    void print_sum(std::istream &log) const override;
};

void TaskCampaign::print_sum(std::istream &log) const {
    static constexpr const char *NAMES[] = {"acts",    "commands", "rejected or failed",     "runs", "ended",
                                            "stopped", "crashes",  "continued after a crash"};
    std::uint64_t sessions = 0, failed = 0, sums[std::size(NAMES)] = {};
    double seconds = 0;
    std::map<std::string, std::uint64_t> counts;
    for (std::string line; std::getline(log, line);) {
        unsigned seed = 0, n[std::size(NAMES)] = {};
        double took_s = 0;
        if (line.starts_with('#')) {
            continue;
        }
        const int read = std::sscanf(line.c_str(),
                                     "%u %lf s %u acts %u commands %u refused %u runs %u ended %u stopped %u "
                                     "crashes %u recovered",
                                     &seed, &took_s, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6], &n[7]);
        sessions += read > 0 ? 1 : 0;
        failed += line.find("FAILED") != std::string::npos ? 1 : 0;
        seconds += took_s;
        for (std::size_t i = 0; i < std::size(NAMES); ++i) {
            sums[i] += n[i];
        }
        std::istringstream rest(line);
        std::string part;
        std::getline(rest, part, '|');
        while (std::getline(rest, part, '|')) {
            const std::size_t x = part.find(" x ");
            const std::size_t end = part.find_last_not_of(' ') + 1;
            counts[part.substr(x + 3, end - x - 3)] += static_cast<std::uint64_t>(std::atoi(part.c_str()));
        }
    }
    fmt::print("{} sessions, {} failed, {:.0f} s of machine time\n", sessions, failed, seconds);
    for (std::size_t i = 0; i < std::size(NAMES); ++i) {
        fmt::print("{:9} {}\n", sums[i], NAMES[i]);
    }
    for (const auto &[what, count] : counts) {
        fmt::print("{:9} {}\n", count, what);
    }
}

}  // namespace
}  // namespace mw::task_campaign

int main(int argc, char **argv) {
    mw::task_campaign::TaskCampaign campaign;
    mw::options::CommandLine line(
        "task_campaign --first S --count N --log FILE [--processes P]",
        "Random sessions of operators at whole machines. One line for each seed in the log; seeds that "
        "it has are not run again. Ends with 1 when something was broken.\n");
    return mw::campaign_runner::run(campaign, line, argc, argv);
}
