// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign_runner/kept.hh"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

namespace mw::campaign_runner {
namespace {

Kept parse_one(const std::string &word) {
    Kept kept;
    char *at = nullptr;
    kept.act = std::strtoul(word.c_str(), &at, 10);
    if (*at == 'x') {
        kept.areTroublesChosen = true;
        ++at;
    }
    while (*at == '.') {
        kept.areTroublesChosen = true;
        kept.troubles.push_back(std::strtoul(at + 1, &at, 10));
    }
    if (*at == ':') {
        kept.areBlocksCut = true;
        kept.from = std::strtoul(at + 1, &at, 10);
        kept.to = *at == '-' ? std::strtoul(at + 1, &at, 10) : kept.from;
    }
    return kept;
}

std::string str(const Kept &kept) {
    std::string out = std::to_string(kept.act) + (kept.troubles.empty() ? "x" : "");
    for (const std::size_t trouble : kept.troubles) {
        out += "." + std::to_string(trouble);
    }
    return out + (kept.areBlocksCut ? fmt::format(":{}-{}", kept.from, kept.to) : std::string());
}

std::vector<Kept> whole(const std::vector<ActSize> &acts) {
    std::vector<Kept> all;
    for (std::size_t n = 0; n < acts.size(); ++n) {
        Kept kept{n, true, {}, false, 0, acts[n].blocks};
        for (std::size_t t = 0; t < acts[n].troubles; ++t) {
            kept.troubles.push_back(t);
        }
        all.push_back(kept);
    }
    return all;
}

}  // namespace

bool Kept::hasTrouble(std::size_t trouble) const {
    return !areTroublesChosen || std::ranges::find(troubles, trouble) != troubles.end();
}

std::vector<Kept> parse_kept(const std::string &text) {
    std::vector<Kept> all;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) {
        all.push_back(parse_one(word));
    }
    return all;
}

std::string str(const std::vector<Kept> &all) {
    std::string out;
    for (const Kept &kept : all) {
        out += (out.empty() ? "" : ",") + str(kept);
    }
    return out;
}

std::string shrink(const std::vector<ActSize> &acts, const std::function<bool(const std::string &)> &fails) {
    std::vector<Kept> best = whole(acts);
    const auto try_it = [&](const std::vector<Kept> &shorter) {
        const bool isSame = !shorter.empty() && fails(str(shorter));
        best = isSame ? shorter : best;
    };
    for (std::size_t n = best.size(); n-- > 0;) {
        std::vector<Kept> shorter = best;
        shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(n));
        try_it(shorter);
    }
    for (std::size_t n = 0; n < best.size(); ++n) {
        for (std::size_t t = best[n].troubles.size(); t-- > 0;) {
            std::vector<Kept> shorter = best;
            shorter[n].troubles.erase(shorter[n].troubles.begin() + static_cast<std::ptrdiff_t>(t));
            try_it(shorter);
        }
        for (std::size_t step = best[n].to / 2; step > 0; step /= 2) {
            for (const bool isEnd : {true, false}) {
                std::vector<Kept> shorter = best;
                shorter[n].areBlocksCut = true;
                isEnd ? shorter[n].to -= std::min(step, shorter[n].to) : shorter[n].from += step;
                if (shorter[n].from <= shorter[n].to) {
                    try_it(shorter);
                }
            }
        }
    }
    return str(best);
}

}  // namespace mw::campaign_runner
