// SPDX-License-Identifier: GPL-2.0-or-later
// Random sessions with random machines, docs/developer/motion_campaign.md.
#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "campaign/session.hh"
#include "campaign_runner/runner.hh"

namespace mw::campaign {
namespace {

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
    return out;
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

/// Sums of all lines of a log.
void print_lines(std::istream &file) {
    Sum sum;
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
                "the slowest stop took %.2f of what the limits need\n%llu commands, %llu rejected or ended "
                "by a stop\n",
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

class MotionCampaign final : public campaign_runner::Campaign {
  public:
    std::string name() const override { return "motion"; }
    unsigned plan() const override { return plan_version; }
    bool isPlanTheUsualOne() const override { return plan_version == PLAN_VERSION; }
    std::string run(unsigned seed, const std::string &kept, const std::filesystem::path &folder,
                    bool isTold) override {
        const Plan plan = reduced(make_plan(seed, plan_version), kept);
        return line_of(Session(plan, folder, {isTold ? stdout : nullptr, trace, known}).run());
    }
    std::vector<campaign_runner::ActSize> acts_of(unsigned seed) const override {
        std::vector<campaign_runner::ActSize> sizes;
        for (const Act &act : make_plan(seed, plan_version).acts) {
            sizes.push_back({act.troubles.size(), act.blocks.size()});
        }
        return sizes;
    }
    void print_sum(std::istream &log) const override { print_lines(log); }

    unsigned plan_version = PLAN_VERSION;
    std::string trace;
    std::set<std::string> known;
};

}  // namespace
}  // namespace mw::campaign

int main(int argc, char **argv) {
    mw::campaign::MotionCampaign campaign;
    mw::options::CommandLine line(
        "motion_campaign --first S --count N --log FILE [--processes P]",
        "Random sessions at random machines. One line for each seed in the log; seeds that "
        "it has are not run again. Ends with 1 when something was broken.\n");
    line.number("--plan", "N",
                "version of the plans: 1, sessions of a minute, 3 (default), 4, further kinematics, or "
                "5, the planner is lost at every stop",
                campaign.plan_version, 1, mw::campaign::LAST_PLAN);
    line.text("--trace", "FILE", "with --tell: commands of joints and axes at every cycle", campaign.trace);
    line.take("--known", 1, "RULE", "known to be broken: counted, but no failure; may come several times",
              [&](const mw::options::Words &words) -> mw::Result<> {
                  campaign.known.insert(words[0]);
                  return {};
              });
    return mw::campaign_runner::run(campaign, line, argc, argv);
}
