// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/buffer/open.hh"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include "messages/mailbox/memory.hh"

namespace mw::nml {
namespace {

/// Interval at which a sleeping process checks that the owner of the memory is alive.
constexpr std::int64_t LONGEST_SLEEP_NS = 100000000;
/// Number of writes that may interrupt a reader before it takes the lock.
constexpr int PATIENCE = 32;
constexpr const char *TIME_OVER = "the time is over";

/// Accepts all messages and returns none.
class Phantom final : public Buffer {
  public:
    using Buffer::Buffer;

  private:
    Result<WriteNumber> put(std::string_view, Timeout) override { return ++number_; }
    Result<bool> take(Received &, Timeout) override { return false; }
    Result<bool> look(Received &, Timeout) override { return false; }
    Result<bool> take_next(Received &, Timeout timeout) override {
        if (timeout.isForever()) {
            return bad("a PHANTOM never has a message to wait for");
        }
        Bell never;
        for (const Deadline deadline(timeout); !deadline.isOver();) {
            never.sleep(never.heard(), std::min(deadline.left_ns(), LONGEST_SLEEP_NS));
        }
        return false;
    }
    Result<> empty(Timeout) override { return {}; }

    WriteNumber number_ = 0;
};

class MemoryBuffer final : public Buffer {
  public:
    MemoryBuffer(const BufferSettings &settings, Rights rights, std::shared_ptr<Place> place)
        : Buffer(settings.name, rights), place_(std::move(place)), isQueue_(settings.is_queue),
          isLocked_(settings.mutex != Mutex::NONE),
          isReadLocked_(isLocked_ && (settings.is_queue || settings.mutex != Mutex::MAO)),
          isBlockingAllowed_(settings.isBlockingAllowed()), isDiagnosed_(settings.diagnosed) {}
    ~MemoryBuffer() override { leave(); }

    /// Takes a slot for a process that uses the buffer.
    Result<> join() {
        const auto lock = locked(Deadline({1.0}));
        if (!lock.has_value()) {
            return std::unexpected(lock.error());
        }
        const std::uint64_t me = mailbox::owner_word();
        Seat *free = nullptr;
        for (Seat &seat : store().seats()) {
            const std::uint64_t owner = seat.owner.load();
            if (owner == me) {
                seat.connections.fetch_add(1);
                seat_ = &seat;
                return {};
            }
            free = free == nullptr && (owner == 0 || !mailbox::isAlive(owner)) ? &seat : free;
        }
        if (free == nullptr) {
            return bad(fmt::format("{} processes use it, which is as many as may", store().seats().size()),
                       "see max_procs in its B line");
        }
        for (std::atomic<std::uint64_t> *count :
             {&free->writes, &free->reads, &free->bytes_written, &free->bytes_read}) {
            count->store(0);
        }
        free->last_access_ns.store(0);
        free->longest_wait_ns.store(0);
        free->connections.store(1);
        free->owner.store(me);
        seat_ = free;
        return {};
    }

    Result<std::vector<AccessFigures>> figures() override {
        constexpr int PID_SHIFT = 42;  // as in mailbox::owner_word()
        std::vector<AccessFigures> all;
        for (const Seat &seat : store().seats()) {
            if (isDiagnosed_ && seat.owner.load() != 0) {
                all.push_back({static_cast<std::int32_t>(seat.owner.load() >> PID_SHIFT), seat.writes.load(),
                               seat.reads.load(), seat.bytes_written.load(), seat.bytes_read.load(),
                               seat.last_access_ns.load(), seat.longest_wait_ns.load()});
            }
        }
        return all;
    }

  private:
    /// Releases the lock at the end of its block.
    class Held {
      public:
        explicit Held(SharedLock *lock) : lock_(lock) {}
        Held(Held &&other) noexcept : lock_(std::exchange(other.lock_, nullptr)) {}
        Held &operator=(Held &&) = delete;
        ~Held() {
            if (lock_ != nullptr) {
                lock_->release();
            }
        }

