// SPDX-License-Identifier: GPL-2.0-or-later
// Result of a block for the code that runs the program.
#pragma once

namespace mw::gcode::detail {

/// Action after the block, besides running the next one.
enum class Outcome { OK, SYNC, PROGRAM_END, CALL_FANUC, RETURN_FANUC, REMAP, RESTART, SCRIPT, PROFILE };

}  // namespace mw::gcode::detail
