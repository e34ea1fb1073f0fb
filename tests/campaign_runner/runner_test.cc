// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "campaign_runner/runner.hh"

namespace mw::campaign_runner {
namespace {

namespace files = std::filesystem;

TEST(Kept, IsReadAsItIsWritten) {
    for (const std::string text : {"0x", "3.0.2,4x:2-7", "1.5:0-0"}) {
        EXPECT_EQ(str(parse_kept(text)), text);
    }
    const Kept part = parse_kept("2.1:3-4")[0];
    EXPECT_TRUE(part.hasTrouble(1) && part.hasBlock(3) && part.hasBlock(4));
    EXPECT_FALSE(part.hasTrouble(0) || part.hasBlock(2) || part.hasBlock(5));
    const Kept all = parse_kept("2")[0];
    EXPECT_TRUE(all.hasTrouble(7) && all.hasBlock(99));
}

TEST(Kept, ShrinkingLeavesWhatFails) {
    const std::vector<ActSize> acts{{2, 10}, {3, 40}, {0, 5}};
    const auto fails = [](const std::string &text) {
        for (const Kept &kept : parse_kept(text)) {
            if (kept.act == 1 && kept.hasTrouble(2) && kept.hasBlock(17)) {
                return true;
            }
        }
        return false;
    };
    const std::string best = shrink(acts, fails);
    EXPECT_TRUE(fails(best));
    const auto parts = parse_kept(best);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].troubles, std::vector<std::size_t>{2});
    EXPECT_LE(parts[0].to - parts[0].from, 2U) << best;
}

/// Seed 3 breaks a rule, seed 4 crashes, seed 5 hangs.
class Made final : public Campaign {
  public:
    std::string name() const override { return "made"; }
    unsigned plan() const override { return number; }
    std::string run(unsigned seed, const std::string &, const files::path &folder, bool) override {
        if (seed == 4) {
            ::_exit(9);
        }
        while (seed == 5) {
            ::pause();
        }
        const std::string verdict = seed == 3 ? "1 FAILED odd: it is three" : "1 ok";
        return files::is_empty(folder) ? verdict : "FAILED folder: it is not empty";
    }
    std::vector<ActSize> acts_of(unsigned) const override { return {{0, 1}}; }
    void print_sum(std::istream &) const override {}
    unsigned number = 1;
};

TEST(Runner, EverySeedHasAVerdictAndALogIsGoneOnWith) {
    const files::path log = files::temp_directory_path() / ("mw_runner_" + std::to_string(::getpid()));
    Made campaign;
    Order order;
    order.count = 6;
    order.log = log;
    order.patience_s = 1;
    order.isShrunk = false;
    EXPECT_EQ(run(campaign, order), 1);
    const auto lines = [&] {
        std::vector<std::string> all;
        std::ifstream in(log);
        for (std::string line; std::getline(in, line);) {
            if (!line.starts_with('#')) {
                all.push_back(line);
            }
        }
        std::ranges::sort(all);
        return all;
    };
    const std::vector<std::string> expected{"1 1 ok",
                                            "2 1 ok",
                                            "3 1 FAILED odd: it is three",
                                            "4 FAILED crash: status 2304",
                                            "5 FAILED hang: no verdict in time",
                                            "6 1 ok"};
    EXPECT_EQ(lines(), expected);
    order.count = 7;
    EXPECT_EQ(run(campaign, order), 0) << "the others are not run again";
    EXPECT_EQ(lines().size(), 7U);
    campaign.number = 2;
    EXPECT_EQ(run(campaign, order), 2) << "seeds of another plan";
    files::remove(log);
}

}  // namespace
}  // namespace mw::campaign_runner
