// SPDX-License-Identifier: GPL-2.0-or-later
// One writer publishes a snapshot. Any number of readers in any process read consistent copies of it. Source:
// H. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/copyable_atomic.hh"

namespace mw {

/// The payload is stored as relaxed atomic words, so a torn read is a retry and not undefined behaviour.
/// write(): one thread only, wait-free. read(): any thread; retries during a write.
template <class T>
class Seqlock {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// Publishes `value`. [writer thread]
    void write(const T &value) noexcept {
        const std::uint32_t seq = sequence_.load(std::memory_order_relaxed);
        sequence_.store(seq + 1, std::memory_order_relaxed);
        // Release fence: a reader that sees any new word (after its acquire fence) also sees the odd
        // sequence.
        std::atomic_thread_fence(std::memory_order_release);
        const char *from = reinterpret_cast<const char *>(&value);
#pragma GCC unroll 8
        for (std::size_t i = 0; i < WHOLE_WORDS; ++i) {
            std::uint64_t word = 0;
            std::memcpy(&word, from + i * 8, 8);
            words_[i].store(word, std::memory_order_relaxed);
        }
        if constexpr (REST > 0) {
            std::uint64_t word = 0;
            std::memcpy(&word, from + WHOLE_WORDS * 8, REST);
            words_[WHOLE_WORDS].store(word, std::memory_order_relaxed);
        }
        // Release: a reader that sees the even sequence (acquire) sees every word of this write.
        sequence_.store(seq + 2, std::memory_order_release);
    }

    /// Changes with each write. Data that was read at the current version is valid. [any thread]
    std::uint32_t version() const noexcept { return sequence_.load(std::memory_order_acquire); }

    /// Tries to read once. Returns false during a write. [any thread]
    bool try_read(T &value) const noexcept {
        const std::uint32_t before = sequence_.load(std::memory_order_acquire);
        if ((before & 1U) != 0) {
            return false;
        }
        char *to = reinterpret_cast<char *>(&value);
#pragma GCC unroll 8
        for (std::size_t i = 0; i < WHOLE_WORDS; ++i) {
            const std::uint64_t word = words_[i].load(std::memory_order_relaxed);
            std::memcpy(to + i * 8, &word, 8);
        }
        if constexpr (REST > 0) {
            const std::uint64_t word = words_[WHOLE_WORDS].load(std::memory_order_relaxed);
            std::memcpy(to + WHOLE_WORDS * 8, &word, REST);
        }
        // Acquire fence: pairs with the writer's release fence, so the check below cannot pass on mixed
        // words.
        std::atomic_thread_fence(std::memory_order_acquire);
        return sequence_.load(std::memory_order_relaxed) == before;
    }

    /// Reads with at most `tries` attempts; false when the writer died during a write. [any thread]
    bool read(T &value, int tries = 1000000) const noexcept {
        for (int i = 0; i < tries; ++i) {
            if (try_read(value)) {
                return true;
            }
        }
        return false;
    }

  private:
    static constexpr std::size_t WHOLE_WORDS = sizeof(T) / 8, REST = sizeof(T) % 8;
    static constexpr std::size_t WORDS = (sizeof(T) + 7) / 8;
    CopyableAtomic<std::uint32_t> sequence_{0};
    std::array<CopyableAtomic<std::uint64_t>, WORDS> words_{};
};

}  // namespace mw
