// SPDX-License-Identifier: GPL-2.0-or-later
// The shared block between the realtime module `latency` and the readers of its histograms. One writer (the
// thread of the slot); numbers are read individually and may belong to different moments.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::hal::view {

inline constexpr int LATENCY_KEY = 0x4d570310;
inline constexpr std::uint32_t LATENCY_MAGIC = 0x4d576c61;
inline constexpr int LATENCY_THREADS = 4;
inline constexpr int LATENCY_BINS = 2000;

/// Deviations of the intervals between two calls from the period, [-BINS/2, BINS/2) times the bin width.
struct LatencySlot {
    std::atomic<std::int64_t> period_ns, bin_ns;
    std::atomic<std::uint64_t> intervals;
    std::atomic<std::int64_t> last_ns, min_ns, max_ns;  ///< intervals
    std::atomic<double> sum_ns, sum_squares_ns2;        ///< sums of the deviations and of their squares
    std::atomic<std::uint64_t> below, above;
    std::atomic<std::uint64_t> bins[LATENCY_BINS];
};

struct LatencyBlock {
    std::uint32_t magic;
    LatencySlot slots[LATENCY_THREADS];
};

/// Counts one interval. [the writer; realtime]
inline void count_interval(LatencySlot &slot, std::int64_t interval_ns) noexcept {
    constexpr auto RELAXED = std::memory_order_relaxed;
    const std::int64_t deviation = interval_ns - slot.period_ns.load(RELAXED);
    const std::int64_t bin_ns = slot.bin_ns.load(RELAXED);
    const bool first = slot.intervals.load(RELAXED) == 0;
    slot.last_ns.store(interval_ns, RELAXED);
    if (first || interval_ns < slot.min_ns.load(RELAXED)) {
        slot.min_ns.store(interval_ns, RELAXED);
    }
    if (first || interval_ns > slot.max_ns.load(RELAXED)) {
        slot.max_ns.store(interval_ns, RELAXED);
    }
    const auto d = static_cast<double>(deviation);
    slot.sum_ns.store(slot.sum_ns.load(RELAXED) + d, RELAXED);
    slot.sum_squares_ns2.store(slot.sum_squares_ns2.load(RELAXED) + d * d, RELAXED);
    // Rounds down also for negative deviations.
    const std::int64_t shifted = deviation + LATENCY_BINS / 2 * bin_ns;
    if (shifted < 0) {
        slot.below.store(slot.below.load(RELAXED) + 1, RELAXED);
    } else if (shifted / bin_ns >= LATENCY_BINS) {
        slot.above.store(slot.above.load(RELAXED) + 1, RELAXED);
    } else {
        std::atomic<std::uint64_t> &bin = slot.bins[shifted / bin_ns];
        bin.store(bin.load(RELAXED) + 1, RELAXED);
    }
    slot.intervals.store(slot.intervals.load(RELAXED) + 1, std::memory_order_release);
}

}  // namespace mw::hal::view
