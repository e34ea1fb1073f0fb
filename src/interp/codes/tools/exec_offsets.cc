// SPDX-License-Identifier: GPL-2.0-or-later
// Coordinate systems, G52 and G92, and the reference points G28 and G30.
#include <cmath>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {

Pose Executor::parameter_pose(int first) const {
    Pose pose;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        pose[axis] = parameters.get(first + axis);
    }
    return scale_lengths(pose, machine_to_program());
}

void Executor::set_parameter_pose(int first, const Pose &pose) {
    const Pose machine = scale_lengths(pose, 1.0 / machine_to_program());
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        if (parameters.get(first + axis) != machine[axis]) {
            parameters.set(first + axis, machine[axis]);
        }
    }
}

/// The machine stays where it is; its place is read in the new frame.
void Executor::change_frame(const Frame &made) {
    const Pose machine = frame().to_machine(state.position);
    state.g5x = made.g5x;
    state.g92 = made.g92;
    state.tool_offset = made.tool;
    state.rotation_deg = made.rotation_deg;
    state.position = made.to_program(machine);
}

void Executor::send_coordinates() {
    canon.take(SetG5xOffset{state.g5x_index, state.g5x});
    canon.take(SetXyRotation{state.rotation_deg});
}

/// G54 to G59.3.
bool Executor::do_coordinates(const Code &code, const BlockValues &) {
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot change coordinate systems while cutter radius compensation is on");
    }
    constexpr int G54 = 540, G59 = 590;
    const int index = code.number < G59 ? (code.number - G54) / 10 + 1 : 6 + code.number - G59;
    if (index == state.g5x_index) {
        canon.take(ProgramComment{"interpreter: continuing to use same coordinate system"});
        return true;
    }
    Frame made = frame();
    const int first = P_G5X + 20 * (index - 1);
    made.g5x = parameter_pose(first);
    made.rotation_deg = parameters.get(first + 9);
    change_frame(made);
    state.g5x_index = index;
    parameters.set(P_COORDINATE_SYSTEM, index);
    canon.take(SetG5xOffset{state.g5x_index, state.g5x});
    canon.take(SetG92Offset{state.g92});
    canon.take(SetXyRotation{state.rotation_deg});
    return true;
}

/// G10 L2 (the origin's place in the machine) and L20 (what the present place is to be called).
bool Executor::set_coordinate_system(int l, const BlockValues &values) {
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
    if (!whole_word(values, 'p', index)) {
        return false;
    }
    if (index < 0 || index > 9) {
        return fault.set(fmt::format("P value out of range (0-9) with G10 L{}", l), values.column_of('p'));
    }
    index = index == 0 ? state.g5x_index : index;
    const bool isActive = index == state.g5x_index;
    if (isActive && state.comp != CompSide::OFF) {
        return fault.set("Cannot change the active coordinate system while cutter radius compensation is on");
    }
    const int first = P_G5X + 20 * (index - 1);
    Frame made = frame();
    made.g5x = parameter_pose(first);
    made.rotation_deg = values.has('r') ? values.at('r') : parameters.get(first + 9);
    const Pose machine = frame().to_machine(state.position);
    Pose wanted = made.to_program(machine);
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (!values.has(name)) {
            continue;
        }
        const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
        const double given = values.at(name) * (isHalved ? 0.5 : 1.0);
        (l == 2 ? made.g5x : wanted)[axis] = given;
    }
    if (l == 20) {
        made.g5x = {};
        made.g5x = machine - made.to_machine(wanted);
    }
    set_parameter_pose(first, made.g5x);
    parameters.set(first + 9, made.rotation_deg);
    if (!isActive) {
        canon.take(ProgramComment{"interpreter: setting coordinate system origin"});
        return true;
    }
    change_frame(made);
    send_coordinates();
    return true;
}

/// G92 and G52 with axis words.
bool Executor::set_g92(const BlockValues &values) {
    Frame made = frame();
    const Pose machine = frame().to_machine(state.position);
    Frame none = made;
    none.g92 = {};
    const Pose place = none.to_program(machine);
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
            made.g92[axis] = place[axis] - values.at(name) * (isHalved ? 0.5 : 1.0);
        }
    }
    change_frame(made);
    return true;
}

bool Executor::do_g92(const Code &code, const BlockValues &values) {
    if (state.comp != CompSide::OFF && code.number != 921) {
        return fault.set("Cannot change axis offsets while cutter radius compensation is on");
    }
    Frame made = frame();
    const bool isSetting = code.number == 920 || code.number == 520;
    if (isSetting && !values.hasAxes()) {
        return fault.set("All axes missing with g92 or g52: at least one axis word is needed");
    }
    if (code.number == 520) {
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            const char name = geom::AXIS_LETTERS_LOWER[axis];
            if (values.has(name)) {
                const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
                made.g92[axis] = values.at(name) * (isHalved ? 0.5 : 1.0);
            }
        }
        change_frame(made);
    } else if (code.number == 920) {
        if (!set_g92(values)) {
            return false;
        }
    } else {
        made.g92 = code.number == 923 ? parameter_pose(P_G92) : Pose{};
        change_frame(made);
    }
    if (isSetting) {
        set_parameter_pose(P_G92, state.g92);
    } else if (code.number == 921) {
        set_parameter_pose(P_G92, {});
    }
    parameters.set(P_G92_APPLIED, isSetting || code.number == 923 ? 1.0 : 0.0);
    canon.take(SetG92Offset{state.g92});
    return true;
}

/// G28 and G30: by way of the programmed place to the stored one; .1 stores.
bool Executor::do_reference(const Code &code, const BlockValues &values) {
    const int first = code.number < 300 ? P_G28 : P_G30;
    if (code.number % 10 == 1) {
        if (values.hasAxes()) {
            return fault.set("G28.1 and G30.1 store the present place: axis words are not allowed");
        }
        set_parameter_pose(first, frame().to_machine(state.position));
        return true;
    }
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot go to a reference point while cutter radius compensation is on");
    }
    const Pose by_way = target(values);
    const Pose stored = frame().to_program(parameter_pose(first));
    Pose end = by_way;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        if (values.has(geom::AXIS_LETTERS_LOWER[axis]) || !values.hasAxes()) {
            end[axis] = stored[axis];
        }
    }
    canon.take(StraightTraverse{by_way});
    canon.take(StraightTraverse{end});
    state.position = end;
    return true;
}

}  // namespace mw::interp::detail
