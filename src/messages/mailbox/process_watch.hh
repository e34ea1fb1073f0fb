// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the processes of clients run.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "messages/mailbox/segment.hh"

namespace mw::mailbox {

/// Reads /proc in a separate thread, which begins with the first process: what it reads may block. Its
/// caller, one thread, never waits.
class ProcessWatch {
  public:
    enum class State : std::uint8_t {
        RUNNING,
        STOPPED,  ///< by a signal or a debugger, in two looks one after the other
        ENDED,
    };
    /// Between two looks.
    static constexpr std::int64_t PERIOD_NS = 50000000;

    ProcessWatch() = default;
    ProcessWatch(const ProcessWatch &) = delete;
    ProcessWatch &operator=(const ProcessWatch &) = delete;
    ~ProcessWatch();

    /// Watches the process from here on; RUNNING until the first look. `owner`: owner_word().
    State state_of(std::uint64_t owner);
    void forget(std::uint64_t owner);

  private:
    struct Watched {
        std::atomic<std::uint64_t> owner{0};  ///< 0: free
        std::atomic<State> state{State::RUNNING};
    };
    void run();

    std::array<Watched, MAX_CLIENTS> watched_;
    std::atomic<std::uint32_t> count_{0};  ///< processes watched; the thread sleeps at 0
    std::atomic<bool> isEnding_{false};
    std::thread thread_;
};

}  // namespace mw::mailbox
