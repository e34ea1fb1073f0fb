// SPDX-License-Identifier: GPL-2.0-or-later
// Coolant, overrides, outputs and inputs, user codes, dwell. All codes: false after setting the fault.
#pragma once

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// M7, M8 and M9.
bool switch_coolant(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                    Fault &fault);
/// M48 to M53: P0 switches off.
bool switch_overrides(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault);
/// M62 to M65 (digital), M67 and M68 (analog).
bool set_output(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// M66. The program waits for the machine after it.
bool wait_for_input(const Code &code, const BlockValues &values, Parameters &parameters, Awaited &awaited,
                    State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// M100 to M199: a program of that name in one of the folders for them.
bool run_user_code(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                   CanonQueue &canon, Fault &fault);
/// G4.
bool dwell(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
