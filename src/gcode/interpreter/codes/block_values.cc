// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/block_values.hh"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace mw::gcode::detail {

bool BlockValues::whole(char name, int &out) const {
    const double given = at(name);
    const double rounded = std::round(given);
    constexpr double TOLERANCE = 1e-4;
    if (std::fabs(given - rounded) > TOLERANCE || std::fabs(given) > 1e9) {
        return fail(fmt::format("{} must be a whole number here, not {}",
                                static_cast<char>(std::toupper(name)), given),
                    name);
    }
    out = static_cast<int>(rounded);
    return true;
}

bool BlockValues::spindle(int spindles, int &out) const {
    out = 0;
    if (!has('$')) {
        return true;
    }
    if (!whole('$', out)) {
        return false;
    }
    return (out >= ALL_SPINDLES && out < spindles) ||
           fail(fmt::format("There is no spindle {}: $ may be 0 to {}", out, spindles - 1), '$');
}

bool BlockValues::fail(std::string message, char word, std::string hint) const {
    return fault->set(std::move(message), word == 0 ? 0 : column_of(word), std::move(hint));
}

}  // namespace mw::gcode::detail
