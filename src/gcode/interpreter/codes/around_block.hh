// SPDX-License-Identifier: GPL-2.0-or-later
// Values besides modes and parameters that programs and scripts can read.
#pragma once

namespace mw::gcode::detail {

/// Position of the block.
struct BlockPlace {
    int line = 0;      ///< in its file
    int sequence = 0;  ///< its N word, or the line
    int call_level = 0;
};

/// Codes of the last block without a mode; -1: none.
struct BlockCodes {
    int non_modal = -1;    ///< ten times the G code
    int stop = -1;         ///< M0, M1, M2, M30, M60
    int tool_change = -1;  ///< M6, M61
};

/// Return value of the last call: #<_value> and #<_value_returned>.
struct ReturnValue {
    double value = 0;
    bool set = false;
};

/// Reason of the next synchronisation point.
struct Awaited {
    bool isProbe = false, is_input = false;  ///< results that the next synch() takes
    bool is_tool_change = false;             ///< a script has changed the tool, so the machine must be
                                             ///< synchronised
};

/// The M98 that the program has reached.
struct FanucCall {
    int label = 0;  ///< of the subroutine
    int count = 1;  ///< number of calls
};

/// Numbers that scripts set for each other.
struct ScriptLevels {
    int debug_mask = 0, logging_level = 0;
};

}  // namespace mw::gcode::detail
