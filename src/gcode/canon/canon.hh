// SPDX-License-Identifier: GPL-2.0-or-later
// The canonical machine: what the interpreter asks of whoever runs, prints, checks or previews a program.
#pragma once

#include <string_view>

#include "base/overloaded.hh"
#include "gcode/canon/canon_calls.hh"

namespace mw::gcode {

/// The block that the calls after it come from. Views live until the call returns.
struct BlockRef {
    std::string_view file;
    int line = 0;        ///< from 1, in `file`
    int sequence = 0;    ///< the N word, else `line`; what operators see as the line number
    int call_level = 0;  ///< 0 in the main program
    std::string_view text;
    bool isNumbered = false;  ///< the block has an N word
};

/// Positions and lengths are in program units (as the last UseLengthUnits said) and in program coordinates,
/// that is before rotation, G5x, G92 and tool offsets, which are announced by calls of their own; angles in
/// degrees. No call blocks, and none answers: what the interpreter must know of the machine it asks a
/// `World`. `gcode::MachineFrame` hands on to a `MachineCanon` with all of it converted to machine
/// coordinates and units.
class Canon {
  public:
    virtual ~Canon() = default;

    /// Names the block that all following calls belong to.
    virtual void begin_block(const BlockRef &block) = 0;
    virtual void take(const CanonCall &call) = 0;
};

}  // namespace mw::gcode
