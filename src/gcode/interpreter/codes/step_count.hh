// SPDX-License-Identifier: GPL-2.0-or-later
// The number of passes or pecks of a cycle.
#pragma once

#include <cmath>
#include <limits>

namespace mw::gcode::detail {

/// Relative error of a number of a program: most decimal fractions are not exact in a double, and an
/// expression increases the error.
inline constexpr double FIGURE_ERROR = 4.0 * std::numeric_limits<double>::epsilon();

/// Rounds `steps` up. A number within `error` of a whole number counts as whole, so that no step has zero
/// depth.
inline double count_steps(double steps, double error) {
    const double whole = std::round(steps);
    return std::fabs(steps - whole) <= error ? whole : std::ceil(steps);
}

}  // namespace mw::gcode::detail
