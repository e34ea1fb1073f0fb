// SPDX-License-Identifier: GPL-2.0-or-later
// Runs campaigns of random sessions. Each seed runs in a separate process, so that sessions are independent
// and a crash or a hang is a verdict. A campaign continues from its log. The runner shortens sessions that
// fail.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "base/options/command_line.hh"
#include "campaign_runner/kept.hh"

namespace mw::campaign_runner {

/// Interface of a campaign. The runner calls all methods in its own process, except run().
class Campaign {
  public:
    virtual ~Campaign() = default;
    /// Name on the command line of `script/campaign`.
    virtual std::string name() const = 0;
    /// Number of the plan, which is part of the log: the same seed is another session in another plan.
    virtual unsigned plan() const = 0;
    virtual bool isPlanTheUsualOne() const { return true; }
    /// Called in a separate process with a separate folder. Returns the verdict in one line: figures, then
    /// "ok" or "FAILED rule: what". `kept`: the parts to run (kept.hh), empty for all.
    virtual std::string run(unsigned seed, const std::string &kept, const std::filesystem::path &folder,
                            bool isTold) = 0;
    virtual std::vector<ActSize> acts_of(unsigned seed) const = 0;
    /// Prints the sum of all lines of a log.
    virtual void print_sum(std::istream &log) const = 0;
};

/// The order for a campaign.
struct Order {
    unsigned first = 1, count = 100, processes = 2;
    std::string log, kept, commit;
    bool isTold = false, isShrunk = true, isAnew = false;
    double patience_s = 120;  ///< for one session

    void add_to(options::CommandLine &line);
    /// Error text of missing or inconsistent options; empty if there is none.
    std::string trouble() const;
};

/// Runs the campaign. Returns the exit status: 1 if a rule was violated.
int run(Campaign &campaign, const Order &order);
/// As above, with the words of a command line whose program has its own options. Returns 2 for invalid words.
int run(Campaign &campaign, options::CommandLine &line, int argc, char **argv);

/// "limit" of "... FAILED limit: joint 0 ..."; empty if no rule was violated.
std::string rule_of(const std::string &verdict);

}  // namespace mw::campaign_runner
