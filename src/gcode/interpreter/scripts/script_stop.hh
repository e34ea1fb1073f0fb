// SPDX-License-Identifier: GPL-2.0-or-later
// Lets a thread that must not wait end a script in another thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace mw::gcode {

/// One per process. The thread that runs the interpreter calls begin(). Another thread calls request() during
/// a call of the interpreter. The script host waits for requests in a separate thread.
class ScriptStop {
  public:
    /// Called when a call of the interpreter begins or has ended; earlier requests then have no effect.
    void begin() noexcept { seen_.store(requests_.load()); }
    /// Ends the scripts of the current call with an error.
    void request() {
        ++requests_;
        wake();
    }
    bool isDue() const noexcept { return requests_.load() != seen_.load(); }

    /// For the script host. wait() returns at the next request or wake() after `known`, which it updates.
    /// (Not std::atomic's wait(): its notify_all() does not reach waiters in another shared object.)
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
    /// Position of the last script that was ended, "file:line"; empty if none was running.
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
    mutable std::mutex mutex_;  ///< locked only briefly
    mutable std::condition_variable changed_;
    std::uint32_t changes_ = 0;
    std::string place_;
};

/// The object of this process.
ScriptStop &script_stop();

}  // namespace mw::gcode
