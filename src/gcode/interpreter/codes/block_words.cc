// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/block_words.hh"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace mw::gcode::detail {

bool whole_word(const BlockValues &values, char name, int &out, Fault &fault) {
    const double value = values.at(name);
    const double rounded = std::round(value);
    constexpr double TOLERANCE = 1e-4;
    if (std::fabs(value - rounded) > TOLERANCE || std::fabs(value) > 1e9) {
        return fault.set(fmt::format("{} must be a whole number here, not {}",
                                     static_cast<char>(std::toupper(name)), value),
                         values.column_of(name));
    }
    out = static_cast<int>(rounded);
    return true;
}

bool spindle_of(const BlockValues &values, int spindles, int &spindle, Fault &fault) {
    spindle = 0;
    if (!values.has('$')) {
        return true;
    }
    if (!whole_word(values, '$', spindle, fault)) {
        return false;
    }
    if (spindle < ALL_SPINDLES || spindle >= spindles) {
        return fault.set(fmt::format("There is no spindle {}: $ may be 0 to {}", spindle, spindles - 1),
                         values.column_of('$'));
    }
    return true;
}

std::string code_name(const Code &code) {
    if (code.letter == 'g') {
        return code.number % 10 == 0 ? fmt::format("g{}", code.number / 10)
                                     : fmt::format("g{}.{}", code.number / 10, code.number % 10);
    }
    return fmt::format("{}{}", code.letter, code.number);
}

}  // namespace mw::gcode::detail
