// SPDX-License-Identifier: GPL-2.0-or-later
// rtapi_io.h, rtapi_parport.h, and the functions of rtapi.h for hardware and root rights.
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>
#if defined(__x86_64__) || defined(__i386__)
#include <sys/io.h>
#define MW_HAS_PORTS 1
#else
#define MW_HAS_PORTS 0
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "hal/capi/status.hh"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_parport.h"

using namespace mw::hal;
using namespace mw::hal::capi;

namespace {

constexpr unsigned long PORTS = 65536;
constexpr std::size_t REGIONS = 64;

struct Region {
    unsigned long base = 0, size = 0;
    std::array<char, 32> owner{};
};

/// I/O ports of this process. Permissions belong to threads, so each thread updates its own before its first
/// access after a change.
struct PortMap {
    std::mutex mutex;
    std::array<Region, REGIONS> regions{};
    // A bit per permitted port. Relaxed, because `epoch` gives the order.
    std::array<std::atomic<std::uint64_t>, PORTS / 64> allowed{};
    // Released after a change of `allowed`; acquired by threads that compare it with their own value.
    std::atomic<std::uint32_t> epoch{1};
    std::atomic<bool> complained{false};

    bool isAllowed(unsigned long port) const noexcept {
        return port < PORTS &&
               ((allowed[port / 64].load(std::memory_order_relaxed) >> (port % 64)) & 1U) != 0;
    }
};

PortMap &port_map() {
    static auto *the_map = new PortMap;
    return *the_map;
}

int allow_here(unsigned long from, unsigned long count, bool on) noexcept {
#if MW_HAS_PORTS
    return ::ioperm(from, count, on ? 1 : 0);
#else
    (void)from;
    (void)count;
    (void)on;
    errno = ENOSYS;
    return -1;
#endif
}

/// Sets the permissions of the process for this thread, at most once per change.
void take_permissions() noexcept {
    thread_local std::uint32_t seen = 0;
    PortMap &map = port_map();
    const std::uint32_t now = map.epoch.load(std::memory_order_acquire);
    if (seen == now) {
        return;
    }
    seen = now;
    for (unsigned long word = 0; word < PORTS / 64; ++word) {
        const std::uint64_t bits = map.allowed[word].load(std::memory_order_relaxed);
        for (unsigned long bit = 0; bits != 0 && bit < 64; ++bit) {
            if (((bits >> bit) & 1U) != 0) {
                (void)allow_here(word * 64 + bit, 1, true);
            }
        }
    }
}

/// Under the virtual clock the computer's ports are not accessed: another process may control a machine
/// through them.
bool isVirtual() noexcept {
    return mw_ext_is_virtual() != 0;
}

/// True when access to `bytes` from `port` on is permitted; logs the first violation.
bool isAccessible(unsigned long port, unsigned long bytes) noexcept {
    if (isVirtual()) {
        return false;
    }
    PortMap &map = port_map();
    for (unsigned long i = 0; i < bytes; ++i) {
        if (!map.isAllowed(port + i)) {
            if (!map.complained.exchange(true, std::memory_order_relaxed)) {
                rtapi_print_msg(RTAPI_MSG_ERR,
                                "I/O port 0x%lx is not claimed: reads give all ones, writes nothing\n",
                                port + i);
            }
            return false;
        }
    }
    take_permissions();
    return true;
}

/// Logs the rejected range and the reason; returns the negated errno.
int refuse_ports(unsigned long from, unsigned long count, int code) {
    return complain(
        code, fmt::format("I/O ports 0x{:x} to 0x{:x} are rejected: {}{}", from, from + count - 1,
                          std::strerror(code),
                          code == EPERM ? "; the realtime process needs the capability CAP_SYS_RAWIO" : ""));
}

/// Gives the calling thread root rights during its lifetime, if the process may have them.
class AsRoot {
  public:
    AsRoot() noexcept {
        uid_t real = 0;
        uid_t saved = 0;
        ::getresuid(&real, &before_, &saved);
        raised_ = before_ != 0 && saved == 0 && ::syscall(SYS_setresuid, -1, 0, -1) == 0;
    }
    ~AsRoot() {
        if (raised_) {
            const int kept = errno;
            (void)::syscall(SYS_setresuid, -1, before_, -1);
            errno = kept;
        }
    }
    AsRoot(const AsRoot &) = delete;
    AsRoot &operator=(const AsRoot &) = delete;

