// SPDX-License-Identifier: GPL-2.0-or-later
// State of the machine and settings that codes read.
#pragma once

#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode::detail {

struct Machine {
    const World &world;
    const Settings &settings;

    int count_spindles() const { return world.count_spindles(); }
    /// Factor from lengths of the parameter file and the tool table [machine units] to program units.
    double to_program(LengthUnits units) const {
        constexpr double MM_PER_INCH = 25.4;
        const double mm = world.mm_per_machine_unit();
        return units == LengthUnits::MM ? mm : mm / MM_PER_INCH;
    }
};

}  // namespace mw::gcode::detail
