// SPDX-License-Identifier: GPL-2.0-or-later
// One power cut: the rules for the offer after it and for the motion from there. Knows the moves that motion
// receives, and files; nothing of the journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace mw::power_cut {

struct Verdict {
    std::string kind;     ///< result: offered, rejected, ended before
    std::string trouble;  ///< violation; empty: none
    int late_ms = 0;      ///< cutting distance from the offered position to the tool
};

/// A random program, instant and disk, which are the same for the same seed.
Verdict judge_power_cut(std::uint64_t seed, const std::filesystem::path &folder);

}  // namespace mw::power_cut
