// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/buffer/store.hh"

#include <algorithm>
#include <cstring>

namespace mw::nml {
namespace {

constexpr std::size_t WORD = 8;
constexpr std::size_t ALIGNED = 64;

std::size_t words_for(std::size_t bytes) {
    return (bytes + WORD - 1) / WORD;
}
std::size_t aligned(std::size_t bytes) {
    return (bytes + ALIGNED - 1) / ALIGNED * ALIGNED;
}
std::size_t seats_at() {
    return aligned(sizeof(StoreHead));
}
std::size_t words_at(const StoreShape &shape) {
    return seats_at() + aligned(shape.seats * sizeof(Seat));
}

}  // namespace

StoreShape StoreShape::of(const BufferSettings &buffer) {
    StoreShape shape;
    shape.is_queue = buffer.is_queue;
    shape.words = words_for(buffer.size);
    // At least two copies, so that a writer that dies has not changed the valid one.
    shape.copies = buffer.is_queue              ? 1
                   : buffer.mutex == Mutex::MAO ? static_cast<std::size_t>(buffer.copies)
                                                : 2;
    shape.seats = static_cast<std::size_t>(buffer.max_processes);
    return shape;
}

std::size_t StoreShape::bytes() const {
    const std::size_t each = is_queue ? words : words + 2;
    return words_at(*this) + each * copies * WORD;
}

std::uint64_t StoreShape::hash() const {
    constexpr std::uint64_t FNV_PRIME = 1099511628211ULL;
    std::uint64_t hash = 14695981039346656037ULL;
    for (const std::uint64_t part :
         {std::uint64_t{is_queue}, std::uint64_t{words}, std::uint64_t{copies}, std::uint64_t{seats},
          std::uint64_t{sizeof(StoreHead)}, std::uint64_t{sizeof(Seat)}}) {
        hash = (hash ^ part) * FNV_PRIME;
    }
    return hash;
}

Store::Store(void *memory, const StoreShape &shape)
    : head_(std::launder(static_cast<StoreHead *>(memory))),
      words_(std::launder(reinterpret_cast<WordOf *>(static_cast<char *>(memory) + words_at(shape)))),
      shape_(shape) {}

bool Store::initialise() {
    const bool is_good = head_->lock.initialise();
    // Release: a process that sees the store as ready may use the lock.
    head_->isReady.store(is_good ? 1 : 0, std::memory_order_release);
    return is_good;
}

std::span<Seat> Store::seats() const {
    return {std::launder(reinterpret_cast<Seat *>(reinterpret_cast<char *>(head_) + seats_at())),
            shape_.seats};
}

Store::WordOf *Store::copy(std::uint64_t number) const {
    return words_ + (number % shape_.copies) * (shape_.words + RECORD_HEAD);
}

Store::Outcome Store::write(std::string_view bytes, WriteNumber &number) {
    number = head_->newest.load(std::memory_order_relaxed) + 1;
    return shape_.is_queue ? write_queue(bytes, number) : write_copy(bytes, number);
}

Store::Outcome Store::write_copy(std::string_view bytes, WriteNumber number) {
    const std::size_t count = words_for(bytes.size());
    if (count > shape_.words) {
        return Outcome::TOO_LONG;
    }
    WordOf *to = copy(number);
    to[0].store(0, std::memory_order_relaxed);
    // Release fence: a reader that sees any new word (after its acquire fence) also sees that the copy has
    // another number.
    std::atomic_thread_fence(std::memory_order_release);
    to[1].store(bytes.size(), std::memory_order_relaxed);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i * WORD, std::min(WORD, bytes.size() - i * WORD));
        to[RECORD_HEAD + i].store(word, std::memory_order_relaxed);
    }
    to[0].store(number, std::memory_order_release);
    // From here on the copy is valid. Release: a reader that sees the number sees the copy.
    head_->newest.store(number, std::memory_order_release);
    return Outcome::DONE;
}

