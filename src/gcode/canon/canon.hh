// SPDX-License-Identifier: GPL-2.0-or-later
// The canonical machine: the interface between the interpreter and the code that runs, prints, checks or
// previews a program.
#pragma once

#include <string_view>

#include "base/overloaded.hh"
#include "gcode/canon/canon_calls.hh"

namespace mw::gcode {

/// The block of the calls that follow. Views are valid until the call returns.
struct BlockRef {
    std::string_view file;
    int line = 0;        ///< from 1, in `file`
    int sequence = 0;    ///< the N word, else `line`; shown to operators as the line number
    int call_level = 0;  ///< 0 in the main program
    std::string_view text;
    bool isNumbered = false;  ///< the block has an N word
};

/// Positions and lengths are in program units (see UseLengthUnits) and program coordinates, that is before
/// rotation, G5x, G92 and tool offsets, which have separate calls; angles in degrees. Calls do not block and
/// return nothing. The interpreter reads the state of the machine from a `World`. `gcode::MachineFrame`
/// converts the calls to machine coordinates and units and passes them to a `MachineCanon`.
class Canon {
  public:
    virtual ~Canon() = default;

    /// Names the block of the following calls.
    virtual void begin_block(const BlockRef &block) = 0;
    virtual void take(const CanonCall &call) = 0;
};

}  // namespace mw::gcode
