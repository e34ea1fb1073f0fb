// SPDX-License-Identifier: GPL-2.0-or-later
// What Interpreter::snapshot() holds: modes and parameters at the top level.
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

/// As bytes; an error says what is under way that cannot be told so.
Result<std::string> pack(const Interpreter::Snapshot &kept, const detail::Names &names);
/// Back; what is not in the bytes is as in `now`.
Result<Interpreter::Snapshot> unpack(std::string_view bytes, const Interpreter::Snapshot &now,
                                     detail::Names &names);

}  // namespace mw::gcode
