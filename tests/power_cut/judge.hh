// SPDX-License-Identifier: GPL-2.0-or-later
// Judges one power cut: rules for the offer after it and for the motion from there. Uses the moves that
// motion receives, and files; nothing of the journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace mw::power_cut {

struct Verdict {
    std::string kind;     ///< result: offered, rejected, ended before
    std::string trouble;  ///< violation; empty: none
    int late_ms = 0;      ///< cutting time from the offered position to the tool
};

/// A random program, time and disk; the same seed gives the same values.
Verdict judge_power_cut(std::uint64_t seed, const std::filesystem::path &folder);

}  // namespace mw::power_cut
