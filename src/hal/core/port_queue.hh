// SPDX-License-Identifier: GPL-2.0-or-later
// The queue of a port signal, in the memory of the instance. The value of a port pin is the queue's
// reference.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::hal {

/// Followed by `size` bytes. Positions are 0 to size - 1; one byte stays free.
struct PortQueue {
    std::uint32_t size;
    // Released by its writer after the bytes are in place, acquired by the reader before it copies them.
    // realtime
    std::atomic<std::uint32_t> in;
    // Released by the reader after its copy, acquired by the writer before it fills the bytes again.
    std::atomic<std::uint32_t> out;
};

}  // namespace mw::hal
