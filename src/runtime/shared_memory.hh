// SPDX-License-Identifier: GPL-2.0-or-later
// Memory shared by processes, checked before use, and grown in place.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/result.hh"
#include "runtime/process.hh"

namespace mw::runtime {

/// Properties that both sides must agree on before either uses the content.
struct SharedLayout {
    std::uint32_t abi_version = 0;
    std::uint64_t layout_hash = 0;  ///< hash of sizes and offsets of the structs inside
};

/// A mapping with an address range of `reserve` bytes, of which the first size() bytes exist. Growing does
/// not move the mapping in any process. [not realtime]
class SharedMemory {
  public:
    SharedMemory() = default;
    ~SharedMemory();
    SharedMemory(SharedMemory &&other) noexcept;
    SharedMemory &operator=(SharedMemory &&other) noexcept;

    /// Creates /dev/shm/NAME for this user, zeroed. Replaces a segment of an ended process. A segment of a
    /// running process is an error. The creator owns the segment, and its destructor removes the name.
    static Result<SharedMemory> create(const std::string &name, std::size_t size, std::size_t reserve,
                                       const SharedLayout &layout);
    /// Opens a segment that another process created. An error states which property differs.
    static Result<SharedMemory> attach(const std::string &name, const SharedLayout &layout);
    /// Creates a segment without a name, for this process alone.
    static Result<SharedMemory> create_private(std::size_t size, std::size_t reserve,
                                               const SharedLayout &layout);

    /// The content after the header of this class, 64-byte aligned. Null in an empty object.
    void *data() const noexcept;
    /// Current size of the content [bytes], as grown by any process. [any thread]
    std::size_t size() const noexcept;
    std::size_t reserve() const noexcept;
    /// Grows the content to at least `size` bytes. The caller must hold a lock against concurrent growth.
    Result<> grow(std::size_t size);
    bool contains(const void *pointer) const noexcept;
    /// Removes the name, in the process that created it. The content remains until the object is destroyed.
    void remove() noexcept;
    /// The process that created the segment.
    ProcessId owner() const noexcept;

    /// Removes this user's segments whose name begins with `prefix` and whose owner has ended; returns their
    /// number.
    static int remove_stale(const std::string &prefix);

  private:
    struct Header;
    Header *header() const noexcept;
    static Result<SharedMemory> initialise(int fd, const std::string &name, std::size_t size,
                                           std::size_t reserve, const SharedLayout &layout);
    void close() noexcept;

    void *base_ = nullptr;
    std::size_t mapped_ = 0;
    int fd_ = -1;
    std::string name_;  ///< name to unlink; empty when not the owner
};

}  // namespace mw::runtime
