// SPDX-License-Identifier: GPL-2.0-or-later
// Why the threads that run task's cycles came too late: the kernel's figures of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mw::machine {

/// Of threads, since they began.
struct ThreadTimes {
    std::int64_t clock_ns = 0;
    std::int64_t ran_ns = 0;     ///< on a processor
    std::int64_t waited_ns = 0;  ///< they could run, and others ran
};

/// For the operator, when more than LATE_NS lie between two cycles.
std::optional<std::string> why_late(const ThreadTimes &before, const ThreadTimes &now);

inline constexpr std::int64_t LATE_NS = 250000000;

/// One thread.
class Lateness {
  public:
    Lateness() = default;
    ~Lateness();
    /// A thread of this process that the cycles need.
    void watch(int thread_id);
    Lateness(const Lateness &) = delete;
    Lateness &operator=(const Lateness &) = delete;

    /// At the begin of each cycle.
    std::optional<std::string> step(std::int64_t clock_ns);

  private:
    std::vector<int> files_;  ///< schedstat of each; none where the kernel does not have it
    ThreadTimes last_;
};

}  // namespace mw::machine
