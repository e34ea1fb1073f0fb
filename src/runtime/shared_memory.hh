// SPDX-License-Identifier: GPL-2.0-or-later
// Memory that processes share, checked before it is used, and grown in place.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/result.hh"
#include "runtime/process.hh"

namespace mw::runtime {

/// What both sides must agree on before either touches the content.
struct SharedLayout {
    std::uint32_t abi_version = 0;
    std::uint64_t layout_hash = 0;  ///< of sizes and offsets of the structs inside
};

/// A mapping with room for `reserve` bytes of addresses, of which size() exist. Growing never moves it, in no
/// process. [not realtime]
class SharedMemory {
  public:
    SharedMemory() = default;
    ~SharedMemory();
    SharedMemory(SharedMemory &&other) noexcept;
    SharedMemory &operator=(SharedMemory &&other) noexcept;

    /// Creates /dev/shm/NAME for this user, zeroed. One left by a dead owner is replaced; one of a living
    /// owner is an error. The creator owns it: the name goes when the object does.
    static Result<SharedMemory> create(const std::string &name, std::size_t size, std::size_t reserve,
                                       const SharedLayout &layout);
    /// Opens what another process created; an error says what differs.
    static Result<SharedMemory> attach(const std::string &name, const SharedLayout &layout);
    /// Without a name, for this process alone.
    static Result<SharedMemory> create_private(std::size_t size, std::size_t reserve,
                                               const SharedLayout &layout);

    /// The content, after a header of this class; 64-byte aligned. Null in an empty object.
    void *data() const noexcept;
    /// Bytes of content that exist, as last grown by anybody. [any thread]
    std::size_t size() const noexcept;
    std::size_t reserve() const noexcept;
    /// Makes at least `size` bytes exist. The caller holds a lock against others who grow.
    Result<> grow(std::size_t size);
    bool contains(const void *pointer) const noexcept;
    /// By the process that created it: nobody finds it any more. Its content stays until it is destroyed.
    void remove() noexcept;
    /// The process that created it.
    ProcessId owner() const noexcept;

    /// Removes what dead owners of this user left whose name begins with `prefix`; their number.
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
    std::string name_;  ///< to unlink; empty when not the owner
};

}  // namespace mw::runtime