      private:
        SharedLock *lock_;
    };

    Store &store() const { return place_->store; }

    Result<Held> locked(const Deadline &deadline) const {
        switch (store().head().lock.take(deadline)) {
        case SharedLock::Outcome::TAKEN: return Held(&store().head().lock);
        case SharedLock::Outcome::TIME_OVER: return bad(std::string(TIME_OVER) + " while others used it");
        case SharedLock::Outcome::BROKEN: break;
        }
        return bad("its lock is broken", "end all processes that use it");
    }
    Result<Held> locked_if(bool needed, const Deadline &deadline) const {
        return needed ? locked(deadline) : Result<Held>(Held(nullptr));
    }

    Result<> need_kept() const {
        return place_->isKept() ? Result<>{}
                                : bad("it is gone: the process that made it has ended", "connect again");
    }

    void leave() {
        if (seat_ == nullptr) {
            return;
        }
        const auto lock = locked(Deadline({1.0}));
        if (lock.has_value() && seat_->connections.fetch_sub(1) == 1) {
            seat_->owner.store(0);
        }
    }

    void count(std::int64_t begin_ns, std::atomic<std::uint64_t> &accesses, std::atomic<std::uint64_t> &bytes,
               std::size_t size) {
        if (!isDiagnosed_) {
            return;
        }
        const std::int64_t now_ns = monotonic_ns();
        accesses.fetch_add(1, std::memory_order_relaxed);
        bytes.fetch_add(size, std::memory_order_relaxed);
        seat_->last_access_ns.store(now_ns, std::memory_order_relaxed);
        // A connection has one thread; with several connections in a process a longer wait may be missed.
        if (now_ns - begin_ns > seat_->longest_wait_ns.load(std::memory_order_relaxed)) {
            seat_->longest_wait_ns.store(now_ns - begin_ns, std::memory_order_relaxed);
        }
    }

    Result<WriteNumber> put(std::string_view bytes, Timeout timeout) override {
        const Deadline deadline(timeout);
        const std::int64_t begin_ns = isDiagnosed_ ? monotonic_ns() : 0;
        for (;;) {
            const std::uint32_t heard = store().head().room_bell.heard();
            WriteNumber number = 0;
            const auto outcome = write_once(bytes, deadline, number);
            if (!outcome.has_value()) {
                return std::unexpected(outcome.error());
            }
            if (*outcome == Store::Outcome::DONE) {
                store().head().message_bell.ring();
                count(begin_ns, seat_->writes, seat_->bytes_written, bytes.size());
                return number;
            }
            if (*outcome == Store::Outcome::TOO_LONG) {
                return bad(fmt::format("a message of {} bytes is larger than it", bytes.size()),
                           "size in its B line says how large it is");
            }
            if (*outcome == Store::Outcome::DAMAGED) {
                return damaged();
            }
            if (deadline.isOver()) {
                return bad("the queue is full");
            }
            const auto kept = need_kept();
            if (!kept.has_value()) {
                return std::unexpected(kept.error());
            }
            store().head().room_bell.sleep(heard, std::min(deadline.left_ns(), LONGEST_SLEEP_NS));
        }
    }

    Result<Store::Outcome> write_once(std::string_view bytes, const Deadline &deadline, WriteNumber &number) {
        const auto lock = locked_if(isLocked_, deadline);
        return lock.has_value() ? Result<Store::Outcome>(store().write(bytes, number))
                                : std::unexpected(lock.error());
    }

    std::unexpected<Error> damaged() const {
        return bad("something else has written to its memory", "end all processes that use it");
    }

