// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/shared_memory.hh"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace mw::runtime {
namespace {

constexpr std::uint64_t MAGIC = 0x74686769724d2157;  // "W!Mright"
constexpr std::size_t HEADER_SIZE = 128;
constexpr const char *SHM_FOLDER = "/dev/shm/";

std::string why(const std::string &name) {
    return name.empty() ? std::string("private shared memory: ") : "shared memory " + name + ": ";
}

/// Names the file and its process, or its user, and the remedy. `owner_of` reads the file's header.
template <class OwnerOf>
std::unexpected<Error> in_use(const std::string &name, const OwnerOf &owner_of) {
    const std::string path = SHM_FOLDER + name;
    struct stat status{};
    const bool known = ::stat(path.c_str(), &status) == 0;
    if (known && status.st_uid != ::getuid()) {
        return fail(why(name) + path + " belongs to user " + std::to_string(status.st_uid), {},
                    "remove the file as that user, or set MILLWRIGHT_INSTANCE to another name");
    }
    std::string holder = "a running process";
    const int fd = ::shm_open(('/' + name).c_str(), O_RDONLY | O_CLOEXEC, 0);
    void *base = fd >= 0 && status.st_size >= static_cast<off_t>(HEADER_SIZE)
                     ? ::mmap(nullptr, HEADER_SIZE, PROT_READ, MAP_SHARED, fd, 0)
                     : MAP_FAILED;
    if (base != MAP_FAILED) {
        holder = "process " + std::to_string(owner_of(base));
        ::munmap(base, HEADER_SIZE);
    }
    if (fd >= 0) {
        ::close(fd);
    }
    return fail(why(name) + path + " is in use by " + holder, {},
                "end that process, or set MILLWRIGHT_INSTANCE to another name");
}

}  // namespace

struct SharedMemory::Header {
    std::atomic<std::uint64_t> magic;  // written last by the creator, so an incomplete segment is rejected
    std::uint32_t abi_version;
    std::uint32_t unused;
    std::uint64_t layout_hash;
    std::uint64_t reserve;            // maximum size of the content [bytes]
    std::atomic<std::uint64_t> size;  // current size of the content [bytes]
    ProcessId owner;
};

SharedMemory::~SharedMemory() {
    close();
}

SharedMemory::SharedMemory(SharedMemory &&other) noexcept
    : base_(std::exchange(other.base_, nullptr)), mapped_(std::exchange(other.mapped_, 0)),
      fd_(std::exchange(other.fd_, -1)), name_(std::exchange(other.name_, {})) {}

SharedMemory &SharedMemory::operator=(SharedMemory &&other) noexcept {
    if (this != &other) {
        close();
        base_ = std::exchange(other.base_, nullptr);
        mapped_ = std::exchange(other.mapped_, 0);
        fd_ = std::exchange(other.fd_, -1);
        name_ = std::exchange(other.name_, {});
    }
    return *this;
}

/// Only the process that created it removes it, not a forked child.
void SharedMemory::remove() noexcept {
    if (!name_.empty() && base_ != nullptr && header()->owner == this_process()) {
        ::shm_unlink(name_.c_str());
    }
}

void SharedMemory::close() noexcept {
    remove();
    if (base_ != nullptr) {
        ::munmap(base_, mapped_);
        base_ = nullptr;
    }
    if (fd_ >= 0) {
        ::close(fd_);
        fd_ = -1;
    }
    name_.clear();
}

SharedMemory::Header *SharedMemory::header() const noexcept {
    static_assert(sizeof(Header) <= HEADER_SIZE);
    return static_cast<Header *>(base_);
}

/// Takes ownership of `fd`, an empty file.
Result<SharedMemory> SharedMemory::initialise(int fd, const std::string &name, std::size_t size,
                                              std::size_t reserve, const SharedLayout &layout) {
    SharedMemory memory;
    memory.fd_ = fd;
    memory.name_ = name;
    const std::size_t first = HEADER_SIZE + size;
    // Allocates the pages now, so that a full /dev/shm is an error here and not a fault later.
    const int error = ::posix_fallocate(fd, 0, static_cast<off_t>(first));
    if (error != 0) {
        return fail(why(name) + "cannot get " + std::to_string(first) + " bytes: " + std::strerror(error));
    }
    memory.mapped_ = HEADER_SIZE + std::max(size, reserve);
    void *base = ::mmap(nullptr, memory.mapped_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, fd, 0);
    if (base == MAP_FAILED) {
        return fail(why(name) + "cannot map it: " + std::strerror(errno));
    }
    memory.base_ = base;
    Header *header = memory.header();
    header->abi_version = layout.abi_version;
    header->layout_hash = layout.layout_hash;
    header->reserve = std::max(size, reserve);
    header->size.store(size, std::memory_order_relaxed);
    header->owner = this_process();
    // Release: pairs with attach's acquire; a process that sees the magic sees the header.
    header->magic.store(MAGIC, std::memory_order_release);
    return memory;
}

Result<SharedMemory> SharedMemory::create(const std::string &name, std::size_t size, std::size_t reserve,
                                          const SharedLayout &layout) {
    const std::string path = '/' + name;
    if (remove_stale(name) < 0) {
        return fail(why(name) + "cannot search " + SHM_FOLDER);
    }
    const int fd = ::shm_open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    const auto pid_of = [](const void *base) { return static_cast<const Header *>(base)->owner.pid; };
    if (fd < 0) {
        return errno == EEXIST ? in_use(name, pid_of) : fail(why(name) + std::strerror(errno));
    }
    auto memory = initialise(fd, path, size, reserve, layout);
    if (!memory) {
        ::shm_unlink(path.c_str());
    }
    return memory;
}

