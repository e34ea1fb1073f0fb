// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/probes.hh"

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/moves/targets.hh"

namespace mw::gcode::detail {

bool move_probe(const Code &code, const BlockValues &values, Parameters &parameters, Awaited &awaited,
                State &state, CanonQueue &canon, Fault &fault, Outcome &outcome) {
    if (!values.hasAxes()) {
        return fault.set("All axes missing with motion code");
    }
    if (state.comp.isOn()) {
        return fault.set("Cannot probe with cutter radius comp on");
    }
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        return fault.set("Cannot probe in inverse time feed mode");
    }
    if (state.feed == 0.0) {
        return fault.set("Cannot probe with zero feed rate");
    }
    if (!check_feed(values, code_name(code), state, fault)) {
        return false;
    }
    Pose end;
    if (!straight_target(values, state, end, fault)) {
        return false;
    }
    if (end == state.position) {
        return fault.set("Start point too close to probe point");
    }
    state.motion = code.number;
    state.cycle.running = false;
    state.comp.set_exit(false);
    canon.take(StraightProbe{end, static_cast<ProbeKind>(code.number - 382)});
    state.position = end;
    // Until the machine reports the result, assumes the end position without contact.
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        parameters.set(P_PROBE_RESULT + axis, end[axis]);
    }
    parameters.set(P_PROBE_SUCCESS, 0.0);
    awaited.isProbe = true;
    outcome = Outcome::SYNC;
    return true;
}

}  // namespace mw::gcode::detail
