// SPDX-License-Identifier: GPL-2.0-or-later
// A scope in which this thread must not use the heap; every realtime entry point has such a test. Link
// mw_testing_guard, which replaces malloc and free of the test program.
#pragma once

#include <cstdint>

namespace mw::testing {

/// Counts this thread's calls of malloc, free and related functions (including new and delete) during its
/// lifetime.
/// AllocationGuard guard;
/// machine.step();
/// EXPECT_EQ(guard.calls(), 0U);
class AllocationGuard {
  public:
    AllocationGuard() noexcept;
    ~AllocationGuard();
    AllocationGuard(const AllocationGuard &) = delete;
    AllocationGuard &operator=(const AllocationGuard &) = delete;

    std::uint64_t calls() const noexcept;

  private:
    std::uint64_t before_;
};

}  // namespace mw::testing