  private:
    uid_t before_ = 0;
    bool raised_ = false;
};

int no_interrupts() {
    return complain(ENOSYS, "interrupts do not reach a user process");
}

}  // namespace

extern "C" {

int rtapi_ioperm(unsigned long from, unsigned long num, int turn_on) {
    if (num == 0 || from >= PORTS || num > PORTS - from) {
        errno = EINVAL;
        return -1;
    }
    if (isVirtual()) {
        return 0;
    }
    if (turn_on != 0 && allow_here(from, num, true) != 0) {
        return -1;
    }
    PortMap &map = port_map();
    for (unsigned long port = from; port < from + num; ++port) {
        const std::uint64_t bit = std::uint64_t{1} << (port % 64);
        if (turn_on != 0) {
            map.allowed[port / 64].fetch_or(bit, std::memory_order_relaxed);
        } else {
            map.allowed[port / 64].fetch_and(~bit, std::memory_order_relaxed);
        }
    }
    map.epoch.fetch_add(1, std::memory_order_release);
    return 0;
}

#if MW_HAS_PORTS
unsigned char rtapi_inb(unsigned short port) {
    return isAccessible(port, 1) ? ::inb(port) : static_cast<unsigned char>(~0U);
}
unsigned short rtapi_inw(unsigned short port) {
    return isAccessible(port, 2) ? ::inw(port) : static_cast<unsigned short>(~0U);
}
unsigned int rtapi_inl(unsigned short port) {
    return isAccessible(port, 4) ? ::inl(port) : ~0U;
}
void rtapi_outb(unsigned char val, unsigned short port) {
    if (isAccessible(port, 1)) {
        ::outb(val, port);
    }
}
void rtapi_outw(unsigned short val, unsigned short port) {
    if (isAccessible(port, 2)) {
        ::outw(val, port);
    }
}
void rtapi_outl(unsigned int val, unsigned short port) {
    if (isAccessible(port, 4)) {
        ::outl(val, port);
    }
}
#else
unsigned char rtapi_inb(unsigned short port) {
    (void)isAccessible(port, 1);
    return static_cast<unsigned char>(~0U);
}
unsigned short rtapi_inw(unsigned short port) {
    (void)isAccessible(port, 2);
    return static_cast<unsigned short>(~0U);
}
unsigned int rtapi_inl(unsigned short port) {
    (void)isAccessible(port, 4);
    return ~0U;
}
void rtapi_outb(unsigned char, unsigned short port) {
    (void)isAccessible(port, 1);
}
void rtapi_outw(unsigned short, unsigned short port) {
    (void)isAccessible(port, 2);
}
void rtapi_outl(unsigned int, unsigned short port) {
    (void)isAccessible(port, 4);
}
#endif

void *rtapi_request_region(unsigned long base, unsigned long size, const char *name) {
    PortMap &map = port_map();
    const std::lock_guard lock(map.mutex);
    Region *vacant = nullptr;
    for (Region &region : map.regions) {
        if (region.size == 0) {
            vacant = vacant == nullptr ? &region : vacant;
        } else if (base < region.base + region.size && region.base < base + size) {
            complain(EBUSY, fmt::format("I/O ports 0x{:x} to 0x{:x} belong to {}", region.base,
                                        region.base + region.size - 1, region.owner.data()));
            errno = EBUSY;
            return nullptr;
        }
    }
    if (vacant == nullptr || size == 0) {
        const int code = size == 0 ? EINVAL : ENOSPC;
        complain(code, "no memory for a region of I/O ports");
        errno = code;
        return nullptr;
    }
    if (rtapi_ioperm(base, size, 1) != 0) {
        const int code = errno;
        refuse_ports(base, size, code);
        errno = code;
        return nullptr;
    }
    vacant->base = base;
    vacant->size = size;
    std::snprintf(vacant->owner.data(), vacant->owner.size(), "%s", name == nullptr ? "?" : name);
    return vacant;
}

void rtapi_release_region(unsigned long base, unsigned long int size) {
    PortMap &map = port_map();
    const std::lock_guard lock(map.mutex);
    for (Region &region : map.regions) {
        if (region.size == size && region.base == base && size != 0) {
            region = {};
            (void)rtapi_ioperm(base, size, 0);
        }
    }
}

// ---- parallel ports

int rtapi_parport_get(const char *mod_name, rtapi_parport_t *port, unsigned short base,
                      unsigned short base_hi, unsigned int modes) {
    constexpr unsigned short NO_HIGH = 0xffff;
    *port = {};
    unsigned address = base;
    unsigned address_hi = base_hi == NO_HIGH ? 0 : base_hi;
    if (base < 16) {
        const std::string file = fmt::format("/proc/sys/dev/parport/parport{}/base-addr", base);
        std::FILE *stream = std::fopen(file.c_str(), "re");
        unsigned found_hi = 0;
        const bool found = stream != nullptr && std::fscanf(stream, "%u %u", &address, &found_hi) >= 1;
        if (stream != nullptr) {
            std::fclose(stream);
        }
        if (!found || address == 0) {
            return complain(ENODEV,
                            fmt::format("Linux knows no parallel port {}: {} is not there", base, file));
        }
        address_hi = base_hi == 0 ? found_hi : address_hi;
    }
    if (modes != 0 && base >= 16) {
        rtapi_print_msg(RTAPI_MSG_WARN, "%s: Linux is not asked whether port 0x%x has the modes 0x%x\n",
                        mod_name == nullptr ? "parport" : mod_name, address, modes);
    }
    port->base = static_cast<unsigned short>(address);
    port->region = rtapi_request_region(address, 8, mod_name);
    if (port->region == nullptr) {
        return -errno;
    }
    if (address_hi == 0 && base_hi == 0) {
        address_hi = address + 0x400;  // usual address of the ECP registers
    }
    if (address_hi != 0) {
        port->region_hi = rtapi_request_region(address_hi, 3, mod_name);
        port->base_hi = port->region_hi == nullptr ? 0 : static_cast<unsigned short>(address_hi);
    }
    return 0;
}

void rtapi_parport_release(rtapi_parport_t *port) {
    if (port->region != nullptr) {
        rtapi_release_region(port->base, 8);
    }
    if (port->region_hi != nullptr) {
        rtapi_release_region(port->base_hi, 3);
    }
    *port = {};
}

// ---- interrupts, root

int rtapi_irq_new(unsigned int, int, void (*)(void)) {
    return no_interrupts();
}
int rtapi_irq_delete(unsigned int) {
    return no_interrupts();
}
int rtapi_enable_interrupt(unsigned int) {
    return no_interrupts();
}
int rtapi_disable_interrupt(unsigned int) {
    return no_interrupts();
}

int rtapi_open_as_root(const char *filename, int mode) {
    const AsRoot root;
    const int file = ::open(filename, mode | O_CLOEXEC, 0600);
    return file < 0 ? -errno : file;
}

int rtapi_spawn_as_root(pid_t *pid, const char *path, const posix_spawn_file_actions_t *file_actions,
                        const posix_spawnattr_t *attrp, char *const argv[], char *const envp[]) {
    const AsRoot root;
    return -::posix_spawn(pid, path, file_actions, attrp, argv, envp);
}

int rtapi_spawnp_as_root(pid_t *pid, const char *path, const posix_spawn_file_actions_t *file_actions,
                         const posix_spawnattr_t *attrp, char *const argv[], char *const envp[]) {
    const AsRoot root;
    return -::posix_spawnp(pid, path, file_actions, attrp, argv, envp);
}

}  // extern "C"
