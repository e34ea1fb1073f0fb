// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/tools.hh"

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/moves/rotary.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"

namespace mw::gcode::detail {
namespace {

void stop_spindles(const Machine &machine, State &state, CanonQueue &canon) {
    for (int i = 0; i < machine.count_spindles(); ++i) {
        state.spindles[static_cast<std::size_t>(i)].direction = 0;
        canon.take(StopSpindle{i});
    }
}

/// A rapid move that screens need not draw.
void take_hidden_rapid(const Pose &end, State &state, CanonQueue &canon) {
    canon.take(ProgramComment{"AXIS,hide"});
    take_rapid(end, state, canon);
    canon.take(ProgramComment{"AXIS,show"});
}

/// Moves to the tool change position: first up, then across.
void go_to_change(const Machine &machine, const Parameters &parameters, State &state, CanonQueue &canon) {
    if (machine.settings.tool_change.quill_raised) {
        Pose up = state.frame.to_machine(state.position);
        up[geometry::AXIS_Z] = 0;
        take_hidden_rapid(state.frame.to_program(up), state, canon);
    }
    if (machine.settings.tool_change.at_g30) {
        const Pose before = state.frame.to_machine(state.position);
        take_hidden_rapid(stored_place(P_G30, before, machine, parameters, state), state, canon);
    }
}

/// RETAIN_G43: an active offset follows the tool in the spindle and ends with the last one.
void retain_tool_offset(const Machine &machine, State &state, CanonQueue &canon) {
    constexpr int G43 = 430, G49 = 490;
    if (!machine.settings.tool_offset_retained || state.tool.offset_code == G49) {
        return;
    }
    const bool none = state.tool.in_spindle == 0;
    apply_tool_offset(state, canon,
                      none ? Pose{} : scale_lengths(state.tool.offset, machine.to_program(state.units)),
                      none ? G49 : G43);
}

}  // namespace

bool find_tool(const ToolTable &tools, int toolno, std::uint32_t column, int &index, Fault &fault) {
    index = tools.index_of_tool(toolno);
    if (index < 0) {
        return fault.set(fmt::format("Requested tool {} not found in the tool table", toolno), column);
    }
    return true;
}

void load_tool(const ToolTable &tools, ToolModes &tool, int index) {
    const ToolEntry entry = index == 0 && !tools.isRandom() ? ToolEntry{} : tools.entry(index);
    tool.index = index;
    tool.in_spindle = entry.toolno > 0 || tools.isRandom() ? entry.toolno : 0;  // random changer: -1 is empty
    tool.offset = entry.offset;
    tool.diameter = entry.diameter;
    tool.frontangle = entry.frontangle;
    tool.backangle = entry.backangle;
    tool.orientation = entry.orientation;
}

void load_tool_at_index(const ToolTable &tools, ToolModes &tool) {
    const bool in_table = tool.index >= 0 && tool.index < tools.count();
    load_tool(tools, tool, in_table ? tool.index : 0);
}

void move_by_tool_offset(State &state, const Pose &offset) {
    Frame made = state.frame;
    made.tool = offset;
    change_frame(state, made);
}

void apply_tool_offset(State &state, CanonQueue &canon, const Pose &offset, int code) {
    move_by_tool_offset(state, offset);
    state.tool.offset_code = code;
    canon.take(UseToolLengthOffset{offset});
}

bool select_tool(const Code &, const BlockValues &values, const Machine &, ToolTable &tools, State &state,
                 CanonQueue &canon, Fault &fault, Outcome &) {
    int toolno = 0, index = 0;
    if (!whole_word(values, 't', toolno, fault)) {
        return false;
    }
    if (toolno < 0) {
        return fault.set("Negative tool number: T must be 0 or more", values.column_of('t'));
    }
    const bool none = toolno == 0 && !tools.isRandom();
    if (!none && !find_tool(tools, toolno, values.column_of('t'), index, fault)) {
        return false;
    }
    state.tool.selected = toolno;
    state.tool.selected_index = index;
    canon.take(SelectTool{toolno});
    return true;
}

bool change_tool(const Code &, const BlockValues &, const Machine &machine, ToolTable &tools,
                 Parameters &parameters, State &state, CanonQueue &canon, Fault &fault, Outcome &outcome) {
    if (state.comp.isOn()) {
        return fault.set("Cannot change tools while cutter radius compensation is on");
    }
    if (state.tool.selected_index < 0) {
        return fault.set("M6 needs a tool: there was no T word before");
    }
    if (!machine.settings.tool_change.spindle_left_on) {
        stop_spindles(machine, state, canon);
    }
    go_to_change(machine, parameters, state, canon);
    canon.take(ChangeTool{});
    load_tool(tools, state.tool, state.tool.selected_index);
    retain_tool_offset(machine, state, canon);
    outcome = Outcome::SYNC;
    return true;
}

bool set_tool_number(const Code &, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     State &state, CanonQueue &canon, Fault &fault, Outcome &outcome) {
    int toolno = 0, index = 0;
    if (!whole_word(values, 'q', toolno, fault)) {
        return false;
    }
    if (toolno < 0) {
        return fault.set("Need non-negative Q-word to specify tool number with M61", values.column_of('q'));
    }
    const bool none = toolno == 0 && !tools.isRandom();
    if (!none && !find_tool(tools, toolno, values.column_of('q'), index, fault)) {
        return false;
    }
    canon.take(ChangeToolNumber{toolno});
    load_tool(tools, state.tool, index);
    retain_tool_offset(machine, state, canon);
    outcome = tools.isRandom() ? Outcome::SYNC : outcome;  // tools have changed their positions
    return true;
}

bool set_tool_offset(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     State &state, CanonQueue &canon, Fault &fault, Outcome &) {
    if (code.number == 490) {
        apply_tool_offset(state, canon, {}, code.number);
        return true;
    }
    Pose offset = code.number == 430 ? Pose{} : state.frame.tool;
    if (code.number == 432 && values.hasAxes() && values.has('h')) {
        return fault.set("G43.2: Can not have both H and axis words", values.column_of('h'));
    }
    if (code.number != 430 && values.hasAxes() && !values.has('h')) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const char name = geometry::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool halved = axis == geometry::AXIS_X && state.isDiameter;
                const double given = values.at(name) * (halved ? 0.5 : 1.0);
                offset[axis] = code.number == 432 ? offset[axis] + given : given;
            }
        }
        apply_tool_offset(state, canon, offset, code.number);
        return true;
    }
    if (code.number == 431) {
        apply_tool_offset(state, canon, offset, code.number);
        return true;
    }
    if (code.number == 432 && !values.has('h')) {
        return fault.set("G43.2: No axes specified and H word missing");
    }
    Pose table = state.tool.offset;
    if (values.has('h')) {
        int toolno = 0, index = 0;
        if (!whole_word(values, 'h', toolno, fault)) {
            return false;
        }
        if (toolno < 0) {
            return fault.set("Negative tool number: H must be 0 or more", values.column_of('h'));
        }
        if (toolno == 0 && code.number == 430 && !tools.isRandom()) {  // with a random changer T0 is a tool
            table = state.tool.offset;
        } else if (!find_tool(tools, toolno, values.column_of('h'), index, fault)) {
            return false;
        } else {
            table = tools.entry(index).offset;
        }
    }
    apply_tool_offset(state, canon, offset + scale_lengths(table, machine.to_program(state.units)),
                      code.number);
    return true;
}

}  // namespace mw::gcode::detail
