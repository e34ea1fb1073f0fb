// SPDX-License-Identifier: GPL-2.0-or-later
// A queue between one producer and one consumer, in one process or through shared memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "base/copyable_atomic.hh"
#include "base/raw_array.hh"

namespace mw {

/// Wait-free ring of N (a power of two) trivially copyable elements. Holds no pointers, so it may live in
/// shared memory. Counters run freely and wrap at 2^32, which N divides.
template <class T, std::uint32_t N>
class SpscRing {
    static_assert(std::is_trivially_copyable_v<T>);
    static_assert(N > 0 && (N & (N - 1)) == 0, "size must be a power of two");

  public:
    /// Appends the element; false when full. [producer]
    bool push(const T &value) noexcept {
        const std::uint32_t head = head_.load(std::memory_order_relaxed);
        // Acquire: pairs with pop's release; the slot has been read before we overwrite it.
        if (head - tail_.load(std::memory_order_acquire) == N) {
            return false;
        }
        slots_[head & (N - 1)] = value;
        // Release: pairs with pop's acquire; the consumer that sees the new head sees the slot filled.
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    /// Removes the oldest element and returns it in `value`; false when empty. [consumer]
    bool pop(T &value) noexcept {
        const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
        // Acquire: pairs with push's release.
        if (head_.load(std::memory_order_acquire) == tail) {
            return false;
        }
        value = slots_[tail & (N - 1)];
        // Release: pairs with push's acquire; the producer reuses the slot only after our copy.
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    /// The oldest element, or nullptr. Valid until pop or drop. [consumer]
    const T *front() const noexcept {
        const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
        return head_.load(std::memory_order_acquire) == tail ? nullptr : &slots_[tail & (N - 1)];
    }

    /// Drops the oldest element, which must exist. [consumer]
    void drop() noexcept {
        tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

    /// Elements waiting; exact for the calling side at the time of the call. [any]
    std::uint32_t size() const noexcept {
        return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
    }
    bool isEmpty() const noexcept { return size() == 0; }
    static constexpr std::uint32_t capacity() noexcept { return N; }

  private:
    alignas(64) CopyableAtomic<std::uint32_t> head_{0};
    alignas(64) CopyableAtomic<std::uint32_t> tail_{0};
    alignas(64) RawArray<T, N> slots_;
};

}  // namespace mw
