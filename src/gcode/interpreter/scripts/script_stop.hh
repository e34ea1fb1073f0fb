// SPDX-License-Identifier: GPL-2.0-or-later
// How a thread that must not wait ends a script that runs in another one.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace mw::gcode {

/// One in a process. The thread that runs the interpreter calls begin(). Another thread calls request()
/// during a call of the interpreter. The script host waits for requests in a separate thread.
class ScriptStop {
  public:
    /// A call of the interpreter begins or has ended: what was requested before it does not count any more.
    void begin() noexcept { seen_.store(requests_.load()); }
    /// Scripts of the call that is under way end with an error.
    void request() {
        ++requests_;
        wake();
    }
    bool isDue() const noexcept { return requests_.load() != seen_.load(); }

    /// Of the script host. wait() returns at the next request or wake() after `known`, which it then is. (Not
    /// std::atomic's wait(): its notify_all() does not reach waiters in another shared object.)
    std::uint32_t changes() const {
        const std::lock_guard lock(mutex_);
        return changes_;
    }
    void wait(std::uint32_t &known) const {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return changes_ != known; });
        known = changes_;
    }
    void wake() {
        const std::lock_guard lock(mutex_);
        ++changes_;
        changed_.notify_all();
    }
    /// Where the script was that had to end last, "file:line"; empty: no script ran.
    void set_place(std::string place) {
        const std::lock_guard lock(mutex_);
        place_ = std::move(place);
    }
    std::string place() const {
        const std::lock_guard lock(mutex_);
        return place_;
    }

  private:
    std::atomic<std::uint32_t> requests_{0}, seen_{0};
    mutable std::mutex mutex_;  ///< held for moments only
    mutable std::condition_variable changed_;
    std::uint32_t changes_ = 0;
    std::string place_;
};

/// That of this process.
ScriptStop &script_stop();

}  // namespace mw::gcode
