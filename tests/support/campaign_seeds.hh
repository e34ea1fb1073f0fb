// SPDX-License-Identifier: GPL-2.0-or-later
// The seeds of a campaign of random programs, from the environment.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <string_view>

#include <gtest/gtest.h>

#include "base/text.hh"

namespace mw::testing {

struct CampaignSeeds {
    int first = 1;
    int count = 0;
};

/// MW_CAMPAIGN_FIRST (default 1) and MW_CAMPAIGN_SEEDS. The test fails if a value is not a number above 0, or
/// if another variable begins with MW_CAMPAIGN_, because a campaign without seeds must not pass.
inline CampaignSeeds campaign_seeds(int preset) {
    CampaignSeeds seeds{1, preset};
    constexpr std::string_view PREFIX = "MW_CAMPAIGN_";
    for (char **entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const std::string_view text(*entry);
        if (!text.starts_with(PREFIX)) {
            continue;
        }
        const std::size_t equals = text.find('=');
        const std::string_view name = text.substr(PREFIX.size(), equals - PREFIX.size());
        const std::optional<std::int64_t> number = parse_int(text.substr(equals + 1));
        const bool isKnown = name == "SEEDS" || name == "FIRST";
        if (!isKnown || !number || *number < 1 || *number > 1000000000) {
            ADD_FAILURE() << text << ": MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST take a number from 1 up";
            continue;
        }
        (name == "SEEDS" ? seeds.count : seeds.first) = static_cast<int>(*number);
    }
    return seeds;
}

}  // namespace mw::testing
