// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the I/O controller: component "iocontrol", pins iocontrol.0.* (requirement E1, man page
// iocontrol), declared in machine/io/pin_tables.hh.
#pragma once

#include "base/result.hh"
#include "hal/core/user_pin_set.hh"
#include "machine/io/pin_tables.hh"
#include "machine/io/tool_offset_block.hh"

namespace mw::io {

/// Not realtime; one thread.
class Pins {
  public:
    /// Creates the component and its pins.
    Result<> create(hal::Instance &hal);
    /// Removes the component and its pins.
    void destroy();

    /// Finds the pins of the tool offset in the realtime process, after the HAL files have loaded motmod. A
    /// substitute for motmod (motion-logger) has no such pins.
    Result<> join_tool_offset();

    Inputs read();
    void write(const Outputs &outputs);

  private:
    hal::Instance *hal_ = nullptr;
    int comp_id_ = 0;
    hal::UserPinSet<pins::IOCONTROL> pins_;
    ToolOffsetBlock *block_ = nullptr;  ///< null: no tool offset pins
    NumberedOffset sent_;
};

}  // namespace mw::io
