// SPDX-License-Identifier: GPL-2.0-or-later
// Units in which a connection is told lengths and angles.
#pragma once

#include <string>

#include "clients/rsh/own_state.hh"

namespace mw::rsh {

/// Of the program: G20 or G21.
LengthUnit program_unit(const messages::MachineStatus &status);
/// What AUTO means now.
LengthUnit shown_unit(const OwnState &own, const messages::MachineStatus &status);
/// By which machine lengths, and angles, are multiplied to be told: with AUTO they stay what they are, so
/// that a program's G20 does not change what a client reads.
double length_factor(LengthUnit unit, const messages::MachineStatus &status);
double angle_factor(AngleUnit unit, const messages::MachineStatus &status);

const char *name_of(LengthUnit unit);
const char *name_of(AngleUnit unit);

}  // namespace mw::rsh
