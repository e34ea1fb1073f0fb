// SPDX-License-Identifier: GPL-2.0-or-later
// Tools: T, M6, M61, G43 to G49 and the tool table's G10.
#include <cmath>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {

void Executor::put_tool_entry(int index, const ToolEntry &entry) {
    tool_table_.set(index, entry);
    canon.take(SetToolTableEntry{index, entry});
}

bool Executor::find_tool(int toolno, std::uint32_t column, int &index) {
    index = tools_.index_of_tool(toolno);
    if (index < 0) {
        return fault.set(fmt::format("Requested tool {} not found in the tool table", toolno), column);
    }
    return true;
}

/// The tool at `index` is in the spindle; index 0 of a table without random places means none.
void Executor::load_tool(int index) {
    const ToolEntry entry = index == 0 && !tools_.isRandom() ? ToolEntry{} : tool_table_.entry(index);
    state.tool_index = index;
    state.tool_in_spindle = entry.toolno > 0 ? entry.toolno : 0;
    state.loaded_offset = entry.offset;
    state.tool_diameter = entry.diameter;
    state.tool_frontangle = entry.frontangle;
    state.tool_backangle = entry.backangle;
    state.tool_orientation = entry.orientation;
}

bool Executor::do_tool_word(const Code &, const BlockValues &values) {
    int toolno = 0, index = 0;
    if (!whole_word(values, 't', toolno)) {
        return false;
    }
    if (toolno < 0) {
        return fault.set("Negative tool number: T must be 0 or more", values.column_of('t'));
    }
    const bool isNone = toolno == 0 && !tools_.isRandom();
    if (!isNone && !find_tool(toolno, values.column_of('t'), index)) {
        return false;
    }
    state.selected_tool = toolno;
    state.selected_index = index;
    canon.take(SelectTool{toolno});
    return true;
}

bool Executor::do_change_tool(const Code &, const BlockValues &) {
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot change tools while cutter radius compensation is on");
    }
    if (state.selected_index < 0) {
        return fault.set("M6 needs a tool: there was no T word before");
    }
    for (int i = 0; i < world_.count_spindles(); ++i) {
        SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        spindle.direction = 0;
        canon.take(StopSpindle{i});
    }
    canon.take(ChangeTool{});
    load_tool(state.selected_index);
    retain_tool_offset();
    outcome = Outcome::SYNC;
    return true;
}

/// RETAIN_G43: an offset that is in force follows the tool in the spindle and ends with the last one.
void Executor::retain_tool_offset() {
    constexpr int G43 = 430, G49 = 490;
    if (!settings_.isToolOffsetRetained || state.tool_offset_code == G49) {
        return;
    }
    const bool isNone = state.tool_in_spindle == 0;
    apply_tool_offset(isNone ? Pose{} : scale_lengths(state.loaded_offset, machine_to_program()),
                      isNone ? G49 : G43);
}

bool Executor::do_tool_number(const Code &, const BlockValues &values) {
    int toolno = 0, index = 0;
    if (!whole_word(values, 'q', toolno)) {
        return false;
    }
    if (toolno < 0) {
        return fault.set("Need non-negative Q-word to specify tool number with M61", values.column_of('q'));
    }
    const bool isNone = toolno == 0 && !tools_.isRandom();
    if (!isNone && !find_tool(toolno, values.column_of('q'), index)) {
        return false;
    }
    canon.take(ChangeToolNumber{toolno});
    load_tool(index);
    retain_tool_offset();
    return true;
}

void Executor::apply_tool_offset(const Pose &offset, int code) {
    Frame made = frame();
    made.tool = offset;
    change_frame(made);
    state.tool_offset_code = code;
    canon.take(UseToolLengthOffset{offset});
}

