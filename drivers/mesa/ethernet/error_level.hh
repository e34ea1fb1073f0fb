// SPDX-License-Identifier: GPL-2.0-or-later
// The rule by which failed cycles become a fault. Source: shared/hardware.md, part A3.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mw::mesa {

/// Values of the parameters packet-error-* and packet-read-timeout.
struct EthernetSettings {
    int read_timeout = 80;  ///< up to 0: 80 percent of the period; up to 99: percent of the period; above:
                            ///< nanoseconds
    int error_limit = 10;
    int error_increment = 2;
    int error_decrement = 1;
};

/// A level that each failed cycle increases and each good cycle decreases.
class ErrorLevel {
  public:
    /// Called at the end of a cycle. Returns true when the level has just reached the limit.
    bool count(bool failed, const EthernetSettings &settings) noexcept {
        total_ += failed ? 1U : 0U;
        const bool before = exceeded_;
        const int change =
            failed ? std::max(settings.error_increment, 0) : -std::max(settings.error_decrement, 0);
        level_ = std::clamp(level_ + change, 0, std::max(settings.error_limit, 1));
        exceeded_ = before || level_ >= std::max(settings.error_limit, 1);
        return exceeded_ && !before;
    }
    /// Called when an operator has acknowledged the fault.
    void reset() noexcept {
        level_ = 0;
        exceeded_ = false;
    }

    int level() const noexcept { return level_; }
    bool isExceeded() const noexcept { return exceeded_; }
    /// Number of all failed cycles.
    std::uint32_t total() const noexcept { return total_; }

  private:
    int level_ = 0;
    bool exceeded_ = false;
    std::uint32_t total_ = 0;
};

/// Time that a cycle waits for the answer [ns], for a thread with `period_ns`.
constexpr std::int64_t read_timeout_ns(int setting, long period_ns) noexcept {
    constexpr int PERCENT_OF_DEFAULT = 80, LEAST_NANOSECONDS = 100;
    constexpr std::int64_t LEAST_OF_PERCENT_NS = 100'000;
    if (setting >= LEAST_NANOSECONDS) {
        return setting;
    }
    const int percent = setting <= 0 ? PERCENT_OF_DEFAULT : setting;
    return std::max(LEAST_OF_PERCENT_NS, static_cast<std::int64_t>(period_ns) * percent / 100);
}

}  // namespace mw::mesa
