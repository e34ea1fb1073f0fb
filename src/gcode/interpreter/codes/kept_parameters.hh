// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters that the interpreter computes itself: #<_name>, #5021 to #5029 and #5400 to #5428.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/interpreter/codes/code_parts.hh"

namespace mw::gcode::detail {

/// Objects that the values are read from.
struct KeptSources {
    const State &state;
    const ReturnValue &returned;
    const CodeParts &parts;
    Pose position;  ///< tool position including compensation [program units, degrees]
    int running_remaps = 0;
};

bool isKeptName(std::string_view name);
/// Nothing when there is no such name.
std::optional<double> kept_value(std::string_view name, const KeptSources &sources);
/// `number` must satisfy isBuiltInNumber().
double kept_value(int number, const KeptSources &sources);
/// All names, sorted.
std::vector<std::string> kept_names();

}  // namespace mw::gcode::detail
