// SPDX-License-Identifier: GPL-2.0-or-later
// What Interpreter::keep() holds: modes and parameters at the top level.
#pragma once

#include <string>
#include <string_view>

#include "interp/ast/names.hh"
#include "interp/codes/around_block.hh"
#include "interp/codes/saved_modes.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/interpreter.hh"

namespace mw::interp {

struct Interpreter::Kept {
    detail::State state;
    detail::Parameters parameters;
    detail::SavedModes saved_modes;
    detail::ReturnValue returned;
    detail::BlockCodes block_codes;
};

/// As bytes; an error says what is under way that cannot be told so.
Result<std::string> pack(const Interpreter::Kept &kept, const detail::Names &names);
/// Back; what is not in the bytes is as in `now`.
Result<Interpreter::Kept> unpack(std::string_view bytes, const Interpreter::Kept &now, detail::Names &names);

}  // namespace mw::interp
