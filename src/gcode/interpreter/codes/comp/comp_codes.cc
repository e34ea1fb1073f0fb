// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {

Effect set_compensation(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (code == G(40)) {
        state.comp.end(parts.canon);
        return true;
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot turn cutter radius compensation on when it is on");
    }
    if (state.plane != Plane::XY && state.plane != Plane::XZ) {
        return values.fail("Cutter radius compensation allowed only in XY, XZ planes");
    }
    const bool dynamic = number_of(code) % 10 == 1;
    double diameter = state.tool.diameter * parts.to_program(state.units);
    int orientation = state.tool.orientation;
    if (dynamic) {
        if (values.has('l') && !values.whole('l', orientation)) {
            return false;
        }
        if (values.has('l') && state.plane != Plane::XZ) {
            return values.fail("L, the orientation of a lathe tool, needs the plane G18", 'l');
        }
        diameter = values.at('d');
        orientation = values.has('l') ? orientation : 0;
    } else if (values.has('d')) {
        int toolno = 0, index = 0;
        if (!tool_number(values, 'd', toolno)) {
            return false;
        }
        if (toolno == 0) {
            diameter = 0.0;
        } else if (!find_tool(values, 'd', toolno, parts.tools, index)) {
            return false;
        } else {
            const ToolEntry entry = parts.tools.entry(index);
            diameter = entry.diameter * parts.to_program(state.units);
            orientation = entry.orientation;
        }
    }
    constexpr int HIGHEST_ORIENTATION = 9, CENTRE = 9;
    if (orientation < 0 || orientation > HIGHEST_ORIENTATION) {
        return values.fail("The orientation of a lathe tool must be 0 to 9", 'l');
    }
    const bool is_nose = orientation > 0 && orientation < CENTRE;
    if (is_nose && state.plane != Plane::XZ) {
        return values.fail(fmt::format("G{} with lathe tool, but plane is not G18", number_of(code) / 10), 0,
                           fmt::format("the tool has orientation {}: program G18 first, or use a tool with "
                                       "orientation 0 or 9",
                                       orientation));
    }
    const bool left = (code < G(42)) == (diameter >= 0.0);
    state.comp.turn_on(left ? CompSide::LEFT : CompSide::RIGHT, code, std::fabs(diameter) / 2.0, orientation);
    parts.canon.take(ProgramComment{left ? "interpreter: cutter radius compensation on left"
                                         : "interpreter: cutter radius compensation on right"});
    return true;
}

}  // namespace mw::gcode::detail
