// SPDX-License-Identifier: GPL-2.0-or-later
// A lock and a bell in memory that processes share.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>

#include "clients/nml/timeout.hh"

namespace mw::nml {

std::int64_t monotonic_ns();

/// The end of a wait that starts now. [CLOCK_MONOTONIC]
class Deadline {
  public:
    explicit Deadline(Timeout timeout);
    bool isOver() const { return !timeout_.isForever() && monotonic_ns() >= end_ns_; }
    std::int64_t left_ns() const;
    Timeout timeout() const { return timeout_; }
    std::int64_t end_ns() const { return end_ns_; }

  private:
    Timeout timeout_;
    std::int64_t end_ns_ = 0;
};

/// The kernel releases the lock when its holder dies; the next process finds the completed changes of the
/// holder.
class SharedLock {
  public:
    enum class Outcome { TAKEN, TIME_OVER, BROKEN };

    /// Called by the process that creates the memory, before other processes know it.
    bool initialise();
    Outcome take(const Deadline &deadline);
    void release();

  private:
    pthread_mutex_t mutex_;
};

/// A futex on which processes sleep. It counts its rings; zero: it has not rung.
class Bell {
  public:
    std::uint32_t heard() const { return rings_.load(std::memory_order_acquire); }
    void ring();
    /// Sleeps until the bell has rung since `heard`, for at most `longest_ns`; may return earlier.
    void sleep(std::uint32_t heard, std::int64_t longest_ns);

  private:
    std::atomic<std::uint32_t> rings_{0};
    /// Number of processes that may sleep. A killed process remains counted, which only costs a system call.
    std::atomic<std::uint32_t> sleepers_{0};
};

}  // namespace mw::nml
