// SPDX-License-Identifier: GPL-2.0-or-later
// A call of the interpreter that may take long: a file on a slow disk, a script. Meanwhile another thread
// executes stops.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::task {

/// Two threads share task. Task's own thread runs Task::step(). The other thread may use task and run
/// Task::step_apart() only between take() and give_back(). take() succeeds only while task's own thread is in
/// a call. So apart from the call itself only one thread uses task at any time.
class LongCall {
  public:
    /// For task's own thread: around each call that may take long. Calls are not nested.
    void begin() noexcept { state_.store(State::CALLING, std::memory_order_release); }
    /// Waits while the other thread uses task.
    void end() noexcept {
        while (true) {
            State now = State::CALLING;
            if (state_.compare_exchange_strong(now, State::NONE, std::memory_order_acq_rel)) {
                return;
            }
            now = State::TAKEN;
            if (state_.compare_exchange_strong(now, State::WAITING, std::memory_order_acq_rel)) {
                state_.wait(State::WAITING, std::memory_order_acquire);
                return;
            }
        }
    }

    /// For the other thread: true if task's own thread is in a call, which cannot end before give_back().
    bool take() noexcept {
        State expected = State::CALLING;
        return state_.compare_exchange_strong(expected, State::TAKEN, std::memory_order_acq_rel);
    }
    /// True if the call has ended meanwhile, so that task's own thread continues now.
    bool give_back() noexcept {
        State expected = State::TAKEN;
        if (state_.compare_exchange_strong(expected, State::CALLING, std::memory_order_acq_rel)) {
            return false;
        }
        state_.store(State::NONE, std::memory_order_release);
        state_.notify_one();
        return true;
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
    /// WAITING: the call has ended, and the other thread still uses task.
    enum class State : std::uint8_t { NONE, CALLING, TAKEN, WAITING };
    std::atomic<State> state_{State::NONE};
};

}  // namespace mw::task
