// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/memory_reserve.hh"

#include <malloc.h>
#include <sys/mman.h>

#include <cstring>
#include <memory>
#include <vector>

namespace mw {

void reserve_heap(std::size_t bytes) {
    constexpr int NEVER_TRIM = -1;
    ::mallopt(M_TRIM_THRESHOLD, NEVER_TRIM);
    constexpr std::size_t BLOCK = std::size_t{64}
                                  << 10;  // below M_MMAP_THRESHOLD, so it is allocated from the heap
    std::vector<std::unique_ptr<char[]>> blocks(bytes / BLOCK);
    for (auto &block : blocks) {
        block.reset(new char[BLOCK]);
        std::memset(block.get(), 1, BLOCK);
    }
}

bool lock_present_memory() {
    return ::mlockall(MCL_CURRENT) == 0;
}

}  // namespace mw
