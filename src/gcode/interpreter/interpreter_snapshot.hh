// SPDX-License-Identifier: GPL-2.0-or-later
// Content of Interpreter::snapshot(): modes and parameters at the top level.
#pragma once

#include <string>
#include <string_view>

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/saved_modes.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode {

struct Interpreter::Snapshot {
    detail::State state;
    detail::Parameters parameters;
    detail::SavedModes saved_modes;
    detail::ReturnValue returned;
    detail::BlockCodes block_codes;
};

/// The snapshot as bytes; an error names a state that cannot be packed.
Result<std::string> pack(const Interpreter::Snapshot &kept, const detail::Names &names);
/// Reads the bytes; other fields are copied from `now`.
Result<Interpreter::Snapshot> unpack(std::string_view bytes, const Interpreter::Snapshot &now,
                                     detail::Names &names);

}  // namespace mw::gcode
