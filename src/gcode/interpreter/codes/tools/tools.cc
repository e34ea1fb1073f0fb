// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/tools.hh"

#include <cctype>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"

namespace mw::gcode::detail {
namespace {

void stop_spindles(State &state, CodeParts &parts) {
    for (int i = 0; i < parts.count_spindles(); ++i) {
        state.spindles[static_cast<std::size_t>(i)].direction = 0;
        parts.canon.take(StopSpindle{i});
    }
}

/// A rapid move that screens need not draw.
void take_hidden_rapid(const Pose &end, State &state, CanonQueue &canon) {
    canon.take(ProgramComment{"AXIS,hide"});
    take_rapid(end, state, canon);
    canon.take(ProgramComment{"AXIS,show"});
}

/// Moves to the tool change position: first Z, then the other axes.
void go_to_change(State &state, CodeParts &parts) {
    if (parts.settings.tool_change.quill_raised) {
        Pose up = state.frame.to_machine(state.position);
        up[geometry::AXIS_Z] = 0;
        take_hidden_rapid(state.frame.to_program(up), state, parts.canon);
    }
    if (parts.settings.tool_change.at_g30) {
        const Pose before = state.frame.to_machine(state.position);
        take_hidden_rapid(stored_place(P_G30, before, state, parts), state, parts.canon);
    }
}

/// RETAIN_G43: an active offset follows the tool in the spindle and ends with the last one.
void retain_tool_offset(State &state, CodeParts &parts) {
    if (!parts.settings.tool_offset_retained || state.tool.offset_code == G(49)) {
        return;
    }
    const bool none = state.tool.in_spindle == 0;
    apply_tool_offset(state, parts.canon,
                      none ? Pose{} : scale_lengths(state.tool.offset, parts.to_program(state.units)),
                      none ? G(49) : G(43));
}

}  // namespace

bool tool_number(const BlockValues &values, char word, int &toolno) {
    return values.whole(word, toolno) &&
           (toolno >= 0 || values.fail(fmt::format("Negative tool number: {} must be 0 or more",
                                                   static_cast<char>(std::toupper(word))),
                                       word));
}

bool find_tool(const BlockValues &values, char word, int toolno, const ToolTable &tools, int &index) {
    index = tools.index_of_tool(toolno);
    if (index < 0) {
        return values.fail(fmt::format("Requested tool {} not found in the tool table", toolno), word);
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

void apply_tool_offset(State &state, CanonQueue &canon, const Pose &offset, GCode code) {
    move_by_tool_offset(state, offset);
    state.tool.offset_code = code;
    canon.take(UseToolLengthOffset{offset});
}

Effect select_tool(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    int toolno = 0, index = 0;
    if (!tool_number(values, 't', toolno)) {
        return false;
    }
    const bool none = toolno == 0 && !parts.tools.isRandom();
    if (!none && !find_tool(values, 't', toolno, parts.tools, index)) {
        return false;
    }
    state.tool.selected = toolno;
    state.tool.selected_index = index;
    parts.canon.take(SelectTool{toolno});
    return true;
}

Effect change_tool(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    if (state.comp.isOn()) {
        return values.fail("Cannot change tools while cutter radius compensation is on");
    }
    if (state.tool.selected_index < 0) {
        return values.fail("M6 needs a tool: there was no T word before");
    }
    if (!parts.settings.tool_change.spindle_left_on) {
        stop_spindles(state, parts);
    }
    go_to_change(state, parts);
    parts.canon.take(ChangeTool{});
    load_tool(parts.tools, state.tool, state.tool.selected_index);
    retain_tool_offset(state, parts);
    return Outcome::SYNC;
}

Effect set_tool_number(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    int toolno = 0, index = 0;
    if (!values.whole('q', toolno)) {
        return false;
    }
    if (toolno < 0) {
        return values.fail("Need non-negative Q-word to specify tool number with M61", 'q');
    }
    const bool none = toolno == 0 && !parts.tools.isRandom();
    if (!none && !find_tool(values, 'q', toolno, parts.tools, index)) {
        return false;
    }
    parts.canon.take(ChangeToolNumber{toolno});
    load_tool(parts.tools, state.tool, index);
    retain_tool_offset(state, parts);
    // the changer has changed the positions of tools
    return parts.tools.isRandom() ? Outcome::SYNC : Outcome::OK;
}

Effect set_tool_offset(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (code == G(49)) {
        apply_tool_offset(state, parts.canon, {}, code);
        return true;
    }
    Pose offset = code == G(43) ? Pose{} : state.frame.tool;
    if (code == G(43, 2) && values.hasAxes() && values.has('h')) {
        return values.fail("G43.2: Can not have both H and axis words", 'h');
    }
    if (code == G(43, 1) || (code == G(43, 2) && !values.has('h'))) {
        if (code == G(43, 2) && !values.hasAxes()) {
            return values.fail("G43.2: No axes specified and H word missing");
        }
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            if (const std::optional<double> word = axis_word(values, state, axis)) {
                offset[axis] = code == G(43, 2) ? offset[axis] + *word : *word;
            }
        }
        apply_tool_offset(state, parts.canon, offset, code);
        return true;
    }
    Pose table = state.tool.offset;
    if (values.has('h')) {
        int toolno = 0, index = 0;
        if (!tool_number(values, 'h', toolno)) {
            return false;
        }
        if (toolno != 0 || code != G(43) || parts.tools.isRandom()) {  // with a random changer T0 is a tool
            if (!find_tool(values, 'h', toolno, parts.tools, index)) {
                return false;
            }
            table = parts.tools.entry(index).offset;
        }
    }
    apply_tool_offset(state, parts.canon, offset + scale_lengths(table, parts.to_program(state.units)), code);
    return true;
}

}  // namespace mw::gcode::detail
