// SPDX-License-Identifier: GPL-2.0-or-later
// One power cut: what must hold of the offer after it and of what is done from there. Knows moves as motion
// is handed them, and files; nothing of the journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace mw::power_cut {

struct Verdict {
    std::string kind;     ///< result: offered, rejected, ended before
    std::string trouble;  ///< what must not be; empty: nothing
    int late_ms = 0;      ///< by how much cutting the offered place lies before the tool
};

/// A program, an instant and a disk by chance, the same for the same seed.
Verdict judge_power_cut(std::uint64_t seed, const std::filesystem::path &folder);

}  // namespace mw::power_cut
