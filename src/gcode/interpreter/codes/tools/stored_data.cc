// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

void put_tool_entry(int index, const ToolEntry &entry, CodeParts &parts) {
    parts.tools.set(index, entry);
    parts.canon.take(SetToolTableEntry{index, entry});
}

/// Sets the offset with which the current tool position equals the programmed words.
void set_tool_axes(int l, const BlockValues &values, const State &state, const CodeParts &parts,
                   Pose &offset) {
    const Parameters &parameters = parts.parameters;
    const double factor = parts.to_program(state.units);
    Frame plain = state.frame;
    if (l == 11) {  // relative to the fixture G59.3, without G92
        constexpr int FIXTURE = 8;
        plain.g5x = parameter_pose(parameters, P_G5X + 20 * FIXTURE, factor);
        plain.rotation_deg = parameters.get(P_G5X + 20 * FIXTURE + 9);
        plain.g92 = {};
    }
    const Pose in_machine = state.frame.to_machine(state.position);
    Frame bare = plain;
    bare.tool = {};
    // Position of the other axes with the table's current offset.
    Frame tabled = plain;
    tabled.tool = scale_lengths(offset, factor);
    Pose wanted = tabled.to_program(in_machine);
    replace_axes(values, state, wanted);
    offset = scale_lengths(in_machine - bare.to_machine(wanted), 1.0 / factor);
}

bool set_tool_data(int l, const BlockValues &values, State &state, CodeParts &parts) {
    ToolTable &tools = parts.tools;
    int toolno = 0, index = 0;
    if (!values.has('p')) {
        return values.fail(fmt::format("G10 L{} needs P, the number of the tool", l));
    }
    if (!values.whole('p', toolno)) {
        return false;
    }
    if (toolno < 1) {  // T0 of a random changer means an empty pocket
        return values.fail(fmt::format("P value out of range with G10 L{}", l), 'p');
    }
    if (!find_tool(values, 'p', toolno, tools, index)) {
        return false;
    }
    const bool has_data =
        values.hasAxes() || values.has('r') || values.has('i') || values.has('j') || values.has('q');
    if (!has_data) {
        return values.fail(fmt::format("G10 L{} needs a value to set: axis words, R, I, J or Q", l));
    }
    const double to_machine = 1.0 / parts.to_program(state.units);
    ToolEntry entry = tools.entry(index);
    if (l == 1) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            if (const std::optional<double> word = axis_word(values, state, axis)) {
                entry.offset[axis] = *word * (geometry::isAngular(axis) ? 1.0 : to_machine);
            }
        }
    } else if (values.hasAxes()) {
        set_tool_axes(l, values, state, parts, entry.offset);
    }
    entry.diameter = values.has('r') ? 2.0 * values.at('r') * to_machine : entry.diameter;
    entry.frontangle = values.at('i', entry.frontangle);
    entry.backangle = values.at('j', entry.backangle);
    if (values.has('q')) {
        if (!values.whole('q', entry.orientation)) {
            return false;
        }
        if (entry.orientation < 0 || entry.orientation > 9) {
            return values.fail("The orientation Q of a tool must be 0 to 9", 'q');
        }
    }
    put_tool_entry(index, entry, parts);
    if (index == state.tool.index) {
        if (!tools.isRandom()) {  // the spindle entry of a random changer is the tool itself, not a copy
            put_tool_entry(0, entry, parts);
        }
        const int was = state.tool.in_spindle;
        load_tool(tools, state.tool, index);
        state.tool.in_spindle = was;
    }
    return true;
}

/// G10 L0.
Effect reload_tools(const BlockValues &values, const State &state, CodeParts &parts) {
    if (state.tool.in_spindle > 0) {
        return values.fail(fmt::format("G10 L0 not allowed with loaded tool <{}>", state.tool.in_spindle));
    }
    parts.canon.take(ReloadTools{});
    return Outcome::SYNC;
}

/// G10 L2 (origin of the system in machine coordinates) and L20 (new value of the current position).
bool set_coordinate_system(int l, const BlockValues &values, State &state, CodeParts &parts) {
    Parameters &parameters = parts.parameters;
    const double to_program = parts.to_program(state.units);
    int index = 0;
    if (values.has('i') || values.has('j')) {
        return values.fail(fmt::format("I and J words are not allowed with G10 L{}", l),
                           values.has('i') ? 'i' : 'j');
    }
    if (l == 20 && values.has('r')) {
        return values.fail("R not allowed in G10 L20", 'r');
    }
    if (!values.has('p')) {
        return values.fail(fmt::format("G10 L{} needs P, 0 for the active coordinate system or 1 to 9", l));
    }
    if (!values.whole('p', index)) {
        return false;
    }
    if (index < 0 || index > 9) {
        return values.fail(fmt::format("P value out of range (0-9) with G10 L{}", l), 'p');
    }
    index = index == 0 ? state.g5x_index : index;
    const bool active = index == state.g5x_index;
    if (active && state.comp.isOn()) {
        return values.fail(
            "Cannot change the active coordinate system while cutter radius compensation is on");
    }
    const int first = P_G5X + 20 * (index - 1);
    Frame made = state.frame;
    made.g5x = parameter_pose(parameters, first, to_program);
    made.rotation_deg = values.has('r') ? values.at('r') : parameters.get(first + 9);
    const Pose in_machine = state.frame.to_machine(state.position);
    Pose wanted = made.to_program(in_machine);
    replace_axes(values, state, l == 2 ? made.g5x : wanted);
    if (l == 20) {
        made.g5x = {};
        made.g5x = in_machine - made.to_machine(wanted);
    }
    set_parameter_pose(parameters, first, made.g5x, to_program);
    parameters.set(first + 9, made.rotation_deg);
    if (!active) {
        parts.canon.take(ProgramComment{"interpreter: setting coordinate system origin"});
        return true;
    }
    change_frame(state, made);
    send_coordinates(state, parts.canon);
    return true;
}

}  // namespace

Effect set_stored_data(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    int l = 0;
    if (!values.whole('l', l)) {
        return false;
    }
    switch (l) {
    case 0: return reload_tools(values, state, parts);
    case 1:
    case 10:
    case 11: return set_tool_data(l, values, state, parts);
    case 2:
    case 20: return set_coordinate_system(l, values, state, parts);
    default: break;
    }
    return values.fail("Line with G10 does not have L0, L1, L2, L10, L11 or L20", 'l');
}

}  // namespace mw::gcode::detail
