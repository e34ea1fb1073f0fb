// SPDX-License-Identifier: GPL-2.0-or-later
// Reading snapshots (base/seqlock.hh, base/parted_seqlock.hh) outside realtime threads.
#pragma once

#include <chrono>
#include <thread>

namespace mw {

/// Reads `value` from `lock`. Sleeps between attempts, so that a writer that was preempted on this core can
/// complete its write. False when the write does not end within `patience`, or at once when `isAlive()` is
/// false. Not for realtime threads.
template <class Lock, class Value, class IsAlive>
bool read_patiently(const Lock &lock, Value &value, std::chrono::milliseconds patience,
                    const IsAlive &isAlive) {
    using Clock = std::chrono::steady_clock;
    constexpr int TRIES = 1000;  // longer than any write that is not preempted
    if (lock.read(value, TRIES)) {
        return true;
    }
    const auto end = Clock::now() + patience;
    while (Clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::microseconds(50));
        // checked before the read, so that the read includes the writer's last write
        const bool writer_alive = isAlive();
        if (lock.read(value, TRIES)) {
            return true;
        }
        if (!writer_alive) {
            return false;
        }
    }
    return false;
}

template <class Lock, class Value>
bool read_patiently(const Lock &lock, Value &value, std::chrono::milliseconds patience) {
    return read_patiently(lock, value, patience, [] { return true; });
}

}  // namespace mw
