// SPDX-License-Identifier: GPL-2.0-or-later
// The thread that runs the cycles of task, so that the main thread never waits for a file
// or a script: docs/developer/long_calls.md.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "machine/task/run/long_call.hh"

namespace mw::machine {

/// Used by one thread, which may touch task between run() and give_back().
class CycleThread {
  public:
    /// Called with the time of the cycle. `whole` runs in the thread, `apart` in that of run() while `whole`
    /// is in a long call.
    struct Works {
        std::function<void(std::int64_t now_ns)> whole, apart;
    };
    CycleThread(task::LongCall &call, Works works);
    /// Only where the cycle has ended.
    ~CycleThread();
    CycleThread(const CycleThread &) = delete;
    CycleThread &operator=(const CycleThread &) = delete;

    /// A call that has ended meanwhile may return to task.
    void give_back();
    /// A thread in a long call has the priority of other programs: a script may calculate for long.
    /// Begins a cycle unless the last one still runs, and waits for its end; a long call is waited for
    /// PATIENCE_NS, and no longer as long as it takes. Then `apart` has run.
    void run(std::int64_t now_ns);
    /// Waits for the end of the cycle that still runs; false when it takes longer. Then the call does not
    /// return to task any more.
    bool end_call(std::int64_t most_ns);
    /// The last cycle has not ended.
    bool isApart() const { return isTaken_; }

    /// As the kernel names the thread; 0 before its first cycle.
    int thread_id() const { return thread_id_; }

    static constexpr std::int64_t PATIENCE_NS = 20000000;

  private:
    void work();

    task::LongCall &call_;
    Works works_;
    bool isTaken_ = false;
    bool isLate_ = false;
    std::atomic<int> thread_id_ = 0;

    std::mutex mutex_;
    std::condition_variable begun_, ended_;
    // Under the mutex.
    bool isRunning_ = false;
    bool isEnding_ = false;
    std::int64_t now_ns_ = 0;

    std::thread thread_;  ///< last: it uses the rest
};

}  // namespace mw::machine
