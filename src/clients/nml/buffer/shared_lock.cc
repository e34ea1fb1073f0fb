// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/buffer/shared_lock.hh"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>

#include "base/duration.hh"

namespace mw::nml {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
/// Longer waits are treated as infinite.
constexpr double LONGEST_S = 1e8;

timespec timespec_of(std::int64_t ns) {
    return {ns / NS_PER_S, ns % NS_PER_S};
}

}  // namespace

std::int64_t monotonic_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

Deadline::Deadline(Timeout timeout) : timeout_(timeout.seconds > LONGEST_S ? FOREVER : timeout) {
    if (!timeout_.isForever()) {
        end_ns_ = monotonic_ns() + to_ns(timeout_.seconds);
    }
}

std::int64_t Deadline::left_ns() const {
    return timeout_.isForever() ? std::numeric_limits<std::int64_t>::max()
                                : std::max<std::int64_t>(end_ns_ - monotonic_ns(), 0);
}

bool SharedLock::initialise() {
    pthread_mutexattr_t kind;
    if (::pthread_mutexattr_init(&kind) != 0) {
        return false;
    }
    const bool is_good = ::pthread_mutexattr_setpshared(&kind, PTHREAD_PROCESS_SHARED) == 0 &&
                         ::pthread_mutexattr_setrobust(&kind, PTHREAD_MUTEX_ROBUST) == 0 &&
                         ::pthread_mutex_init(&mutex_, &kind) == 0;
    ::pthread_mutexattr_destroy(&kind);
    return is_good;
}

SharedLock::Outcome SharedLock::take(const Deadline &deadline) {
    int result = ::pthread_mutex_trylock(&mutex_);
    if (result == EBUSY && !deadline.timeout().isAtOnce()) {
        if (deadline.timeout().isForever()) {
            result = ::pthread_mutex_lock(&mutex_);
        } else {
            const timespec end = timespec_of(deadline.end_ns());
            result = ::pthread_mutex_clocklock(&mutex_, CLOCK_MONOTONIC, &end);
        }
    }
    // data under the lock change only by single stores, so they are always complete
    if (result == EOWNERDEAD) {
        result = ::pthread_mutex_consistent(&mutex_);
    }
    return result == 0                              ? Outcome::TAKEN
           : result == EBUSY || result == ETIMEDOUT ? Outcome::TIME_OVER
                                                    : Outcome::BROKEN;
}

void SharedLock::release() {
    ::pthread_mutex_unlock(&mutex_);
}

void Bell::ring() {
    // Sequentially consistent with the count of sleepers: either the ringing process sees the sleeper, or the
    // sleeper sees the ring.
    rings_.fetch_add(1, std::memory_order_seq_cst);
    if (sleepers_.load(std::memory_order_seq_cst) > 0) {
        ::syscall(SYS_futex, &rings_, FUTEX_WAKE, std::numeric_limits<int>::max(), nullptr, nullptr, 0);
    }
}

void Bell::sleep(std::uint32_t heard, std::int64_t longest_ns) {
    sleepers_.fetch_add(1, std::memory_order_seq_cst);
    const timespec longest = timespec_of(longest_ns);
    // The kernel compares the value again, so a ring between the check and the sleep is not missed.
    if (rings_.load(std::memory_order_seq_cst) == heard) {
        ::syscall(SYS_futex, &rings_, FUTEX_WAIT, heard, &longest, nullptr, 0);
    }
    sleepers_.fetch_sub(1, std::memory_order_seq_cst);
}

}  // namespace mw::nml
