// SPDX-License-Identifier: GPL-2.0-or-later
// Sine, cosine and tangent of angles in degrees, rounded from extended precision: sin[30] is 0.5, and a
// program that compares or rounds the value has the same result as in LinuxCNC. Several times faster than the
// library's functions in long double.
#pragma once

namespace mw::gcode::detail {

/// Sine of any finite angle [deg]; within one unit in the last place of the library's long double result, and
/// equal to it near zeros (below 0.001) and poles.
double sine_of_degrees(double degrees);
double cosine_of_degrees(double degrees);
double tangent_of_degrees(double degrees);

}  // namespace mw::gcode::detail
