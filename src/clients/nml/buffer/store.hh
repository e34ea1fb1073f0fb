// SPDX-License-Identifier: GPL-2.0-or-later
// Layout of messages in the memory of a buffer. If a process is killed at any instruction, the messages
// remain complete, because each change takes effect with one store.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>

#include "clients/nml/buffer/buffer.hh"
#include "clients/nml/buffer/shared_lock.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// Entry of a process that uses the buffer.
struct Seat {
    std::atomic<std::uint64_t> owner{0};  ///< mailbox::owner_word(), 0: free
    std::atomic<std::uint32_t> connections{0};
    std::atomic<std::uint64_t> writes{0}, reads{0}, bytes_written{0}, bytes_read{0};
    std::atomic<std::int64_t> last_access_ns{0}, longest_wait_ns{0};
};

/// The header at the start of the memory.
struct StoreHead {
    SharedLock lock;
    std::atomic<std::uint32_t> isReady{0};
    Bell message_bell;                      ///< rung after a write
    Bell room_bell;                         ///< rung after a message was removed from a queue
    std::atomic<std::uint64_t> newest{0};   ///< number of the last write
    std::atomic<std::uint64_t> cleared{0};  ///< number of the last write that was cleared
    std::atomic<std::uint64_t> first{0};    ///< queue: words removed since the start
    std::atomic<std::uint64_t> end{0};      ///< queue: words added since the start
};

/// Size of the parts of a store.
struct StoreShape {
    bool is_queue = false;
    std::size_t words = 0;  ///< words of a copy, or of the queue
    std::size_t copies = 1;
    std::size_t seats = 1;

    static StoreShape of(const BufferSettings &buffer);
    std::size_t bytes() const;
    std::uint64_t hash() const;
};

/// Does not lock: callers exclude concurrent writers, and concurrent readers of a queue. A store that is not
/// a queue can be read without a lock.
class Store {
  public:
    enum class Outcome {
        DONE,
        NOTHING,   ///< there is no message
        AGAIN,     ///< a write occurred during the read
        NO_ROOM,   ///< no space in the queue now
        TOO_LONG,  ///< too long for the buffer
        DAMAGED,   ///< other data were written to the memory
    };

    Store() = default;
    Store(void *memory, const StoreShape &shape);

    /// Makes an empty store from zeroed memory.
    bool initialise();
    StoreHead &head() const { return *head_; }
    std::span<Seat> seats() const;

    Outcome write(std::string_view bytes, WriteNumber &number);
    /// The oldest message of a queue, else the newest message after `seen`. `isTaken` removes the message
    /// from a queue.
    Outcome read(Received &message, WriteNumber seen, bool isTaken);
    void clear();

  private:
    using WordOf = std::atomic<std::uint64_t>;
    static constexpr std::size_t RECORD_HEAD = 2;  ///< number of words for number and size

    WordOf *copy(std::uint64_t number) const;
    Outcome write_copy(std::string_view bytes, WriteNumber number);
    Outcome write_queue(std::string_view bytes, WriteNumber number);
    Outcome read_copy(Received &message, WriteNumber seen) const;
    Outcome read_queue(Received &message, bool isTaken);

    StoreHead *head_ = nullptr;
    WordOf *words_ = nullptr;
    StoreShape shape_;
};

}  // namespace mw::nml
