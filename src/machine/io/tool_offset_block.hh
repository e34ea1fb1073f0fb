// SPDX-License-Identifier: GPL-2.0-or-later
// Shared memory that transfers the tool offset from the I/O controller (task process) to its pins (realtime
// process). It contains no pointers.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/seqlock.hh"

namespace mw::io {

struct NumberedOffset {
    std::uint32_t number = 0;  ///< number of the value; 0: no value yet
    geometry::Pose offset;     ///< [machine units]
};

struct ToolOffsetBlock {
    static constexpr std::uint32_t MAGIC = 0x4d57544f;  // "MWTO"
    static constexpr int SHMEM_KEY = 0x4d570400;        ///< key for rtapi_shmem_new
    std::uint32_t magic = 0;
    std::uint32_t layout_bytes = 0;  ///< sizeof(ToolOffsetBlock) of the creator

    Seqlock<NumberedOffset> latest;       ///< I/O controller -> servo thread
    std::atomic<std::uint32_t> shown{0};  ///< servo thread -> I/O controller: number of the value on the pins
};

}  // namespace mw::io
