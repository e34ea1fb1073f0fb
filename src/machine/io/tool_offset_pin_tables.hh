// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of the I/O controller in the realtime process. The pins in the task process are in
// machine/io/pin_tables.hh.
#pragma once

#include "hal/sdk/pin_table.hh"

namespace mw::io::pins {

// clang-format off
inline constexpr auto TOOL_OFFSET = sdk::pin_table("motion",
    sdk::out<double>("tooloffset.@", "unit", "active tool offset", [](double offset) { return offset; }));
// clang-format on

}  // namespace mw::io::pins
