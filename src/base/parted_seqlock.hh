// SPDX-License-Identifier: GPL-2.0-or-later
// A snapshot in parts: the writer stores only changed parts, and each reader copies only the parts that
// changed since its last read. In other respects it works as base/seqlock.hh.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <type_traits>

#include "base/copyable_atomic.hh"

namespace mw {

/// Start of each part of a structure [bytes], ascending, the first at 0. Each part extends to the next one.
template <std::size_t N>
using PartStarts = std::array<std::size_t, N>;

/// Bit per part.
using PartMask = std::uint64_t;

/// The mask of `count` parts, beginning with `first`.
constexpr PartMask part_range(int first, int count) noexcept {
    return (count < 64 ? (PartMask{1} << count) - 1 : ~PartMask{0}) << first;
}

/// STARTS is a PartStarts of T; parts begin at multiples of 8 bytes. A reader gets a consistent copy of one
/// instant, as with Seqlock. write(): one thread only, wait-free. read(): any thread; retries during a write.
template <class T, const auto &STARTS>
class PartedSeqlock {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
    static constexpr std::size_t COUNT = STARTS.size();
    static_assert(COUNT > 0 && COUNT <= 64 && STARTS[0] == 0);
    static_assert(std::is_sorted(STARTS.begin(), STARTS.end(), std::less_equal<>{}) || COUNT == 1);
    static_assert(std::all_of(STARTS.begin(), STARTS.end(),
                              [](std::size_t start) { return start % 8 == 0 && start < sizeof(T); }));

  public:
    static constexpr PartMask ALL = part_range(0, COUNT);

    /// The reader's copy.
    struct Copy {
        T value{};
        std::uint64_t sequence = 0;  ///< sequence number of the copied write
        PartMask fresh = 0;          ///< parts copied by the last read
    };

    /// The parts of `parts` that differ from the last write. [writer thread]
    PartMask changed(const T &value, PartMask parts) const noexcept {
        PartMask found = 0;
        for (PartMask rest = parts; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            const bool same = std::memcmp(reinterpret_cast<const char *>(&value) + STARTS[i],
                                          &words_[STARTS[i] / 8], end(i) - STARTS[i]) == 0;
            found |= same ? 0 : PartMask{1} << i;
        }
        return found;
    }

    /// Publishes `parts` of `value`; other parts are not changed. The first write publishes all. [writer
    /// thread]
    void write(const T &value, PartMask parts = ALL) noexcept {
        const std::uint64_t before = sequence_.load(std::memory_order_relaxed);
        const PartMask written = before == 0 ? ALL : parts & ALL;
        sequence_.store(before + 1, std::memory_order_relaxed);
        // Release fence: a reader that sees any new word (after its acquire fence) also sees the odd
        // sequence.
        std::atomic_thread_fence(std::memory_order_release);
        for_each_run(written, [&](std::size_t first, std::size_t last) {
            store(reinterpret_cast<const char *>(&value) + STARTS[first], &words_[STARTS[first] / 8],
                  (end(last) - STARTS[first]) / 8);
            for (std::size_t i = first; i <= last; ++i) {
                versions_[i].store(before + 2, std::memory_order_relaxed);
            }
        });
        newest_.store(written, std::memory_order_relaxed);
        // Release: a reader that sees the even sequence (acquire) sees every word of this write.
        sequence_.store(before + 2, std::memory_order_release);
    }

    /// Updates `copy`, with at most `tries` attempts; before the first write `copy` is not changed. False
    /// when the writer died during a write: `copy.value` may be inconsistent then, until the next successful
    /// read. [any thread]
    bool read(Copy &copy, int tries = 1000000) const noexcept {
        for (int i = 0; i < tries; ++i) {
            const std::uint64_t before = sequence_.load(std::memory_order_acquire);
            if ((before & 1U) != 0) {
                continue;
            }
            const PartMask fresh = copy_parts(copy, before);
            // Acquire fence: pairs with the writer's release fence, so the check below cannot pass on mixed
            // words.
            std::atomic_thread_fence(std::memory_order_acquire);
            if (sequence_.load(std::memory_order_relaxed) == before) {
                copy.fresh = fresh;
                copy.sequence = before;
                return true;
            }
        }
        return false;
    }

  private:
    using Word = CopyableAtomic<std::uint64_t>;
    static constexpr std::size_t BLOCK = 8;  ///< words copied without checking their count

    /// Calls `act` with the first and last part of each run of adjacent parts.
    template <class Act>
    static void for_each_run(PartMask parts, const Act &act) noexcept {
        while (parts != 0) {
            const int first = std::countr_zero(parts);
            const int count = std::countr_one(parts >> first);
            act(static_cast<std::size_t>(first), static_cast<std::size_t>(first + count - 1));
            parts &= ~part_range(first, count);
        }
    }

    static void store(const char *from, Word *to, std::size_t count) noexcept {
        const auto one = [&](std::size_t i) {
            std::uint64_t word = 0;
            std::memcpy(&word, from + i * 8, 8);
            to[i].store(word, std::memory_order_relaxed);
        };
        for (; count >= BLOCK; count -= BLOCK, from += BLOCK * 8, to += BLOCK) {
#pragma GCC unroll 8
            for (std::size_t i = 0; i < BLOCK; ++i) {
                one(i);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            one(i);
        }
    }

    static void load(const Word *from, char *to, std::size_t count) noexcept {
        const auto one = [&](std::size_t i) {
            const std::uint64_t word = from[i].load(std::memory_order_relaxed);
            std::memcpy(to + i * 8, &word, 8);
        };
        for (; count >= BLOCK; count -= BLOCK, from += BLOCK, to += BLOCK * 8) {
#pragma GCC unroll 8
            for (std::size_t i = 0; i < BLOCK; ++i) {
                one(i);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            one(i);
        }
    }

    static constexpr std::size_t end(std::size_t part) noexcept {
        return part + 1 < COUNT ? STARTS[part + 1] : sizeof(T);
    }

    /// Copies the parts that were written after `copy` was read. A failed attempt leaves the version of
    /// `copy` unchanged, so the next attempt copies the same parts again.
    PartMask copy_parts(Copy &copy, std::uint64_t sequence) const noexcept {
        if (sequence == copy.sequence) {
            return 0;
        }
        const bool is_next = sequence == copy.sequence + 2;
        PartMask fresh =
            is_next ? newest_.load(std::memory_order_relaxed) & ALL : written_after(copy.sequence);
        for_each_run(fresh, [&](std::size_t first, std::size_t last) {
            load(&words_[STARTS[first] / 8], reinterpret_cast<char *>(&copy.value) + STARTS[first],
                 (end(last) - STARTS[first]) / 8);
        });
        return fresh;
    }

    PartMask written_after(std::uint64_t sequence) const noexcept {
        PartMask parts = 0;
        for (std::size_t i = 0; i < COUNT; ++i) {
            const bool is_new = versions_[i].load(std::memory_order_relaxed) > sequence;
            parts |= is_new ? PartMask{1} << i : 0;
        }
        return parts;
    }

    CopyableAtomic<std::uint64_t> sequence_{0};
    CopyableAtomic<PartMask> newest_{0};  ///< parts of the last write
    std::array<CopyableAtomic<std::uint64_t>, COUNT> versions_{};
    std::array<Word, sizeof(T) / 8> words_{};
};

}  // namespace mw
