// SPDX-License-Identifier: GPL-2.0-or-later
// Units of lengths and angles in the answers to a connection.
#pragma once

#include <string>

#include "clients/rsh/own_state.hh"

namespace mw::rsh {

/// Unit of the program: G20 or G21.
LengthUnit program_unit(const messages::MachineStatus &status);
/// The current meaning of AUTO.
LengthUnit shown_unit(const OwnState &own, const messages::MachineStatus &status);
/// Factor of machine lengths, and of angles, in answers. 1 with AUTO, so that a program's G20 does not change
/// the answers.
double length_factor(LengthUnit unit, const messages::MachineStatus &status);
double angle_factor(AngleUnit unit, const messages::MachineStatus &status);

const char *name_of(LengthUnit unit);
const char *name_of(AngleUnit unit);

}  // namespace mw::rsh
