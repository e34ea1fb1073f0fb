// SPDX-License-Identifier: GPL-2.0-or-later
// Reading snapshots (base/seqlock.hh, base/parted_seqlock.hh) outside realtime threads.
#pragma once

#include <chrono>
#include <thread>

namespace mw {

/// Reads `value` from `lock`; a writer that was interrupted within its write gets the processor, as it may be
/// of this core. False when it has not ended the write within `patience`, and as soon as `isAlive()` says
/// that it never will. Not for realtime threads: it sleeps.
template <class Lock, class Value, class IsAlive>
bool read_patiently(const Lock &lock, Value &value, std::chrono::milliseconds patience,
                    const IsAlive &isAlive) {
    using Clock = std::chrono::steady_clock;
    constexpr int TRIES = 1000;  // longer than any write takes that is not interrupted
    if (lock.read(value, TRIES)) {
        return true;
    }
    const auto end = Clock::now() + patience;
    while (Clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::microseconds(50));
        const bool isWriterAlive = isAlive();  // before the read: what it wrote last is seen
        if (lock.read(value, TRIES)) {
            return true;
        }
        if (!isWriterAlive) {
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
