// SPDX-License-Identifier: GPL-2.0-or-later
// The pins motion.tooloffset.*: the realtime part of the I/O controller. They belong to the realtime process,
// so that they keep their values while the machine stops after the death of the task process.
#pragma once

#include <cstdint>

#include "base/limits.hh"
#include "machine/io/tool_offset_block.hh"
#include "machine/io/tool_offset_pin_tables.hh"

namespace mw::io {

/// Lives in HAL memory.
class ToolOffsetPins {
  public:
    /// Creates the pins; returns 0 or a negated errno. [while loading]
    int declare(int comp_id) noexcept;
    /// Writes the latest offset to all pins, between two cycles of the threads that read them. During a write
    /// of the I/O controller, and after a write that its process did not finish, the pins keep their values.
    /// [servo]
    [[gnu::hot]] void step(ToolOffsetBlock &block) noexcept;

  private:
    NumberedOffset current_;
    const std::uint32_t *links_ = nullptr;  ///< counter of HAL that changes when pins are linked
    std::uint32_t last_links_ = 0;
    std::uint32_t last_version_ = 0;  ///< version of the block
    sdk::PinSet<pins::TOOL_OFFSET> pins_[MAX_AXES];
};

}  // namespace mw::io
