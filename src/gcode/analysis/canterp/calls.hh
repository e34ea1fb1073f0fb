// SPDX-License-Identifier: GPL-2.0-or-later
// Canon calls as text, one call per line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/canon/canon.hh"

namespace mw::gcode::canterp {

/// A line split into two columns that are ignored and NAME(arguments).
struct Call {
    std::string_view name, arguments;
    std::size_t name_offset = 0, arguments_offset = 0;  ///< offset in the line, from 0
};

enum class Kind { NOTHING, CALL, BAD };
/// NOTHING for blank lines.
Kind take_apart(std::string_view line, Call &call);

/// Calls the canon. `plane` is the selected plane; SELECT_PLANE changes it. An error names the column.
Result<> make_call(const Call &call, Canon &canon, Plane &plane);

}  // namespace mw::gcode::canterp
