// SPDX-License-Identifier: GPL-2.0-or-later
// Memory that a process allocates in advance. Without a reserve a process waits for each new page while the
// kernel searches for memory or ends another process.
#pragma once

#include <cstddef>

namespace mw {

/// Adds `bytes` of resident memory to the heap of the calling thread, which the process keeps until it ends.
void reserve_heap(std::size_t bytes);

/// Locks all memory that this process has now: programs, libraries, heap, shared memory. Memory allocated
/// later is not locked. False if the limit 'memlock' does not permit it; then nothing is locked.
bool lock_present_memory();

}  // namespace mw
