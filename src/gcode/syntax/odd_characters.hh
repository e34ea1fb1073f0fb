// SPDX-License-Identifier: GPL-2.0-or-later
// Characters that programs may contain only in comments and names: control characters and non-ASCII
// characters.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace mw::gcode::detail {

struct OddCharacter {
    std::size_t position = 0;
    std::string name;  ///< "U+2212 (minus sign, not '-')"
};

/// The first one of a line.
std::optional<OddCharacter> find_odd_character(std::string_view line);

}  // namespace mw::gcode::detail
