// SPDX-License-Identifier: GPL-2.0-or-later
// What programs and scripts can read beside modes and parameters.
#pragma once

namespace mw::gcode::detail {

/// Where the block stands.
struct BlockPlace {
    int line = 0;      ///< in its file
    int sequence = 0;  ///< its N word, or the line
    int call_level = 0;
};

/// Codes of the last block that set no mode; -1: none.
struct BlockCodes {
    int non_modal = -1;    ///< ten times the G code
    int stop = -1;         ///< M0, M1, M2, M30, M60
    int tool_change = -1;  ///< M6, M61
};

/// What the last call returned: #<_value> and #<_value_returned>.
struct ReturnValue {
    double value = 0;
    bool isSet = false;
};

/// What the next waiting point is for.
struct Awaited {
    bool isProbe = false, isInput = false;  ///< results that the next synch() takes
    bool isToolChange = false;              ///< a script has changed the tool: a waiting point is due
};

/// The M98 that the program has come to.
struct FanucCall {
    int label = 0;  ///< of the subroutine
    int count = 1;  ///< of calls
};

/// Numbers that scripts set for one another.
struct ScriptLevels {
    int debug_mask = 0, logging_level = 0;
};

}  // namespace mw::gcode::detail
