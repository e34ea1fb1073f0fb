// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the realtime side runs: it tells a status in each servo cycle.
#pragma once

#include <cstdint>

namespace mw::task {

/// One thread.
class MotionWatch {
  public:
    /// Once a task cycle. True when the operator is to be told, once for each silence.
    bool step(std::uint64_t motion_cycle, std::int64_t now_ns) {
        if (motion_cycle != cycle_) {
            cycle_ = motion_cycle;
            seen_ns_ = now_ns;
            isTold_ = false;
        }
        silent_ns_ = now_ns - seen_ns_;
        const bool isToBeTold = silent_ns_ >= TOLD_NS && !isTold_;
        isTold_ = isTold_ || isToBeTold;
        return isToBeTold;
    }
    /// What it is asked now is not carried out at once, if at all.
    bool isSilent() const { return silent_ns_ >= SILENT_NS; }

  private:
    static constexpr std::int64_t SILENT_NS = 20000000, TOLD_NS = 250000000;
    std::uint64_t cycle_ = 0;
    std::int64_t seen_ns_ = 0, silent_ns_ = 0;
    bool isTold_ = true;  ///< before its first sign there is nothing to tell
};

}  // namespace mw::task
