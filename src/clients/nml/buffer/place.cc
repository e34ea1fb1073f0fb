// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/buffer/place.hh"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "messages/mailbox/memory.hh"
#include "runtime/shared_memory.hh"

namespace mw::nml {
namespace {

constexpr std::uint32_t ABI_VERSION = 1;

std::unexpected<Error> bad(const BufferSettings &buffer, const std::string &what,
                           const std::string &hint = "") {
    return fail(fmt::format("buffer '{}': {}", buffer.name, what), buffer.place, hint);
}

std::unexpected<Error> no_lock(const BufferSettings &buffer) {
    return bad(buffer, "the kernel gives no lock for it");
}

constexpr const char *NEEDS_MASTER = "a process whose P line says master=1 must be started before";

/// 64-byte aligned, as mapped memory.
struct alignas(64) Line {
    std::array<std::byte, 64> bytes{};
};

class LocalPlace final : public Place {
  public:
    LocalPlace(const StoreShape &shape, std::vector<Line> lines)
        : Place(shape, lines.data()), lines_(std::move(lines)) {}

  private:
    std::vector<Line> lines_;
};

class SharedPlace final : public Place {
  public:
    SharedPlace(const StoreShape &shape, runtime::SharedMemory memory)
        : Place(shape, memory.data()), memory_(std::move(memory)) {}
    bool isKept() const override { return runtime::isAlive(memory_.owner()); }

  private:
    runtime::SharedMemory memory_;
};

/// Header before the store in a file, to check its layout.
struct alignas(64) FileHead {
    std::array<char, 8> mark{'M', 'W', 'N', 'M', 'L', 'b', 'u', 'f'};
    std::uint64_t version = ABI_VERSION;
    std::uint64_t shape = 0;
};

class MappedFile {
  public:
    MappedFile(void *base, std::size_t size) : base_(base), size_(size) {}
    MappedFile(MappedFile &&other) noexcept
        : base_(std::exchange(other.base_, nullptr)), size_(other.size_) {}
    MappedFile &operator=(MappedFile &&) = delete;
    ~MappedFile() {
        if (base_ != nullptr) {
            ::munmap(base_, size_);
        }
    }
    FileHead &head() const { return *static_cast<FileHead *>(base_); }
    void *content() const { return static_cast<char *>(base_) + sizeof(FileHead); }

  private:
    void *base_;
    std::size_t size_;
};

/// Closes a descriptor at its end, which also releases the file's lock.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor &operator=(Descriptor &&) = delete;
    ~Descriptor() { close(); }
    int get() const { return fd_; }
    void close() {
        if (fd_ >= 0) {
            ::flock(fd_, LOCK_UN);  // a mapping keeps the file and its lock open
            ::close(std::exchange(fd_, -1));
        }
    }

  private:
    int fd_;
};

class FilePlace final : public Place {
  public:
    FilePlace(const StoreShape &shape, MappedFile file, Descriptor lock)
        : Place(shape, file.content()), file_(std::move(file)), lock_(std::move(lock)) {}
    void settle() override { lock_.close(); }

  private:
    MappedFile file_;
    Descriptor lock_;
};

bool isUsed(const Store &store) {
    return std::any_of(store.seats().begin(), store.seats().end(),
                       [](const Seat &seat) { return mailbox::isAlive(seat.owner.load()); });
}

}  // namespace

Result<std::shared_ptr<Place>> LocalPlaces::open(const BufferSettings &buffer, bool is_master) {
    const std::lock_guard guard(mutex_);
    std::weak_ptr<Place> &known = places_[buffer.name];
    if (auto place = known.lock()) {
        return place;
    }
    if (!is_master) {
        return bad(buffer, "this process has none yet", NEEDS_MASTER);
    }
    const StoreShape shape = StoreShape::of(buffer);
    auto place = std::make_shared<LocalPlace>(shape, std::vector<Line>(shape.bytes() / sizeof(Line) + 1));
    if (!place->store.initialise()) {
        return no_lock(buffer);
    }
    known = place;
    return place;
}

Result<std::shared_ptr<Place>> open_shared_place(const BufferSettings &buffer, const std::string &instance,
                                                 bool is_master) {
    const StoreShape shape = StoreShape::of(buffer);
    const std::string name = fmt::format("millwright-{}-nml-{}-{}", ::getuid(), instance, buffer.key);
    const runtime::SharedLayout layout{ABI_VERSION, shape.hash()};
    auto memory = is_master ? runtime::SharedMemory::create(name, shape.bytes(), shape.bytes(), layout)
                            : runtime::SharedMemory::attach(name, layout);
    if (!memory.has_value()) {
        const std::string hint =
            memory.error().hint.empty() && !is_master ? NEEDS_MASTER : memory.error().hint;
        return bad(buffer, memory.error().message, hint);
    }
    auto place = std::make_shared<SharedPlace>(shape, std::move(*memory));
    if (is_master && !place->store.initialise()) {
        return no_lock(buffer);
    }
    // Acquire: pairs with the release of the process that created it.
    if (place->store.head().isReady.load(std::memory_order_acquire) == 0 || !place->isKept()) {
        return bad(buffer, "the process that creates it has not finished, or has ended", "try again");
    }
    return place;
}

Result<std::shared_ptr<Place>> open_file_place(const BufferSettings &buffer, bool is_master) {
    if (buffer.file.empty()) {
        return bad(buffer, "FILEMEM needs the name of its file", "add the option file=PATH to its B line");
    }
    const StoreShape shape = StoreShape::of(buffer);
    const std::size_t size = sizeof(FileHead) + shape.bytes();
    Descriptor file(
        ::open(buffer.file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | (is_master ? O_CREAT : 0), 0600));
    struct stat status{};
    // Only one process at a time checks whether the file is complete and in use, until it is itself visible
    // as a user.
    if (file.get() < 0 || ::flock(file.get(), LOCK_EX) != 0 || ::fstat(file.get(), &status) != 0) {
        return bad(buffer, fmt::format("{}: {}", buffer.file, std::strerror(errno)),
                   is_master ? "" : NEEDS_MASTER);
    }
    const bool is_new = status.st_size == 0 && is_master;
    if (!is_new && status.st_size != static_cast<off_t>(size)) {
        return bad(buffer, fmt::format("{} is not a file of this buffer", buffer.file), "remove it");
    }
    const int error = is_new ? ::posix_fallocate(file.get(), 0, static_cast<off_t>(size)) : 0;
    if (error != 0) {
        return bad(buffer, fmt::format("{}: {}", buffer.file, std::strerror(error)));
    }
    void *base = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
    if (base == MAP_FAILED) {
        return bad(buffer, fmt::format("{}: {}", buffer.file, std::strerror(errno)));
    }
    MappedFile mapped(base, size);
    FileHead wanted;
    wanted.shape = shape.hash();
    FileHead &head = mapped.head();
    if (is_new) {
        head = wanted;
    } else if (head.mark != wanted.mark || head.version != wanted.version || head.shape != wanted.shape) {
        return bad(buffer, fmt::format("{} is not a file of this buffer", buffer.file), "remove it");
    }
    auto place = std::make_shared<FilePlace>(shape, std::move(mapped), std::move(file));
    // A lock is not valid after a restart of the computer, so the first process creates it again.
    if (!isUsed(place->store) && !place->store.initialise()) {
        return no_lock(buffer);
    }
    return place;
}

}  // namespace mw::nml
