// SPDX-License-Identifier: GPL-2.0-or-later
// What a block leaves to who runs the program.
#pragma once

namespace mw::gcode::detail {

/// What is to be done after the block, beside running the next one.
enum class Outcome { OK, SYNC, PROGRAM_END, CALL_FANUC, RETURN_FANUC, REMAP, RESTART, SCRIPT, PROFILE };

}  // namespace mw::gcode::detail
