// SPDX-License-Identifier: GPL-2.0-or-later
// Latency of realtime threads, measured in a separate realtime process with threads that only count. [one
// thread]
#pragma once

#include <atomic>
#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/host.hh"
#include "hal/tools/view/latency_block.hh"

namespace mw::hal::view {

struct LatencyThread {
    std::string name;
    std::int64_t period_ns = 0;
    int bin_ns = 1000;
};

struct LatencyFigures {
    std::string name;
    std::int64_t period_ns = 0, bin_ns = 0;
    std::uint64_t intervals = 0, below = 0, above = 0;
    std::int64_t last_ns = 0, min_ns = 0, max_ns = 0;
    double mean_ns = 0.0, deviation_ns = 0.0;  ///< mean and standard deviation of the deviations from the
                                               ///< period
    std::vector<std::uint64_t> bins;           ///< LATENCY_BINS bins, the period in the middle

    /// The maximum deviation from the period, early or late [ns].
    std::int64_t jitter_ns() const noexcept;
};

/// "25us", "1ms", "0.001s", "25000" (ns) as nanoseconds.
Result<std::int64_t> parse_period(const std::string &text);

/// Creates the threads (shortest period first, 1 to 3) in `host`, loads the module and starts them.
Result<> start_latency(Host &host, const std::vector<LatencyThread> &threads);
/// Current counts.
Result<std::vector<LatencyFigures>> read_latency(Instance &hal, const std::vector<LatencyThread> &threads);

/// A line per thread under a headline.
std::string latency_table(const std::vector<LatencyFigures> &figures);
/// Text bars: combines bins to at most `rows`, from the lowest to the highest with counts.
std::string latency_bars(const LatencyFigures &figures, int rows = 24, int columns = 60);
/// Draws a .png or .svg with a histogram for each thread.
Result<> draw_latency(const std::vector<LatencyFigures> &figures, const std::string &note,
                      const std::string &path);

struct LatencyOptions {
    std::vector<LatencyThread> threads;
    double seconds = 0.0;      ///< 0: until a signal
    bool showsBars = false;    ///< histograms at the end
    bool live = false;         ///< redraws the table each second, for a terminal
    std::string picture_path;  ///< file of the picture; empty: none
    std::string csv_path;      ///< CSV file, empty: none; columns thread, deviation [ns], count
    std::string note;          ///< text in the picture
};

/// Measures with a realtime process in a separate instance. `stop` ends it early.
Result<> run_latency(const LatencyOptions &options, volatile std::sig_atomic_t &stop);

}  // namespace mw::hal::view