Result<SharedMemory> SharedMemory::create_private(std::size_t size, std::size_t reserve,
                                                  const SharedLayout &layout) {
    const int fd = ::memfd_create("millwright", MFD_CLOEXEC);
    if (fd < 0) {
        return fail(why("") + std::strerror(errno));
    }
    return initialise(fd, "", size, reserve, layout);
}

Result<SharedMemory> SharedMemory::attach(const std::string &name, const SharedLayout &layout) {
    SharedMemory memory;
    memory.fd_ = ::shm_open(('/' + name).c_str(), O_RDWR | O_CLOEXEC, 0);
    if (memory.fd_ < 0) {
        return fail(why(name) + (errno == ENOENT ? "there is none" : std::strerror(errno)));
    }
    struct stat status{};
    if (::fstat(memory.fd_, &status) != 0 || status.st_uid != ::getuid()) {
        return fail(why(name) + "belongs to another user");
    }
    if (status.st_size < static_cast<off_t>(HEADER_SIZE)) {
        return fail(why(name) + "is not complete");
    }
    void *base = ::mmap(nullptr, HEADER_SIZE, PROT_READ, MAP_SHARED, memory.fd_, 0);
    if (base == MAP_FAILED) {
        return fail(why(name) + "cannot map it: " + std::strerror(errno));
    }
    memory.base_ = base;
    memory.mapped_ = HEADER_SIZE;
    const Header *header = memory.header();
    // Acquire: pairs with the creator's release of the magic.
    if (header->magic.load(std::memory_order_acquire) != MAGIC) {
        return fail(why(name) + "does not belong to Millwright, or is not complete");
    }
    if (header->abi_version != layout.abi_version || header->layout_hash != layout.layout_hash) {
        return fail(why(name) + "has version " + std::to_string(header->abi_version) + ", this program " +
                        std::to_string(layout.abi_version) + ", or another layout",
                    {}, "all programs must come from the same build");
    }
    const std::size_t whole = HEADER_SIZE + header->reserve;
    // The file grows before its header does; it may have grown since the first check.
    const std::uint64_t size = header->size.load(std::memory_order_acquire);
    if (::fstat(memory.fd_, &status) != 0 ||
        static_cast<std::uint64_t>(status.st_size) < HEADER_SIZE + size) {
        return fail(why(name) + "is shorter than its header states");
    }
    ::munmap(memory.base_, memory.mapped_);
    memory.base_ = nullptr;
    base = ::mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, memory.fd_, 0);
    if (base == MAP_FAILED) {
        return fail(why(name) + "cannot map it: " + std::strerror(errno));
    }
    memory.base_ = base;
    memory.mapped_ = whole;
    return memory;
}

void *SharedMemory::data() const noexcept {
    return base_ == nullptr ? nullptr : static_cast<char *>(base_) + HEADER_SIZE;
}

std::size_t SharedMemory::size() const noexcept {
    return base_ == nullptr ? 0 : header()->size.load(std::memory_order_acquire);
}

std::size_t SharedMemory::reserve() const noexcept {
    return base_ == nullptr ? 0 : header()->reserve;
}

Result<> SharedMemory::grow(std::size_t wanted) {
    if (wanted <= size()) {
        return {};
    }
    if (wanted > reserve()) {
        return fail(why(name_) + std::to_string(wanted) + " bytes exceed the maximum of " +
                    std::to_string(reserve()));
    }
    const int error = ::posix_fallocate(fd_, 0, static_cast<off_t>(HEADER_SIZE + wanted));
    if (error != 0) {
        return fail(why(name_) + "cannot grow to " + std::to_string(wanted) +
                    " bytes: " + std::strerror(error));
    }
    header()->size.store(wanted, std::memory_order_release);
    return {};
}

bool SharedMemory::contains(const void *pointer) const noexcept {
    const auto *at = static_cast<const char *>(pointer);
    const auto *first = static_cast<const char *>(data());
    return first != nullptr && at >= first && at < first + size();
}

ProcessId SharedMemory::owner() const noexcept {
    return base_ == nullptr ? ProcessId{} : header()->owner;
}

int SharedMemory::remove_stale(const std::string &prefix) {
    DIR *folder = ::opendir(SHM_FOLDER);
    if (folder == nullptr) {
        return -1;
    }
    int removed = 0;
    while (const dirent *entry = ::readdir(folder)) {
        const std::string name = entry->d_name;
        if (!name.starts_with(prefix)) {
            continue;
        }
        const int fd = ::shm_open(('/' + name).c_str(), O_RDONLY | O_CLOEXEC, 0);
        struct stat status{};
        const bool own = fd >= 0 && ::fstat(fd, &status) == 0 && status.st_uid == ::getuid();
        bool stale = own;
        if (own && status.st_size >= static_cast<off_t>(HEADER_SIZE)) {
            void *base = ::mmap(nullptr, HEADER_SIZE, PROT_READ, MAP_SHARED, fd, 0);
            if (base != MAP_FAILED) {
                const auto *header = static_cast<const Header *>(base);
                const bool whole = header->magic.load(std::memory_order_acquire) == MAGIC;
                stale = !whole || !isAlive(header->owner);
                ::munmap(base, HEADER_SIZE);
            }
        }
        if (fd >= 0) {
            ::close(fd);
        }
        if (stale && ::shm_unlink(('/' + name).c_str()) == 0) {
            ++removed;
        }
    }
    ::closedir(folder);
    return removed;
}

}  // namespace mw::runtime
