// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/offsets.hh"

#include "gcode/interpreter/codes/moves/rotary.hh"
#include "gcode/interpreter/codes/moves/targets.hh"

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
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool halved = axis == geometry::AXIS_X && state.isDiameter;
            made.g92[axis] = place[axis] - values.at(name) * (halved ? 0.5 : 1.0);
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

Pose stored_place(int first, const Pose &before, const Machine &machine, const Parameters &parameters,
                  const State &state) {
    Pose place = parameter_pose(parameters, first, machine.to_program(state.units));
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        place[axis] = state.rotary.isWrapped(axis) ? unwrapped_place(place[axis], before[axis]) : place[axis];
    }
    return state.frame.to_program(place);
}

bool use_coordinates(const Code &code, const BlockValues &, const Machine &machine, Parameters &parameters,
                     State &state, CanonQueue &canon, Fault &fault) {
    const double to_program = machine.to_program(state.units);
    if (state.comp.isOn()) {
        return fault.set("Cannot change coordinate systems while cutter radius compensation is on");
    }
    constexpr int G54 = 540, G59 = 590;
    const int index = code.number < G59 ? (code.number - G54) / 10 + 1 : 6 + code.number - G59;
    if (index == state.g5x_index) {
        canon.take(ProgramComment{"interpreter: continuing to use same coordinate system"});
        return true;
    }
    Frame made = state.frame;
    const int first = P_G5X + 20 * (index - 1);
    made.g5x = parameter_pose(parameters, first, to_program);
    made.rotation_deg = parameters.get(first + 9);
    change_frame(state, made);
    state.g5x_index = index;
    parameters.set(P_COORDINATE_SYSTEM, index);
    canon.take(SetG5xOffset{state.g5x_index, state.frame.g5x});
    canon.take(SetG92Offset{state.frame.g92});
    canon.take(SetXyRotation{state.frame.rotation_deg});
    return true;
}

bool shift_axes(const Code &code, const BlockValues &values, const Machine &machine, Parameters &parameters,
                State &state, CanonQueue &canon, Fault &fault) {
    const double to_program = machine.to_program(state.units);
    if (state.comp.isOn() && code.number != 921) {
        return fault.set("Cannot change axis offsets while cutter radius compensation is on");
    }
    Frame made = state.frame;
    const bool setting = code.number == 920 || code.number == 520;
    if (setting && !values.hasAxes()) {
        return fault.set("All axes missing with g92 or g52: at least one axis word is needed");
    }
    if (code.number == 520) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const char name = geometry::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool halved = axis == geometry::AXIS_X && state.isDiameter;
                made.g92[axis] = values.at(name) * (halved ? 0.5 : 1.0);
            }
        }
        change_frame(state, made);
    } else if (code.number == 920) {
        shift_to_words(values, state);
    } else {
        made.g92 = code.number == 923 ? parameter_pose(parameters, P_G92, to_program) : Pose{};
        change_frame(state, made);
    }
    if (setting) {
        set_parameter_pose(parameters, P_G92, state.frame.g92, to_program);
    } else if (code.number == 921) {
        set_parameter_pose(parameters, P_G92, {}, to_program);
    }
    parameters.set(P_G92_APPLIED, setting || code.number == 923 ? 1.0 : 0.0);
    canon.take(SetG92Offset{state.frame.g92});
    return true;
}

bool go_to_reference(const Code &code, const BlockValues &values, const Machine &machine,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault) {
    const double to_program = machine.to_program(state.units);
    const int first = code.number < 300 ? P_G28 : P_G30;
    if (code.number % 10 == 1) {
        if (values.hasAxes()) {
            return fault.set("G28.1 and G30.1 store the current position: axis words are not allowed");
        }
        set_parameter_pose(parameters, first, state.frame.to_machine(state.position), to_program);
        return true;
    }
    if (state.comp.isOn()) {
        return fault.set("Cannot go to a reference point while cutter radius compensation is on");
    }
    const Pose by_way = target(values, state);
    const Pose stored = stored_place(first, state.frame.to_machine(by_way), machine, parameters, state);
    Pose end = by_way;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (values.has(geometry::AXIS_LETTERS_LOWER[axis]) || !values.hasAxes()) {
            end[axis] = stored[axis];
        }
    }
    take_rapid(by_way, state, canon);
    take_rapid(end, state, canon);
    return true;
}

}  // namespace mw::gcode::detail
