// SPDX-License-Identifier: GPL-2.0-or-later
// Memory that a process has before it needs it: without it, each new page of a process is waited for while
// the kernel looks for memory or ends another process.
#pragma once

#include <cstddef>

namespace mw {

/// The calling thread's heap gets `bytes` more, in memory now, which the process keeps until its end.
void reserve_heap(std::size_t bytes);

/// Locks all memory that this process has now: programs, libraries, heap, shared memory. Later memory is not
/// locked. False where the limit 'memlock' does not allow it; nothing is locked then.
bool lock_present_memory();

}  // namespace mw
