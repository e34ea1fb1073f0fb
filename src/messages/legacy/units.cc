// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/legacy/units.hh"

#include <cmath>

namespace mw::legacy {
namespace {

/// Tolerance of one percent, because files contain units with only a few digits.
bool isAbout(double value, double wanted) {
    return std::abs(value - wanted) < 0.01 * wanted;
}

}  // namespace

std::string name_of_length(double units_per_mm) {
    return isAbout(units_per_mm, 1 / MM_PER_INCH) ? "INCH"
           : isAbout(units_per_mm, 1)             ? "MM"
           : isAbout(units_per_mm, 0.1)           ? "CM"
                                                  : "CUSTOM";
}

std::string name_of_angle(double units_per_deg) {
    return isAbout(units_per_deg, 1)              ? "DEG"
           : isAbout(units_per_deg, RAD_PER_DEG)  ? "RAD"
           : isAbout(units_per_deg, GRAD_PER_DEG) ? "GRAD"
                                                  : "CUSTOM";
}

}  // namespace mw::legacy
