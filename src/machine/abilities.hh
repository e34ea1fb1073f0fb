// SPDX-License-Identifier: GPL-2.0-or-later
// What a program may ask for that a machine of this version does not do: the one list of it.
#pragma once

#include <string_view>

#include "gcode/preview.hh"

namespace mw::machine {

/// One thing that a machine cannot do.
struct MissingAbility {
    gcode::PreviewKind kind;
    std::string_view code;    ///< as programs have it, in upper case
    std::string_view what;    ///< "tap rigidly"
    std::string_view remedy;  ///< what the program can do instead
    bool isForAxes = false;   ///< a machine whose joints are axes can
};

/// Null when a machine can do what the event asks for. `areJointsAxes`: its kinematics is trivkins.
const MissingAbility *missing_ability(const gcode::PreviewEvent &event, bool areJointsAxes);

/// The column of a G or M code in a line of a program, from 1; 1 when the line has none (the code is modal).
int column_of_code(std::string_view line, std::string_view code);

}  // namespace mw::machine