Store::Outcome Store::read_copy(Received &message, WriteNumber seen) const {
    const std::uint64_t number = head_->newest.load(std::memory_order_acquire);
    if (number <= seen || number <= head_->cleared.load(std::memory_order_acquire)) {
        return Outcome::NOTHING;
    }
    const WordOf *from = copy(number);
    if (from[0].load(std::memory_order_acquire) != number) {
        return Outcome::AGAIN;
    }
    const std::uint64_t size = from[1].load(std::memory_order_relaxed);
    const bool possible = size <= shape_.words * WORD;
    if (possible) {
        message.bytes.resize(size);
        for (std::size_t i = 0; i < words_for(size); ++i) {
            const std::uint64_t word = from[RECORD_HEAD + i].load(std::memory_order_relaxed);
            std::memcpy(message.bytes.data() + i * WORD, &word, std::min<std::size_t>(WORD, size - i * WORD));
        }
    }
    // Acquire fence: pairs with the writer's fence, so the check below cannot pass on mixed words.
    std::atomic_thread_fence(std::memory_order_acquire);
    if (from[0].load(std::memory_order_relaxed) != number) {
        return Outcome::AGAIN;
    }
    message.number = number;
    return possible ? Outcome::DONE : Outcome::DAMAGED;
}

Store::Outcome Store::write_queue(std::string_view bytes, WriteNumber number) {
    const std::size_t need = RECORD_HEAD + words_for(bytes.size());
    if (need > shape_.words) {
        return Outcome::TOO_LONG;
    }
    const std::uint64_t end = head_->end.load(std::memory_order_relaxed);
    // Acquire: pairs with the reader's release; words that were read may be overwritten.
    const std::uint64_t used = end - head_->first.load(std::memory_order_acquire);
    if (used > shape_.words) {
        return Outcome::DAMAGED;
    }
    if (used + need > shape_.words) {
        return Outcome::NO_ROOM;
    }
    std::uint64_t at = end;
    const auto next = [this, &at](std::uint64_t word) {
        words_[at++ % shape_.words].store(word, std::memory_order_relaxed);
    };
    next(number);
    next(bytes.size());
    for (std::size_t from = 0; from < bytes.size(); from += WORD) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + from, std::min(WORD, bytes.size() - from));
        next(word);
    }
    head_->newest.store(number, std::memory_order_relaxed);
    // From here on the message is valid. Release: a reader that sees the end sees the words before it.
    head_->end.store(end + need, std::memory_order_release);
    return Outcome::DONE;
}

Store::Outcome Store::read_queue(Received &message, bool taken) {
    const std::uint64_t first = head_->first.load(std::memory_order_relaxed);
    const std::uint64_t used = head_->end.load(std::memory_order_acquire) - first;
    if (used == 0) {
        return Outcome::NOTHING;
    }
    if (used > shape_.words || used < RECORD_HEAD) {
        return Outcome::DAMAGED;
    }
    const auto word_at = [&](std::uint64_t at) {
        return words_[(first + at) % shape_.words].load(std::memory_order_relaxed);
    };
    message.number = word_at(0);
    const std::uint64_t size = word_at(1);
    if (size > shape_.words * WORD || RECORD_HEAD + words_for(size) > used) {
        return Outcome::DAMAGED;
    }
    message.bytes.resize(size);
    for (std::size_t i = 0; i < words_for(size); ++i) {
        const std::uint64_t word = word_at(RECORD_HEAD + i);
        std::memcpy(message.bytes.data() + i * WORD, &word, std::min<std::size_t>(WORD, size - i * WORD));
    }
    if (taken) {
        // Release: pairs with the writer's acquire; the writer overwrites words that were read.
        head_->first.store(first + RECORD_HEAD + words_for(size), std::memory_order_release);
    }
    return Outcome::DONE;
}

Store::Outcome Store::read(Received &message, WriteNumber seen, bool taken) {
    return shape_.is_queue ? read_queue(message, taken) : read_copy(message, seen);
}

void Store::clear() {
    head_->cleared.store(head_->newest.load(std::memory_order_acquire), std::memory_order_release);
    head_->first.store(head_->end.load(std::memory_order_acquire), std::memory_order_release);
}

}  // namespace mw::nml
