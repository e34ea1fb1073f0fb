// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a plan.
#include "campaign/plan.hh"
#include "campaign_runner/kept.hh"

namespace mw::campaign {
namespace {

/// When blocks are reduced, only moves are removed; all other blocks remain.
Act part_of(Act act, const campaign_runner::Kept &kept) {
    std::vector<Trouble> troubles;
    for (std::size_t i = 0; i < act.troubles.size(); ++i) {
        if (kept.hasTrouble(i)) {
            troubles.push_back(act.troubles[i]);
        }
    }
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < act.blocks.size(); ++i) {
        if (!act.blocks[i].isMove || kept.hasBlock(i)) {
            blocks.push_back(act.blocks[i]);
        }
    }
    act.troubles = std::move(troubles);
    act.blocks = std::move(blocks);
    return act;
}

}  // namespace

Plan reduced(const Plan &plan, const std::string &kept) {
    if (kept.empty()) {
        return plan;
    }
    Plan out = plan;
    out.acts.clear();
    for (const campaign_runner::Kept &one : campaign_runner::parse_kept(kept)) {
        if (one.act < plan.acts.size()) {
            out.acts.push_back(part_of(plan.acts[one.act], one));
        }
    }
    return out;
}

}  // namespace mw::campaign
