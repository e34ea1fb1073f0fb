// SPDX-License-Identifier: GPL-2.0-or-later
// Detects whether the processes of clients run.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "messages/mailbox/segment.hh"

namespace mw::mailbox {

/// Reads /proc in a separate thread, because such reads may block. The thread starts with the first process.
/// The caller, one thread, never waits.
class ProcessWatch {
  public:
    enum class State : std::uint8_t {
        RUNNING,
        STOPPED,  ///< by a signal or a debugger, in two consecutive checks
        ENDED,
    };
    /// Interval between two checks.
    static constexpr std::int64_t PERIOD_NS = 50000000;

    ProcessWatch() = default;
    ProcessWatch(const ProcessWatch &) = delete;
    ProcessWatch &operator=(const ProcessWatch &) = delete;
    ~ProcessWatch();

    /// Watches the process from now on; RUNNING until the first check. `owner`: owner_word().
    State state_of(std::uint64_t owner);
    void forget(std::uint64_t owner);

  private:
    struct Watched {
        std::atomic<std::uint64_t> owner{0};  ///< 0: free
        std::atomic<State> state{State::RUNNING};
    };
    void run();

    std::array<Watched, MAX_CLIENTS> watched_;
    std::atomic<std::uint32_t> count_{0};  ///< number of watched processes; the thread sleeps at 0
    std::atomic<bool> isEnding_{false};
    std::thread thread_;
};

}  // namespace mw::mailbox
