// SPDX-License-Identifier: GPL-2.0-or-later
// Layout of messages in the memory of a buffer. A process that is killed, at any instruction, leaves them
// whole: each change takes effect with one store.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>

#include "clients/nml/buffer/buffer.hh"
#include "clients/nml/buffer/shared_lock.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

/// What a process that uses the buffer has there.
struct Seat {
    std::atomic<std::uint64_t> owner{0};  ///< mailbox::owner_word(), 0: free
    std::atomic<std::uint32_t> connections{0};
    std::atomic<std::uint64_t> writes{0}, reads{0}, bytes_written{0}, bytes_read{0};
    std::atomic<std::int64_t> last_access_ns{0}, longest_wait_ns{0};
};

/// The beginning of the memory.
struct StoreHead {
    SharedLock lock;
    std::atomic<std::uint32_t> isReady{0};
    Bell message_bell;                      ///< something was written
    Bell room_bell;                         ///< something was taken out of a queue
    std::atomic<std::uint64_t> newest{0};   ///< number of the last write
    std::atomic<std::uint64_t> cleared{0};  ///< of the last one that was cleared away
    std::atomic<std::uint64_t> first{0};    ///< of a queue: words taken out since the start
    std::atomic<std::uint64_t> end{0};      ///< words put in
};

/// How much of what there is.
struct StoreShape {
    bool is_queue = false;
    std::size_t words = 0;  ///< of a copy, or of the queue
    std::size_t copies = 1;
    std::size_t seats = 1;

    static StoreShape of(const BufferSettings &buffer);
    std::size_t bytes() const;
    std::uint64_t hash() const;
};

/// Does not lock: callers keep writers apart, and readers of a queue. Reading a store that is no queue needs
/// no lock.
class Store {
  public:
    enum class Outcome {
        DONE,
        NOTHING,   ///< there is no message
        AGAIN,     ///< a write came between
        NO_ROOM,   ///< in the queue, now
        TOO_LONG,  ///< for the buffer, ever
        DAMAGED,   ///< the memory was written to by something else
    };

    Store() = default;
    Store(void *memory, const StoreShape &shape);

    /// Zeroed memory becomes an empty store.
    bool initialise();
    StoreHead &head() const { return *head_; }
    std::span<Seat> seats() const;

    Outcome write(std::string_view bytes, WriteNumber &number);
    /// Of a queue the oldest, else the newest after `seen`. `isTaken`: out of the queue.
    Outcome read(Received &message, WriteNumber seen, bool isTaken);
    void clear();

  private:
    using WordOf = std::atomic<std::uint64_t>;
    static constexpr std::size_t RECORD_HEAD = 2;  ///< words: number and size

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
