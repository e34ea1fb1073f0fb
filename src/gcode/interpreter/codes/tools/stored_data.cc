// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/stored_data.hh"

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

void put_tool_entry(ToolTable &tools, CanonQueue &canon, int index, const ToolEntry &entry) {
    tools.set(index, entry);
    canon.take(SetToolTableEntry{index, entry});
}

/// Sets the offset with which the current tool position equals the programmed words.
void set_tool_axes(int l, const BlockValues &values, const Machine &machine, const Parameters &parameters,
                   const State &state, Pose &offset) {
    const double factor = machine.to_program(state.units);
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
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool halved = axis == geometry::AXIS_X && state.isDiameter;
            wanted[axis] = values.at(name) * (halved ? 0.5 : 1.0);
        }
    }
    offset = scale_lengths(in_machine - bare.to_machine(wanted), 1.0 / factor);
}

bool set_tool_data(int l, const BlockValues &values, const Machine &machine, ToolTable &tools,
                   const Parameters &parameters, State &state, CanonQueue &canon, Fault &fault) {
    int toolno = 0, index = 0;
    if (!values.has('p')) {
        return fault.set(fmt::format("G10 L{} needs P, the number of the tool", l));
    }
    if (!whole_word(values, 'p', toolno, fault)) {
        return false;
    }
    if (toolno < 1) {  // T0 of a random changer means an empty pocket
        return fault.set(fmt::format("P value out of range with G10 L{}", l), values.column_of('p'));
    }
    if (!find_tool(tools, toolno, values.column_of('p'), index, fault)) {
        return false;
    }
    const bool has_data =
        values.hasAxes() || values.has('r') || values.has('i') || values.has('j') || values.has('q');
    if (!has_data) {
        return fault.set(fmt::format("G10 L{} needs a value to set: axis words, R, I, J or Q", l));
    }
    const double to_machine = 1.0 / machine.to_program(state.units);
    ToolEntry entry = tools.entry(index);
    if (l == 1) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const char name = geometry::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool halved = axis == geometry::AXIS_X && state.isDiameter;
                const double scale = geometry::isAngular(axis) ? 1.0 : to_machine;
                entry.offset[axis] = values.at(name) * scale * (halved ? 0.5 : 1.0);
            }
        }
    } else if (values.hasAxes()) {
        set_tool_axes(l, values, machine, parameters, state, entry.offset);
    }
    entry.diameter = values.has('r') ? 2.0 * values.at('r') * to_machine : entry.diameter;
    entry.frontangle = values.at('i', entry.frontangle);
    entry.backangle = values.at('j', entry.backangle);
    if (values.has('q')) {
        if (!whole_word(values, 'q', entry.orientation, fault)) {
            return false;
        }
        if (entry.orientation < 0 || entry.orientation > 9) {
            return fault.set("The orientation Q of a tool must be 0 to 9", values.column_of('q'));
        }
    }
    put_tool_entry(tools, canon, index, entry);
    if (index == state.tool.index) {
        if (!tools.isRandom()) {  // its spindle entry is the tool itself, not a copy
            put_tool_entry(tools, canon, 0, entry);
        }
        const int was = state.tool.in_spindle;
        load_tool(tools, state.tool, index);
        state.tool.in_spindle = was;
    }
    return true;
}

/// G10 L0.
bool reload_tools(const State &state, CanonQueue &canon, Fault &fault, Outcome &outcome) {
    if (state.tool.in_spindle > 0) {
        return fault.set(fmt::format("G10 L0 not allowed with loaded tool <{}>", state.tool.in_spindle));
    }
    canon.take(ReloadTools{});
    outcome = Outcome::SYNC;
    return true;
}

/// G10 L2 (origin of the system in machine coordinates) and L20 (new value of the current position).
bool set_coordinate_system(int l, const BlockValues &values, const Machine &machine, Parameters &parameters,
                           State &state, CanonQueue &canon, Fault &fault) {
    const double to_program = machine.to_program(state.units);
    int index = 0;
    if (values.has('i') || values.has('j')) {
        return fault.set(fmt::format("I and J words are not allowed with G10 L{}", l),
                         values.column_of(values.has('i') ? 'i' : 'j'));
    }
    if (l == 20 && values.has('r')) {
        return fault.set("R not allowed in G10 L20", values.column_of('r'));
    }
    if (!values.has('p')) {
        return fault.set(fmt::format("G10 L{} needs P, 0 for the active coordinate system or 1 to 9", l));
    }
    if (!whole_word(values, 'p', index, fault)) {
        return false;
    }
    if (index < 0 || index > 9) {
        return fault.set(fmt::format("P value out of range (0-9) with G10 L{}", l), values.column_of('p'));
    }
    index = index == 0 ? state.g5x_index : index;
    const bool active = index == state.g5x_index;
    if (active && state.comp.isOn()) {
        return fault.set("Cannot change the active coordinate system while cutter radius compensation is on");
    }
    const int first = P_G5X + 20 * (index - 1);
    Frame made = state.frame;
    made.g5x = parameter_pose(parameters, first, to_program);
    made.rotation_deg = values.has('r') ? values.at('r') : parameters.get(first + 9);
    const Pose in_machine = state.frame.to_machine(state.position);
    Pose wanted = made.to_program(in_machine);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (!values.has(name)) {
            continue;
        }
        const bool halved = axis == geometry::AXIS_X && state.isDiameter;
        const double given = values.at(name) * (halved ? 0.5 : 1.0);
        (l == 2 ? made.g5x : wanted)[axis] = given;
    }
    if (l == 20) {
        made.g5x = {};
        made.g5x = in_machine - made.to_machine(wanted);
    }
    set_parameter_pose(parameters, first, made.g5x, to_program);
    parameters.set(first + 9, made.rotation_deg);
    if (!active) {
        canon.take(ProgramComment{"interpreter: setting coordinate system origin"});
        return true;
    }
    change_frame(state, made);
    send_coordinates(state, canon);
    return true;
}

}  // namespace

bool set_stored_data(const Code &, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault,
                     Outcome &outcome) {
    int l = 0;
    if (!whole_word(values, 'l', l, fault)) {
        return false;
    }
    switch (l) {
    case 0: return reload_tools(state, canon, fault, outcome);
    case 1:
    case 10:
    case 11: return set_tool_data(l, values, machine, tools, parameters, state, canon, fault);
    case 2:
    case 20: return set_coordinate_system(l, values, machine, parameters, state, canon, fault);
    default: break;
    }
    return fault.set("Line with G10 does not have L0, L1, L2, L10, L11 or L20", values.column_of('l'));
}

}  // namespace mw::gcode::detail
