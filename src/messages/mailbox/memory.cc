// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/mailbox/memory.hh"

#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <new>

#include "messages/declarations/catalogue.hh"
#include "runtime/process.hh"

namespace mw::mailbox {
namespace {

constexpr std::uint32_t ABI_VERSION = 3;
constexpr std::int64_t NS_PER_S = 1000000000;
constexpr int START_BITS = 42;  // a process id has at most 22 bits
constexpr std::uint64_t START_MASK = (std::uint64_t{1} << START_BITS) - 1;

runtime::SharedLayout layout() {
    return {ABI_VERSION, messages::layout_hash() ^ (sizeof(Segment) * 0x9e3779b97f4a7c15ULL)};
}

std::string name_of(const std::string &instance) {
    return "millwright-" + std::to_string(::getuid()) + "-mailbox-" + instance;
}

}  // namespace

Memory Memory::in_process() {
    // Zeroed pages are an empty segment; pages that no process reads use no memory.
    void *pages =
        ::mmap(nullptr, sizeof(Segment), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) {
        throw std::bad_alloc();
    }
    Memory memory;
    memory.own_.reset(std::launder(static_cast<Segment *>(pages)));
    memory.segment_ = memory.own_.get();
    return memory;
}

void Memory::Unmap::operator()(Segment *segment) const noexcept {
    ::munmap(segment, sizeof(Segment));
}

Result<Memory> Memory::create(const std::string &instance) {
    auto lock = runtime::InstanceLock::take(instance);
    if (!lock.has_value()) {
        return std::unexpected(lock.error());
    }
    auto shared =
        runtime::SharedMemory::create(name_of(instance), sizeof(Segment), sizeof(Segment), layout());
    if (!shared.has_value()) {
        return std::unexpected(shared.error());
    }
    Memory memory;
    memory.lock_ = std::move(*lock);
    memory.shared_ = std::move(*shared);
    // Zeroed pages are an empty segment, so a client may attach at once.
    memory.segment_ = std::launder(static_cast<Segment *>(memory.shared_.data()));
    return memory;
}

Result<Memory> Memory::attach(const std::string &instance) {
    auto shared = runtime::SharedMemory::attach(name_of(instance), layout());
    if (!shared.has_value()) {
        Error error = shared.error();
        error.hint = error.hint.empty() ? "is the machine '" + instance + "' running?" : error.hint;
        return std::unexpected(error);
    }
    Memory memory;
    memory.shared_ = std::move(*shared);
    memory.segment_ = std::launder(static_cast<Segment *>(memory.shared_.data()));
    if (!memory.isOwnerAlive()) {
        return fail("the machine '" + instance + "' is no longer running");
    }
    return memory;
}

bool Memory::isOwnerAlive() const {
    return own_ != nullptr || runtime::isAlive(shared_.owner());
}

int Memory::owner_pid() const {
    return own_ != nullptr ? ::getpid() : shared_.owner().pid;
}

void Memory::ring(Segment &segment) {
    // Release: a reader that sees the new value sees the earlier writes.
    segment.bell.fetch_add(1, std::memory_order_release);
    if (segment.waiting.load(std::memory_order_seq_cst) > 0) {
        ::syscall(SYS_futex, &segment.bell, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
    }
}

bool Memory::wait(Segment &segment, std::uint32_t heard, std::int64_t timeout_ns) {
    segment.waiting.fetch_add(1, std::memory_order_seq_cst);
    const timespec time{timeout_ns / NS_PER_S, timeout_ns % NS_PER_S};
    // The kernel compares the value again, so a ring between this check and the sleep is not missed.
    if (segment.bell.load(std::memory_order_acquire) == heard) {
        ::syscall(SYS_futex, &segment.bell, FUTEX_WAIT, heard, &time, nullptr, 0);
    }
    segment.waiting.fetch_sub(1, std::memory_order_seq_cst);
    return segment.bell.load(std::memory_order_acquire) != heard;
}

std::uint64_t owner_word() {
    const runtime::ProcessId me = runtime::this_process();
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(me.pid)) << START_BITS |
           (me.start_time & START_MASK);
}

int pid_of(std::uint64_t owner) {
    return static_cast<std::int32_t>(owner >> START_BITS);
}

runtime::Activity activity_of(std::uint64_t owner) {
    return runtime::activity_of({pid_of(owner), owner & START_MASK});
}

bool isAlive(std::uint64_t owner) {
    return activity_of(owner) != runtime::Activity::ENDED;
}

}  // namespace mw::mailbox
