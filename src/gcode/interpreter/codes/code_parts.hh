// SPDX-License-Identifier: GPL-2.0-or-later
// The function of a code: its parameters and its effect.
#pragma once

#include <cstdint>
#include <vector>

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/gcode.hh"
#include "gcode/interpreter/settings.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode::detail {

class LatheCycles;
class SavedModes;
struct BlockValues;

/// Action after the block, besides running the next one.
enum class Outcome : std::uint8_t {
    OK,
    SYNC,
    PROGRAM_END,
    CALL_FANUC,
    RETURN_FANUC,
    REMAP,
    RESTART,
    SCRIPT,
    PROFILE,
};

/// Effect of a code besides modes and canon calls: the block has failed with a fault, or the program
/// continues with an action after the block.
struct Effect {
    bool done = true;
    Outcome next = Outcome::OK;

    Effect(bool is_done) : done(is_done) {}
    Effect(Outcome outcome) : next(outcome) {}
    explicit operator bool() const { return done; }
};

/// Objects that codes use besides their block and the modes. Changes are undone when the block fails.
struct CodeParts {
    const World &world;
    const Settings &settings;
    const BlockPlace &place;
    CanonQueue &canon;  ///< receives the calls
    Parameters &parameters;
    ToolTable &tools;
    SavedModes &saved_modes;
    LatheCycles &lathe;
    std::vector<NurbsPoint> &control_points;  ///< control points of the open NURBS
    Awaited &awaited;
    FanucCall &fanuc_call;

    int count_spindles() const { return world.count_spindles(); }
    /// Factor from lengths of the parameter file and the tool table [machine units] to program units.
    double to_program(LengthUnits units) const {
        constexpr double MM_PER_INCH = 25.4;
        const double mm = world.mm_per_machine_unit();
        return units == LengthUnits::MM ? mm : mm / MM_PER_INCH;
    }
};

/// Runs a code: reads the words of the block, changes modes and parts, calls the canon.
using CodeFunction = Effect(GCode code, const BlockValues &values, State &state, CodeParts &parts);

}  // namespace mw::gcode::detail
