// SPDX-License-Identifier: GPL-2.0-or-later
// Random sessions of the HostMot2 driver at a simulated board.
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "campaign_runner/runner.hh"
#include "mesa_campaign/session.hh"

namespace mw::mesa_campaign {
namespace {

class MesaCampaign final : public campaign_runner::Campaign {
  public:
    std::string name() const override { return "mesa"; }
    unsigned plan() const override { return PLAN_VERSION; }
    std::string run(unsigned seed, const std::string &kept, const std::filesystem::path &,
                    bool isTold) override {
        const Verdict v = run_session(reduced(make_plan(seed), kept), isTold ? stdout : nullptr);
        return fmt::format(
            "cycles {} failed {} stops {} bites {} arms {} latches {} losses {} worst {:.2f} {}", v.cycles,
            v.failed_cycles, v.stops, v.bites, v.arms, v.latches, v.losses, v.worst_steps,
            v.fault.empty() ? "ok" : "FAILED " + v.fault);
    }
    std::vector<campaign_runner::ActSize> acts_of(unsigned seed) const override {
        std::vector<campaign_runner::ActSize> sizes;
        for (const Act &act : make_plan(seed).acts) {
            sizes.push_back({.troubles = act.trouble == Trouble::NONE ? 0U : 1U, .blocks = 0});
        }
        return sizes;
    }
    void print_sum(std::istream &log) const override {
        unsigned long long sums[7] = {}, sessions = 0, failed = 0;
        for (std::string line; std::getline(log, line);) {
            unsigned seed = 0;
            unsigned long long n[7] = {};
            if (std::sscanf(
                    line.c_str(),
                    "%u cycles %llu failed %llu stops %llu bites %llu arms %llu latches %llu losses %llu",
                    &seed, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]) == 8) {
                ++sessions;
                failed += line.find("FAILED") != std::string::npos ? 1 : 0;
                for (std::size_t i = 0; i < std::size(n); ++i) {
                    sums[i] += n[i];
                }
            }
        }
        fmt::print(
            "{} sessions, {} failed; {} cycles, {} of them failed, {} stops of the traffic, {} bites of the "
            "watchdog, {} arms of an index, {} latches, {} times positions were lost\n",
            sessions, failed, sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6]);
    }
};

}  // namespace
}  // namespace mw::mesa_campaign

int main(int argc, char **argv) {
    mw::mesa_campaign::MesaCampaign campaign;
    mw::options::CommandLine line("mesa_campaign --first S --count N --log FILE [--processes P]",
                                  "Random sessions of the HostMot2 driver at a simulated board. One line for "
                                  "each seed in the log; seeds "
                                  "that it has are not run again. Ends with 1 when a rule was broken.\n");
    return mw::campaign_runner::run(campaign, line, argc, argv);
}
