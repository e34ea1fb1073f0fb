// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/moves.hh"

#include "gcode/interpreter/codes/moves/rotary.hh"
#include "gcode/interpreter/codes/moves/targets.hh"

namespace mw::gcode::detail {
namespace {

/// True for a word of an indexer; check_rotary() ensures that it is the only one.
bool isIndexing(const BlockValues &values, const State &state) {
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        if (state.rotary.isIndexer(axis) && values.has(geometry::AXIS_LETTERS_LOWER[axis])) {
            return true;
        }
    }
    return false;
}

}  // namespace

bool move_straight(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                   Fault &fault) {
    if (code.number == 10 && !check_feed(values, "g1", state, fault)) {
        return false;
    }
    Pose end;
    if (values.hasAxes() && !straight_target(values, state, end, fault)) {
        return false;
    }
    // Without compensation nothing fails after this: see isStateSafe().
    state.motion = code.number;
    state.cycle.running = false;
    if (!values.hasAxes()) {
        return true;
    }
    state.comp.set_exit(false);
    if (state.comp.isOn()) {
        const bool rapid = code.number == 0;
        if (!rapid && state.feed_mode == FeedMode::INVERSE_TIME) {
            send_inverse_time(state, canon, straight_length(end - state.position));
        }
        const CompPlace place{state.position, state.plane, state.units};
        if (!state.comp.move_straight(place, rapid, end, canon, fault)) {
            return false;
        }
        state.position = end;
        return true;
    }
    if (code.number == 0) {
        isIndexing(values, state) ? take_indexing(end, state, canon) : canon.take(StraightTraverse{end});
    } else {
        if (state.feed_mode == FeedMode::INVERSE_TIME) {
            send_inverse_time(state, canon, straight_length(end - state.position));
        }
        canon.take(StraightFeed{end});
    }
    state.position = end;
    return true;
}

bool cancel_motion(const Code &, const BlockValues &, State &state, CanonQueue &canon, Fault &) {
    canon.take(ProgramComment{"interpreter: motion mode set to none"});
    state.motion = MOTION_NONE;
    state.cycle.running = false;
    return true;
}

bool note_machine_coordinates(const Code &, const BlockValues &, State &, CanonQueue &, Fault &) {
    return true;
}

}  // namespace mw::gcode::detail
