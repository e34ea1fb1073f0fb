// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

#include "base/memory_reserve.hh"

namespace mw {
namespace {

long page_faults() {
    rusage use{};
    ::getrusage(RUSAGE_SELF, &use);
    return use.ru_minflt + use.ru_majflt;
}

/// Runs in a separate process, so that the heap of this one does not change.
int faults_of_8_megabytes(bool reserved) {
    const pid_t child = ::fork();
    if (child == 0) {
        if (reserved) {
            reserve_heap(std::size_t{16} << 20);
        }
        const long before = page_faults();
        for (int i = 0; i < 128; ++i) {
            std::memset(std::malloc(std::size_t{64} << 10), 2, std::size_t{64} << 10);
        }
        const long pages = page_faults() - before;
        ::_exit(pages > 1000 ? 2 : pages > 100 ? 1 : 0);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
}

TEST(MemoryReserve, WhatIsAllocatedLaterNeedsNoNewPages) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    GTEST_SKIP() << "sanitizers have another allocator";
#endif
#endif
    EXPECT_EQ(faults_of_8_megabytes(false), 2) << "without a reserve each of 2048 pages is new";
    EXPECT_EQ(faults_of_8_megabytes(true), 0);
}

}  // namespace
}  // namespace mw
