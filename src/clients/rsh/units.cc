// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/units.hh"

#include <cmath>
#include <numbers>

namespace mw::rsh {
namespace {

constexpr double MM_PER_INCH = 25.4, RAD_PER_DEG = std::numbers::pi / 180, GRAD_PER_DEG = 100.0 / 90;
/// Within a hundredth: files have their units with a few digits.
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

LengthUnit program_unit(const messages::MachineStatus &status) {
    constexpr std::size_t UNITS = 5;  // place in the modal codes
    constexpr int G20 = 200;
    return status.codes.g[UNITS] == G20 ? LengthUnit::INCH : LengthUnit::MM;
}

LengthUnit shown_unit(const OwnState &own, const messages::MachineStatus &status) {
    return own.length_unit == LengthUnit::AUTO ? program_unit(status) : own.length_unit;
}

double length_factor(const OwnState &own, const messages::MachineStatus &status) {
    const double mm = 1 / status.settings.linear_units;
    switch (own.length_unit) {
    case LengthUnit::INCH: return mm / MM_PER_INCH;
    case LengthUnit::MM: return mm;
    case LengthUnit::CM: return mm / 10;
    case LengthUnit::AUTO:
    case LengthUnit::CUSTOM: break;
    }
    return 1;
}

double angle_factor(const OwnState &own, const messages::MachineStatus &status) {
    const double deg = 1 / status.settings.angular_units;
    switch (own.angle_unit) {
    case AngleUnit::DEG: return deg;
    case AngleUnit::RAD: return deg * RAD_PER_DEG;
    case AngleUnit::GRAD: return deg * GRAD_PER_DEG;
    case AngleUnit::AUTO:
    case AngleUnit::CUSTOM: break;
    }
    return 1;
}

const char *name_of(LengthUnit unit) {
    switch (unit) {
    case LengthUnit::AUTO: return "AUTO";
    case LengthUnit::INCH: return "INCH";
    case LengthUnit::MM: return "MM";
    case LengthUnit::CM: return "CM";
    case LengthUnit::CUSTOM: break;
    }
    return "CUSTOM";
}

const char *name_of(AngleUnit unit) {
    switch (unit) {
    case AngleUnit::AUTO: return "AUTO";
    case AngleUnit::DEG: return "DEG";
    case AngleUnit::RAD: return "RAD";
    case AngleUnit::GRAD: return "GRAD";
    case AngleUnit::CUSTOM: break;
    }
    return "CUSTOM";
}

}  // namespace mw::rsh
