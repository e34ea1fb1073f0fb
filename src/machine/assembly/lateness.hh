// SPDX-License-Identifier: GPL-2.0-or-later
// The reasons why the threads of task's cycles were late, from statistics of the kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mw::machine {

/// Times of threads since their start.
struct ThreadTimes {
    std::int64_t clock_ns = 0;
    std::int64_t ran_ns = 0;     ///< on a processor
    std::int64_t waited_ns = 0;  ///< ready to run while other threads ran
};

/// Message for the operator, when more than LATE_NS lie between two cycles.
std::optional<std::string> why_late(const ThreadTimes &before, const ThreadTimes &now);

inline constexpr std::int64_t LATE_NS = 250000000;

/// One thread.
class Lateness {
  public:
    Lateness() = default;
    ~Lateness();
    /// Watches a thread of this process that the cycles need.
    void watch(int thread_id);
    Lateness(const Lateness &) = delete;
    Lateness &operator=(const Lateness &) = delete;

    /// At the start of each cycle.
    std::optional<std::string> step(std::int64_t clock_ns);

  private:
    std::vector<int> files_;  ///< schedstat of each thread; none if the kernel does not have it
    ThreadTimes last_;
};

}  // namespace mw::machine
