// SPDX-License-Identifier: GPL-2.0-or-later
// The thread that runs the cycles of task, so that the main thread never waits for a file or a script
// (docs/developer/long_calls.md).
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "machine/task/run/long_call.hh"

namespace mw::machine {

/// Used by one thread, which may access task between run() and give_back().
class CycleThread {
  public:
    /// Functions called with the time of the cycle. `whole` runs in the cycle thread, `apart` in the thread
    /// of run() during a long call of `whole`.
    struct Works {
        std::function<void(std::int64_t now_ns)> whole, apart;
    };
    CycleThread(task::LongCall &call, Works works);
    /// Call it only after the end of the cycle.
    ~CycleThread();
    CycleThread(const CycleThread &) = delete;
    CycleThread &operator=(const CycleThread &) = delete;

    /// Permits a completed call to return to task.
    void give_back();
    /// Begins a cycle unless the last one is running, and waits for its end. It waits PATIENCE_NS for a long
    /// call, in later cycles only briefly, and runs `apart`. A thread in a long call has the priority of
    /// other programs, because a script may calculate for a long time.
    void run(std::int64_t now_ns);
    /// Waits for the end of the running cycle; false when it takes longer. The call then does not return to
    /// task.
    bool end_call(std::int64_t most_ns);
    /// True if the last cycle has not ended.
    bool isApart() const { return taken_; }

    /// Thread id from the kernel; 0 before the first cycle.
    int thread_id() const { return thread_id_; }

    static constexpr std::int64_t PATIENCE_NS = 20000000;

  private:
    void work();
    void set_lowered(bool lowered);

    task::LongCall &call_;
    Works works_;
    bool taken_ = false;
    bool late_ = false;
    bool lowered_ = false;  ///< the cycle thread has the priority of other programs
    std::atomic<int> thread_id_ = 0;

    std::mutex mutex_;
    std::condition_variable begun_, ended_;
    // Guarded by the mutex.
    bool running_ = false;
    bool ending_ = false;
    std::int64_t now_ns_ = 0;

    std::thread thread_;  ///< last member, because it uses the other members
};

}  // namespace mw::machine
