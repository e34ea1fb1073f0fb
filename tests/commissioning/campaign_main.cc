// SPDX-License-Identifier: GPL-2.0-or-later
// Commissions random machines with a scripted owner.
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "campaign_runner/runner.hh"
#include "commissioning/session.hh"

namespace mw::commissioning_campaign {
namespace {

class CommissioningCampaign final : public campaign_runner::Campaign {
  public:
    std::string name() const override { return "commissioning"; }
    unsigned plan() const override { return 2; }
    std::string run(unsigned seed, const std::string &, const std::filesystem::path &folder,
                    bool isTold) override {
        return run_session(seed, folder, isTold);
    }
    std::vector<campaign_runner::ActSize> acts_of(unsigned) const override { return {}; }
    void print_sum(std::istream &log) const override {
        unsigned sessions = 0, failed = 0;
        double scale = 0, spread = 0, better = 1e9, margin = 1e9, phase = 1e9;
        for (std::string line; std::getline(log, line);) {
            unsigned seed = 0, axes = 0;
            int board = 0;
            double n[6] = {};
            if (std::sscanf(
                    line.c_str(),
                    "%u board %d axes %u time %lf scale %lf spread %lf better %lf margin %lf phase %lf",
                    &seed, &board, &axes, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]) != 9) {
                continue;
            }
            ++sessions;
            failed += line.find("FAILED") != std::string::npos ? 1 : 0;
            scale = std::max(scale, n[1]);
            spread = std::max(spread, n[2]);
            better = n[3] > 0 ? std::min(better, n[3]) : better;
            margin = n[4] > 0 ? std::min(margin, n[4]) : margin;
            phase = n[4] > 0 ? std::min(phase, n[5]) : phase;
        }
        fmt::print(
            "{} machines, {} failed; scale within {:.4f} %, homing within {:.1f} counts, following error at "
            "least {:.1f} times smaller, gain margin at least {:.2f}, phase margin at least {:.0f} deg\n",
            sessions, failed, scale * 100, spread, better, margin, phase);
    }
};

}  // namespace
}  // namespace mw::commissioning_campaign

int main(int argc, char **argv) {
    mw::commissioning_campaign::CommissioningCampaign campaign;
    mw::options::CommandLine line(
        "commissioning_campaign --first S --count N --log FILE [--processes P]",
        "Random machines that an owner commissions; seeds from 100000 have a fault that must "
        "be named. One line for each seed in the log. Ends with 1 when a rule was broken.\n");
    return mw::campaign_runner::run(campaign, line, argc, argv);
}
