// SPDX-License-Identifier: GPL-2.0-or-later
// Straight moves.
#include <fmt/format.h>

#include "interp/detail/executor.hh"

namespace mw::interp::detail {

/// Where the axis words lead, in program coordinates.
Pose Executor::target(const BlockValues &values) const {
    Pose end = state.position;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            end[axis] = state.isIncremental ? end[axis] + values.at(name) : values.at(name);
        }
    }
    return end;
}

bool Executor::do_straight(const Code &code, const BlockValues &values) {
    if (code.number == 10 && state.feed == 0.0) {
        return fault.set("Cannot do g1 with zero feed rate");
    }
    state.motion = code.number;
    if (!values.hasAxes()) {
        return true;
    }
    const Pose end = target(values);
    if (code.number == 0) {
        canon.straight_traverse(end);
    } else {
        canon.straight_feed(end);
    }
    state.position = end;
    return true;
}

}  // namespace mw::interp::detail
