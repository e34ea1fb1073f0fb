// SPDX-License-Identifier: GPL-2.0-or-later
// Runs campaigns of random sessions: every seed in a process of its own, so that nothing is carried over and
// a crash or a hang is a verdict; a log that a campaign goes on with; shorter sessions that fail too.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "base/options/command_line.hh"
#include "campaign_runner/kept.hh"

namespace mw::campaign_runner {

/// What a kind of campaign is. The runner asks it in its own process, but for run().
class Campaign {
  public:
    virtual ~Campaign() = default;
    /// As behind `script/campaign`.
    virtual std::string name() const = 0;
    /// What a seed stands for, by number: logs name it, and seeds of another plan are other sessions.
    virtual unsigned plan() const = 0;
    virtual bool isPlanTheUsualOne() const { return true; }
    /// In a process of its own with a folder of its own. The verdict in one line: figures, then "ok" or
    /// "FAILED rule: what". `kept`: the parts that are run (kept.hh), empty for all.
    virtual std::string run(unsigned seed, const std::string &kept, const std::filesystem::path &folder,
                            bool isTold) = 0;
    virtual std::vector<ActSize> acts_of(unsigned seed) const = 0;
    /// Of all lines of a log.
    virtual void print_sum(std::istream &log) const = 0;
};

/// What is to be run.
struct Order {
    unsigned first = 1, count = 100, processes = 2;
    std::string log, kept, commit;
    bool isTold = false, isShrunk = true, isAnew = false;
    double patience_s = 120;  ///< for one session

    void add_to(options::CommandLine &line);
    /// Something that is missing or does not fit, empty: nothing.
    std::string trouble() const;
};

/// The status that the program ends with: 1 when something was broken.
int run(Campaign &campaign, const Order &order);

/// "limit" of "... FAILED limit: joint 0 ..."; empty when all held.
std::string rule_of(const std::string &verdict);

}  // namespace mw::campaign_runner
