// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/units.hh"

#include <array>

#include "messages/legacy/status_table.hh"
#include "messages/legacy/units.hh"

namespace mw::rsh {

LengthUnit program_unit(const messages::MachineStatus &status) {
    return legacy::program_units(status) == 1 ? LengthUnit::INCH : LengthUnit::MM;
}

LengthUnit shown_unit(const OwnState &own, const messages::MachineStatus &status) {
    return own.length_unit == LengthUnit::AUTO ? program_unit(status) : own.length_unit;
}

double length_factor(LengthUnit unit, const messages::MachineStatus &status) {
    const double mm = 1 / status.settings.linear_units;
    switch (unit) {
    case LengthUnit::INCH: return mm / legacy::MM_PER_INCH;
    case LengthUnit::MM: return mm;
    case LengthUnit::CM: return mm / 10;
    case LengthUnit::AUTO:
    case LengthUnit::CUSTOM: break;
    }
    return 1;
}

double angle_factor(AngleUnit unit, const messages::MachineStatus &status) {
    const double deg = 1 / status.settings.angular_units;
    switch (unit) {
    case AngleUnit::DEG: return deg;
    case AngleUnit::RAD: return deg * legacy::RAD_PER_DEG;
    case AngleUnit::GRAD: return deg * legacy::GRAD_PER_DEG;
    case AngleUnit::AUTO:
    case AngleUnit::CUSTOM: break;
    }
    return 1;
}

const char *name_of(LengthUnit unit) {
    constexpr std::array NAMES{"AUTO", "INCH", "MM", "CM", "CUSTOM"};
    return NAMES[static_cast<std::size_t>(unit)];
}

const char *name_of(AngleUnit unit) {
    constexpr std::array NAMES{"AUTO", "DEG", "RAD", "GRAD", "CUSTOM"};
    return NAMES[static_cast<std::size_t>(unit)];
}

}  // namespace mw::rsh
