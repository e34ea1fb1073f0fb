// SPDX-License-Identifier: GPL-2.0-or-later
// A call into the interpreter that may take long: a file on a slow disk, a script. While it does, another
// thread carries out stops.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::task {

/// Two threads share task. Its own thread runs Task::step(). The other one may run Task::step_apart(), and
/// use task, only between take() and give_back(), and take() succeeds only while the first one is in a call.
/// So at most one thread uses task at any time, apart from the call itself.
class LongCall {
  public:
    /// Task's own thread: around each call that may take long. Calls do not nest.
    void begin() noexcept { state_.store(State::CALLING, std::memory_order_release); }
    /// Waits while the other thread uses task.
    void end() noexcept {
        State expected = State::CALLING;
        while (!state_.compare_exchange_strong(expected, State::NONE, std::memory_order_acq_rel)) {
            state_.wait(State::TAKEN, std::memory_order_acquire);
            expected = State::CALLING;
        }
    }

    /// The other thread: true when the first one is in a call, which cannot end before give_back().
    bool take() noexcept {
        State expected = State::CALLING;
        return state_.compare_exchange_strong(expected, State::TAKEN, std::memory_order_acq_rel);
    }
    void give_back() noexcept {
        state_.store(State::CALLING, std::memory_order_release);
        state_.notify_one();
    }

    class During {
      public:
        explicit During(LongCall &call) noexcept : call_(call) { call_.begin(); }
        ~During() { call_.end(); }
        During(const During &) = delete;
        During &operator=(const During &) = delete;

      private:
        LongCall &call_;
    };

  private:
    enum class State : std::uint8_t { NONE, CALLING, TAKEN };
    std::atomic<State> state_{State::NONE};
};

}  // namespace mw::task
