// SPDX-License-Identifier: GPL-2.0-or-later
// Memory in pages of 2 MB, if the kernel has them. The data of a servo cycle lies in about fifty small pages
// of 4 KB; on a virtual machine address translation for these takes much of the time that the cycle waits for
// memory.

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

#include "hal/include/millwright_ext.h"

namespace {

constexpr std::size_t HUGE_PAGE = std::size_t{2} << 20U;

constexpr std::size_t rounded_up(std::size_t bytes) noexcept {
    return (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
}

}  // namespace

extern "C" {

void *mw_ext_memory_new(unsigned long bytes) {
    const std::size_t size = rounded_up(bytes);
    // Not accessed yet: in locked memory, small pages would be allocated before huge pages are requested.
    void *all = ::mmap(nullptr, size + HUGE_PAGE, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) {
        return nullptr;
    }
    auto *begin = static_cast<unsigned char *>(all);
    const std::size_t before =
        rounded_up(reinterpret_cast<std::uintptr_t>(all)) - reinterpret_cast<std::uintptr_t>(all);
    if (before > 0) {
        ::munmap(begin, before);
    }
    begin += before;
    if (before < HUGE_PAGE) {
        ::munmap(begin + size, HUGE_PAGE - before);
    }
    ::madvise(begin, size, MADV_HUGEPAGE);  // fails without effect on a kernel without huge pages
    if (::mprotect(begin, size, PROT_READ | PROT_WRITE) != 0) {
        ::munmap(begin, size);
        return nullptr;
    }
    return begin;
}

void mw_ext_memory_delete(void *memory, unsigned long bytes) {
    if (memory != nullptr) {
        ::munmap(memory, rounded_up(bytes));
    }
}

}  // extern "C"
