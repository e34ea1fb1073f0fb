// SPDX-License-Identifier: GPL-2.0-or-later
// Detects whether the realtime side runs: it writes a status in each servo cycle.
#pragma once

#include <cstdint>

namespace mw::task {

/// All calls come from one thread.
class MotionWatch {
  public:
    /// Called once in each task cycle. Returns true once for each silence, to notify the operator.
    bool step(std::uint64_t motion_cycle, std::int64_t now_ns) {
        if (motion_cycle != cycle_) {
            cycle_ = motion_cycle;
            seen_ns_ = now_ns;
            reported_ = false;
        }
        silent_ns_ = now_ns - seen_ns_;
        const bool report_due = silent_ns_ >= TOLD_NS && !reported_;
        reported_ = reported_ || report_due;
        return report_due;
    }
    /// True while commands may not be executed.
    bool isSilent() const { return silent_ns_ >= SILENT_NS; }

  private:
    static constexpr std::int64_t SILENT_NS = 20000000, TOLD_NS = 250000000;
    std::uint64_t cycle_ = 0;
    std::int64_t seen_ns_ = 0, silent_ns_ = 0;
    bool reported_ = true;  ///< the silence has been reported; initially true, so that silence before the
                            ///< first status is not reported
};

}  // namespace mw::task