/// G43 (from the table), G43.1 (from the words), G43.2 (on top of what is there), G49 (none).
bool Executor::do_tool_offset(const Code &code, const BlockValues &values) {
    if (code.number == 490) {
        apply_tool_offset({}, code.number);
        return true;
    }
    Pose offset = code.number == 430 ? Pose{} : state.tool_offset;
    if (code.number == 432 && values.hasAxes() && values.has('h')) {
        return fault.set("G43.2: Can not have both H and axis words", values.column_of('h'));
    }
    if (code.number != 430 && values.hasAxes() && !values.has('h')) {
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            const char name = geom::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
                const double given = values.at(name) * (isHalved ? 0.5 : 1.0);
                offset[axis] = code.number == 432 ? offset[axis] + given : given;
            }
        }
        apply_tool_offset(offset, code.number);
        return true;
    }
    if (code.number == 431) {
        apply_tool_offset(offset, code.number);
        return true;
    }
    if (code.number == 432 && !values.has('h')) {
        return fault.set("G43.2: No axes specified and H word missing");
    }
    Pose table = state.loaded_offset;
    if (values.has('h')) {
        int toolno = 0, index = 0;
        if (!whole_word(values, 'h', toolno)) {
            return false;
        }
        if (toolno < 0) {
            return fault.set("Negative tool number: H must be 0 or more", values.column_of('h'));
        }
        if (toolno == 0 && code.number == 430) {
            table = state.loaded_offset;
        } else if (!find_tool(toolno, values.column_of('h'), index)) {
            return false;
        } else {
            table = tool_table_.entry(index).offset;
        }
    }
    apply_tool_offset(offset + scale_lengths(table, machine_to_program()), code.number);
    return true;
}

/// The offset that makes the place where the tool is read as the programmed words.
void Executor::set_tool_axes(int l, const BlockValues &values, Pose &offset) const {
    const double factor = machine_to_program();
    Frame plain = frame();
    if (l == 11) {  // relative to the fixture G59.3, without G92
        constexpr int FIXTURE = 8;
        plain.g5x = parameter_pose(P_G5X + 20 * FIXTURE);
        plain.rotation_deg = parameters.get(P_G5X + 20 * FIXTURE + 9);
        plain.g92 = {};
    }
    const Pose machine = frame().to_machine(state.position);
    Frame bare = plain;
    bare.tool = {};
    // Where the axes not named would be read with the offset that the table has now.
    Frame tabled = plain;
    tabled.tool = scale_lengths(offset, factor);
    Pose wanted = tabled.to_program(machine);
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
            wanted[axis] = values.at(name) * (isHalved ? 0.5 : 1.0);
        }
    }
    offset = scale_lengths(machine - bare.to_machine(wanted), 1.0 / factor);
}

bool Executor::set_tool_data(int l, const BlockValues &values) {
    int toolno = 0, index = 0;
    if (!values.has('p')) {
        return fault.set(fmt::format("G10 L{} needs P, the number of the tool", l));
    }
    if (!whole_word(values, 'p', toolno) || !find_tool(toolno, values.column_of('p'), index)) {
        return false;
    }
    const bool hasData =
        values.hasAxes() || values.has('r') || values.has('i') || values.has('j') || values.has('q');
    if (!hasData) {
        return fault.set(fmt::format("G10 L{} needs what it is to set: axis words, R, I, J or Q", l));
    }
    const double to_machine = 1.0 / machine_to_program();
    ToolEntry entry = tool_table_.entry(index);
    if (l == 1) {
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            const char name = geom::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
                const double scale = geom::isAngular(axis) ? 1.0 : to_machine;
                entry.offset[axis] = values.at(name) * scale * (isHalved ? 0.5 : 1.0);
            }
        }
    } else if (values.hasAxes()) {
        set_tool_axes(l, values, entry.offset);
    }
    entry.diameter = values.has('r') ? 2.0 * values.at('r') * to_machine : entry.diameter;
    entry.frontangle = values.at('i', entry.frontangle);
    entry.backangle = values.at('j', entry.backangle);
    if (values.has('q')) {
        if (!whole_word(values, 'q', entry.orientation)) {
            return false;
        }
        if (entry.orientation < 0 || entry.orientation > 9) {
            return fault.set("The orientation Q of a tool must be 0 to 9", values.column_of('q'));
        }
    }
    put_tool_entry(index, entry);
    if (index == state.tool_index) {
        put_tool_entry(0, entry);
        const int was = state.tool_in_spindle;
        load_tool(index);
        state.tool_in_spindle = was;
    }
    return true;
}

/// G10 L0.
bool Executor::reload_tools() {
    if (state.tool_in_spindle > 0) {
        return fault.set(fmt::format("G10 L0 not allowed with loaded tool <{}>", state.tool_in_spindle));
    }
    canon.take(ReloadTools{});
    outcome = Outcome::SYNC;
    return true;
}

bool Executor::do_g10(const Code &, const BlockValues &values) {
    int l = 0;
    if (!whole_word(values, 'l', l)) {
        return false;
    }
    switch (l) {
    case 0: return reload_tools();
    case 1:
    case 10:
    case 11: return set_tool_data(l, values);
    case 2:
    case 20: return set_coordinate_system(l, values);
    default: break;
    }
    return fault.set("Line with G10 does not have L0, L1, L2, L10, L11 or L20", values.column_of('l'));
}

}  // namespace mw::interp::detail
