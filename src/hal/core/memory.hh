// SPDX-License-Identifier: GPL-2.0-or-later
// The memory of an instance: each process maps it at its own address, so processes exchange references.
// Memory is never returned before the instance ends. Not realtime-safe, unless stated otherwise. [any
// non-realtime thread and process]
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "base/result.hh"

namespace mw::hal {

namespace detail {
class Segment;
struct BlockRecord;
}  // namespace detail

struct RecordCount {
    int active = 0;
    int recycled = 0;  ///< removed records available for reuse
};

struct MemoryStatistics {
    std::size_t segment_bytes = 0;  ///< size of the segment now
    std::size_t capacity_bytes = 0;
    RecordCount components, pins, aliases, signals, params, functs, threads;
};

/// An offset in the memory of an instance, the same in every process; 0: none.
using Reference = std::uint32_t;

/// A block of rtapi_shmem_* or rtapi_fifo_*.
struct SharedBlock {
    int id = 0;
    Reference memory = 0;
};

class Memory {
  public:
    explicit Memory(detail::Segment &segment) : segment_(segment) {}

    /// 8-byte aligned zeroed memory; null when none is left.
    void *allocate(std::size_t bytes);
    /// Address of a reference, null for 0. The reference must come from reference_of(). [any thread,
    /// realtime-safe]
    void *at(Reference reference) const noexcept;
    /// As at() for a reference of unknown origin; null unless `bytes` from that address on are allocated.
    /// [any thread, realtime-safe]
    void *checked_at(std::int64_t reference, std::size_t bytes) const noexcept;
    /// `address` must be in this memory. [any thread, realtime-safe]
    Reference reference_of(const volatile void *address) const noexcept;
    /// True when `bytes` from `address` on are allocated. [any thread, realtime-safe]
    bool contains(const void *address, std::size_t bytes) const noexcept;

    /// The block of this key with one more user; zeroed for the first one. Valid until the instance ends.
    Result<SharedBlock> open_block(int key, std::size_t bytes);
    /// As open_block(), for a block that is never closed.
    Result<void *> shared_block(int key, std::size_t bytes);
    /// Address of a block; `id` must be from open_block(). [any thread, realtime-safe]
    void *block_memory(int id) const noexcept;
    /// Removes one user of a block; false when it has no user.
    bool close_block(int id);
    bool close_block_at(Reference memory);

    /// Takes the lock once, which repairs changes that a dead process left incomplete.
    void repair();
    MemoryStatistics statistics() const;

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
