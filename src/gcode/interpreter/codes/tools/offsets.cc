// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/offsets.hh"

#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

/// G92 and G52 with axis words.
void shift_to_words(const BlockValues &values, State &state) {
    Frame made = state.frame;
    const Pose in_machine = state.frame.to_machine(state.position);
    Frame none = made;
    none.g92 = {};
    const Pose place = none.to_program(in_machine);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (const std::optional<double> word = axis_word(values, state, axis)) {
            made.g92[axis] = place[axis] - *word;
        }
    }
    change_frame(state, made);
}

}  // namespace

Pose parameter_pose(const Parameters &parameters, int first, double to_program) {
    Pose pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = parameters.get(first + axis);
    }
    return scale_lengths(pose, to_program);
}

void set_parameter_pose(Parameters &parameters, int first, const Pose &pose, double to_program) {
    const Pose in_machine = scale_lengths(pose, 1.0 / to_program);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (parameters.get(first + axis) != in_machine[axis]) {
            parameters.set(first + axis, in_machine[axis]);
        }
    }
}

void change_frame(State &state, const Frame &made) {
    const Pose in_machine = state.frame.to_machine(state.position);
    state.frame = made;
    state.position = made.to_program(in_machine);
}

void send_coordinates(const State &state, CanonQueue &canon) {
    canon.take(SetG5xOffset{state.g5x_index, state.frame.g5x});
    canon.take(SetXyRotation{state.frame.rotation_deg});
}

Pose stored_place(int first, const Pose &before, const State &state, const CodeParts &parts) {
    Pose place = parameter_pose(parts.parameters, first, parts.to_program(state.units));
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        place[axis] = state.rotary.isWrapped(axis) ? unwrapped_place(place[axis], before[axis]) : place[axis];
    }
    return state.frame.to_program(place);
}

Effect use_coordinates(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    const double to_program = parts.to_program(state.units);
    if (state.comp.isOn()) {
        return values.fail("Cannot change coordinate systems while cutter radius compensation is on");
    }
    const int number = number_of(code), g54 = number_of(G(54)), g59 = number_of(G(59));
    const int index = number < g59 ? (number - g54) / 10 + 1 : 6 + number - g59;
    if (index == state.g5x_index) {
        parts.canon.take(ProgramComment{"interpreter: continuing to use same coordinate system"});
        return true;
    }
    Frame made = state.frame;
    const int first = P_G5X + 20 * (index - 1);
    made.g5x = parameter_pose(parts.parameters, first, to_program);
    made.rotation_deg = parts.parameters.get(first + 9);
    change_frame(state, made);
    state.g5x_index = index;
    parts.parameters.set(P_COORDINATE_SYSTEM, index);
    parts.canon.take(SetG5xOffset{state.g5x_index, state.frame.g5x});
    parts.canon.take(SetG92Offset{state.frame.g92});
    parts.canon.take(SetXyRotation{state.frame.rotation_deg});
    return true;
}

Effect shift_axes(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    const double to_program = parts.to_program(state.units);
    if (state.comp.isOn() && code != G(92, 1)) {
        return values.fail("Cannot change axis offsets while cutter radius compensation is on");
    }
    Frame made = state.frame;
    const bool setting = code == G(92) || code == G(52);
    if (setting && !values.hasAxes()) {
        return values.fail("All axes missing with g92 or g52: at least one axis word is needed");
    }
    if (code == G(52)) {
        replace_axes(values, state, made.g92);
        change_frame(state, made);
    } else if (code == G(92)) {
        shift_to_words(values, state);
    } else {
        made.g92 = code == G(92, 3) ? parameter_pose(parts.parameters, P_G92, to_program) : Pose{};
        change_frame(state, made);
    }
    if (setting) {
        set_parameter_pose(parts.parameters, P_G92, state.frame.g92, to_program);
    } else if (code == G(92, 1)) {
        set_parameter_pose(parts.parameters, P_G92, {}, to_program);
    }
    parts.parameters.set(P_G92_APPLIED, setting || code == G(92, 3) ? 1.0 : 0.0);
    parts.canon.take(SetG92Offset{state.frame.g92});
    return true;
}

Effect go_to_reference(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    const double to_program = parts.to_program(state.units);
    const int first = code < G(30) ? P_G28 : P_G30;
    if (number_of(code) % 10 == 1) {
        if (values.hasAxes()) {
            return values.fail("G28.1 and G30.1 store the current position: axis words are not allowed");
        }
        set_parameter_pose(parts.parameters, first, state.frame.to_machine(state.position), to_program);
        return true;
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot go to a reference point while cutter radius compensation is on");
    }
    const Pose by_way = target(values, state);
    const Pose stored = stored_place(first, state.frame.to_machine(by_way), state, parts);
    Pose end = by_way;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (values.has(geometry::AXIS_LETTERS_LOWER[axis]) || !values.hasAxes()) {
            end[axis] = stored[axis];
        }
    }
    take_rapid(by_way, state, parts.canon);
    take_rapid(end, state, parts.canon);
    return true;
}

}  // namespace mw::gcode::detail
