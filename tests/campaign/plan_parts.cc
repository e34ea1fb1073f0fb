// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a plan, from words as "0,2:0-5,3x,4.1".
#include <cstdlib>
#include <sstream>

#include "campaign/plan.hh"

namespace mw::campaign {
namespace {

/// ".0.2": the troubles 0 and 2; "x": none. Moves on to what follows.
void keep_troubles(const char *&at, Act &act) {
    if (*at == 'x') {
        act.troubles.clear();
        ++at;
    }
    if (*at != '.') {
        return;
    }
    std::vector<Trouble> troubles;
    while (*at == '.') {
        char *end = nullptr;
        const auto n = std::strtoul(at + 1, &end, 10);
        at = end;
        if (n < act.troubles.size()) {
            troubles.push_back(act.troubles[n]);
        }
    }
    act.troubles = std::move(troubles);
}

/// ":3-9": the moves among the blocks 3 to 9, and all that is no move.
void keep_blocks(const char *at, Act &act) {
    if (*at != ':') {
        return;
    }
    char *dash = nullptr;
    const auto from = std::strtoul(at + 1, &dash, 10);
    const auto to = *dash == '-' ? std::strtoul(dash + 1, nullptr, 10) : from;
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < act.blocks.size(); ++i) {
        if (!act.blocks[i].isMove || (i >= from && i <= to)) {
            blocks.push_back(act.blocks[i]);
        }
    }
    act.blocks = std::move(blocks);
}

}  // namespace

Plan reduced(const Plan &plan, const std::string &kept) {
    if (kept.empty()) {
        return plan;
    }
    Plan out = plan;
    out.acts.clear();
    std::istringstream in(kept);
    for (std::string word; std::getline(in, word, ',');) {
        char *end = nullptr;
        const auto number = static_cast<std::size_t>(std::strtoul(word.c_str(), &end, 10));
        if (number < plan.acts.size()) {
            Act act = plan.acts[number];
            const char *at = end;
            keep_troubles(at, act);
            keep_blocks(at, act);
            out.acts.push_back(std::move(act));
        }
    }
    return out;
}

}  // namespace mw::campaign
