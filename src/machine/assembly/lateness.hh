// SPDX-License-Identifier: GPL-2.0-or-later
// Finds out from statistics of the kernel why the threads of task's cycles were late.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mw::machine {

/// Times of threads since their start.
struct ThreadTimes {
    std::int64_t clock_ns = 0;
    std::int64_t ran_ns = 0;     ///< time on a processor
    std::int64_t waited_ns = 0;  ///< time ready to run while other threads ran
};

/// Message for the operator if more than LATE_NS lie between two cycles.
std::optional<std::string> why_late(const ThreadTimes &before, const ThreadTimes &now);

inline constexpr std::int64_t LATE_NS = 250000000;

/// All calls come from one thread.
class Lateness {
  public:
    Lateness() = default;
    ~Lateness();
    /// Watches a thread of this process that the cycles need.
    void watch(int thread_id);
    Lateness(const Lateness &) = delete;
    Lateness &operator=(const Lateness &) = delete;

    /// Called at the start of each cycle.
    std::optional<std::string> step(std::int64_t clock_ns);

  private:
    std::vector<int> files_;  ///< schedstat files of the threads; empty if the kernel does not have them
    ThreadTimes last_;
};

}  // namespace mw::machine
