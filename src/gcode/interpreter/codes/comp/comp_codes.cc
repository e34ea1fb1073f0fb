// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/comp/comp_codes.hh"

#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {

void end_compensation(State &state, CanonQueue &canon) {
    canon.take(ProgramComment{"interpreter: cutter radius compensation off"});
    state.comp.turn_off();
}

bool set_compensation(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                      State &state, CanonQueue &canon, Fault &fault, Outcome &) {
    if (code.number == 400) {
        end_compensation(state, canon);
        return true;
    }
    if (state.comp.isOn()) {
        return fault.set("Cannot turn cutter radius compensation on when it is on");
    }
    if (state.plane != Plane::XY && state.plane != Plane::XZ) {
        return fault.set("Cutter radius compensation allowed only in XY, XZ planes");
    }
    const bool dynamic = code.number % 10 == 1;
    double diameter = state.tool.diameter * machine.to_program(state.units);
    int orientation = state.tool.orientation;
    if (dynamic) {
        if (values.has('l') && !whole_word(values, 'l', orientation, fault)) {
            return false;
        }
        if (values.has('l') && state.plane != Plane::XZ) {
            return fault.set("L, the orientation of a lathe tool, needs the plane G18",
                             values.column_of('l'));
        }
        diameter = values.at('d');
        orientation = values.has('l') ? orientation : 0;
    } else if (values.has('d')) {
        int toolno = 0, index = 0;
        if (!whole_word(values, 'd', toolno, fault)) {
            return false;
        }
        if (toolno < 0) {
            return fault.set("Negative tool number: D must be 0 or more", values.column_of('d'));
        }
        if (toolno == 0) {
            diameter = 0.0;
        } else if (!find_tool(tools, toolno, values.column_of('d'), index, fault)) {
            return false;
        } else {
            const ToolEntry entry = tools.entry(index);
            diameter = entry.diameter * machine.to_program(state.units);
            orientation = entry.orientation;
        }
    }
    constexpr int HIGHEST_ORIENTATION = 9, CENTRE = 9;
    if (orientation < 0 || orientation > HIGHEST_ORIENTATION) {
        return fault.set("The orientation of a lathe tool must be 0 to 9", values.column_of('l'));
    }
    const bool is_nose = orientation > 0 && orientation < CENTRE;
    if (is_nose && state.plane != Plane::XZ) {
        return fault.set(fmt::format("G{} with lathe tool, but plane is not G18", code.number / 10), 0,
                         fmt::format("the tool has orientation {}: program G18 first, or use a tool with "
                                     "orientation 0 or 9",
                                     orientation));
    }
    const bool left = (code.number < 420) == (diameter >= 0.0);
    state.comp.turn_on(left ? CompSide::LEFT : CompSide::RIGHT, code.number, std::fabs(diameter) / 2.0,
                       orientation);
    canon.take(ProgramComment{left ? "interpreter: cutter radius compensation on left"
                                   : "interpreter: cutter radius compensation on right"});
    return true;
}

}  // namespace mw::gcode::detail
