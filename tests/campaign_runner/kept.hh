// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of a session that are kept, to find a short session that also fails: "0,2:0-5,3x,4.1" are act 0,
// act 2 with its blocks 0 to 5, act 3 without troubles, act 4 with its trouble 1. Empty: all.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace mw::campaign_runner {

struct ActSize {
    std::size_t troubles = 0, blocks = 0;
};

/// A part of an act.
struct Kept {
    std::size_t act = 0;
    bool areTroublesChosen = false;  ///< otherwise all of them
    std::vector<std::size_t> troubles;
    bool areBlocksCut = false;  ///< otherwise all of them
    std::size_t from = 0, to = 0;

    bool hasTrouble(std::size_t trouble) const;
    bool hasBlock(std::size_t block) const { return !areBlocksCut || (block >= from && block <= to); }
};

std::vector<Kept> parse_kept(const std::string &text);
std::string str(const std::vector<Kept> &all);

/// Removes acts, troubles and blocks as long as `fails` reports that the rest still fails.
std::string shrink(const std::vector<ActSize> &acts, const std::function<bool(const std::string &)> &fails);

}  // namespace mw::campaign_runner
