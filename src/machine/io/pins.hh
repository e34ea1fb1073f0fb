// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the I/O controller: component "iocontrol", pins iocontrol.0.* (requirement E1, man page
// iocontrol), as machine/io/pin_tables.hh has them.
#pragma once

#include "base/result.hh"
#include "hal/core/user_pin_set.hh"
#include "machine/io/pin_tables.hh"
#include "machine/io/tool_offset_block.hh"

namespace mw::io {

/// Not realtime; one thread.
class Pins {
  public:
    /// Makes the component and its pins.
    Result<> create(hal::Hal &hal);
    /// Ends the component; its pins vanish.
    void destroy();

    /// Finds what shows the tool offset in the realtime process: once the HAL files have loaded motmod. A
    /// program that stands in for it (motion-logger) has no such pins.
    Result<> join_tool_offset();

    Inputs read();
    void write(const Outputs &outputs);

  private:
    hal::Hal *hal_ = nullptr;
    int comp_id_ = 0;
    hal::UserPinSet<pins::IOCONTROL> pins_;
    ToolOffsetBlock *block_ = nullptr;  ///< null: nobody shows the tool offset
    NumberedOffset sent_;
};

}  // namespace mw::io
