// SPDX-License-Identifier: GPL-2.0-or-later
// The state of the interpreter as a value: modes and parameters, without calls and loops.
#pragma once

#include <string>
#include <string_view>

#include "base/result.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/saved_modes.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/program_interpreter.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode {

/// Copied by searches, read by displays and journals. Parameters are numbered; the names of named ones belong
/// to one interpreter.
struct InterpreterState {
    detail::State modes;
    detail::Parameters parameters;
    detail::SavedModes saved_modes;
    detail::ReturnValue returned;
    detail::BlockCodes block_codes;

    /// `sequence`: number of the last executed block.
    ActiveCodes active_codes(int sequence) const;
    /// True if the motion mode is G33 or G33.1.
    bool isThreading() const;
    /// The reason why a run cannot start at the next line although all lines before it are known; empty if it
    /// can.
    std::string why_no_start() const;
};

/// The state as bytes, for another process; an error names a state that cannot be packed.
Result<std::string> pack(const InterpreterState &state, const detail::Names &names);
/// Reads the bytes; other fields are copied from `now`.
Result<InterpreterState> unpack(std::string_view bytes, const InterpreterState &now, detail::Names &names);

}  // namespace mw::gcode