    /// False: there is no message.
    Result<bool> get(Received &message, WriteNumber seen, bool taken, const Deadline &deadline) {
        const std::int64_t begin_ns = isDiagnosed_ ? monotonic_ns() : 0;
        for (int tries = 0;; ++tries) {
            const auto lock = locked_if(isReadLocked_ || (isLocked_ && tries >= PATIENCE), deadline);
            if (!lock.has_value()) {
                return std::unexpected(lock.error());
            }
            switch (store().read(message, seen, taken)) {
            case Store::Outcome::DONE:
                count(begin_ns, seat_->reads, seat_->bytes_read, message.bytes.size());
                return true;
            case Store::Outcome::NOTHING: return false;
            case Store::Outcome::AGAIN: break;
            case Store::Outcome::NO_ROOM:
            case Store::Outcome::TOO_LONG:
            case Store::Outcome::DAMAGED: return damaged();
            }
            if (tries >= PATIENCE && deadline.isOver()) {
                return bad(std::string(TIME_OVER) + " while others wrote");
            }
        }
    }

    Result<bool> take(Received &message, Timeout timeout) override {
        return take_by(message, Deadline(timeout));
    }

    Result<bool> take_by(Received &message, const Deadline &deadline) {
        const auto found = get(message, seen_, true, deadline);
        if (found.has_value() && *found) {
            seen_ = message.number;
            if (isQueue_) {
                store().head().room_bell.ring();
            }
        }
        return found;
    }

    Result<bool> look(Received &message, Timeout timeout) override {
        return get(message, 0, false, Deadline(timeout));
    }

    Result<bool> take_next(Received &message, Timeout timeout) override {
        if (!isBlockingAllowed_) {
            return bad("waits for its messages are disabled", "see bsem=-1 in its B line");
        }
        const Deadline deadline(timeout);
        for (;;) {
            const std::uint32_t heard = store().head().message_bell.heard();
            const auto found = take_by(message, deadline);
            if (!found.has_value() || *found || deadline.isOver()) {
                return found;
            }
            const auto kept = need_kept();
            if (!kept.has_value()) {
                return std::unexpected(kept.error());
            }
            store().head().message_bell.sleep(heard, std::min(deadline.left_ns(), LONGEST_SLEEP_NS));
        }
    }

    Result<> empty(Timeout timeout) override {
        const auto lock = locked_if(isLocked_, Deadline(timeout));
        if (!lock.has_value()) {
            return std::unexpected(lock.error());
        }
        store().clear();
        store().head().room_bell.ring();
        return {};
    }

    std::shared_ptr<Place> place_;
    bool isQueue_;
    bool isLocked_;
    bool isReadLocked_;
    bool isBlockingAllowed_;
    bool isDiagnosed_;
    Seat *seat_ = nullptr;
    WriteNumber seen_ = 0;
};

Result<std::shared_ptr<Place>> open_place(const BufferSettings &buffer, const ProcessSettings &process,
                                          const std::string &instance, LocalPlaces &local) {
    switch (buffer.kind) {
    case BufferKind::SHMEM: return open_shared_place(buffer, instance, process.isMaster);
    case BufferKind::LOCMEM: return local.open(buffer, process.isMaster);
    case BufferKind::FILEMEM: return open_file_place(buffer, process.isMaster);
    case BufferKind::PHANTOM:
    case BufferKind::GLOBMEM: break;
    }
    return fail(
        fmt::format(
            "buffer '{}': GLOBMEM is memory on a backplane that several computers share; Linux has none",
            buffer.name),
        buffer.place, "use SHMEM, and TCP= for other computers");
}

}  // namespace

Result<std::unique_ptr<Buffer>> open_buffer(const BufferSettings &buffer, const ProcessSettings &process,
                                            const std::string &instance, LocalPlaces &local) {
    const Rights rights{process.mayRead, process.mayWrite};
    if (buffer.kind == BufferKind::PHANTOM) {
        return std::make_unique<Phantom>(buffer.name, rights);
    }
    auto place = open_place(buffer, process, instance, local);
    if (!place.has_value()) {
        return std::unexpected(place.error());
    }
    Place &place_of_it = **place;
    auto made = std::make_unique<MemoryBuffer>(buffer, rights, std::move(*place));
    const auto joined = made->join();
    place_of_it.settle();
    if (!joined.has_value()) {
        return std::unexpected(joined.error());
    }
    return made;
}

}  // namespace mw::nml
