// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/moves.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/code_functions.hh"

namespace mw::gcode::detail {
namespace {

/// True for a word of an indexer; check_rotary() ensures that it is the only axis word.
bool isIndexing(const BlockValues &values, const State &state) {
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        if (state.rotary.isIndexer(axis) && values.has(geometry::AXIS_LETTERS_LOWER[axis])) {
            return true;
        }
    }
    return false;
}

}  // namespace

Effect move_straight(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (code == G(1) && !check_feed(values, "g1", state)) {
        return false;
    }
    Pose end;
    if (values.hasAxes() && !straight_target(values, state, end)) {
        return false;
    }
    // Without compensation nothing can fail after this point, see isStateSafe().
    state.motion = code;
    state.cycle.running = false;
    if (!values.hasAxes()) {
        return true;
    }
    state.comp.set_exit(false);
    if (state.comp.isOn()) {
        const bool rapid = code == G(0);
        if (!rapid && state.feed_mode == FeedMode::INVERSE_TIME) {
            send_inverse_time(state, parts.canon, straight_length(end - state.position));
        }
        const CompPlace place{state.position, state.plane, state.units};
        if (!state.comp.move_straight(place, rapid, end, parts.canon, *values.fault)) {
            return false;
        }
        state.position = end;
        return true;
    }
    if (code == G(0)) {
        isIndexing(values, state) ? take_indexing(end, state, parts.canon)
                                  : parts.canon.take(StraightTraverse{end});
    } else {
        if (state.feed_mode == FeedMode::INVERSE_TIME) {
            send_inverse_time(state, parts.canon, straight_length(end - state.position));
        }
        parts.canon.take(StraightFeed{end});
    }
    state.position = end;
    return true;
}

Effect cancel_motion(GCode, const BlockValues &, State &state, CodeParts &parts) {
    parts.canon.take(ProgramComment{"interpreter: motion mode set to none"});
    state.motion = MOTION_NONE;
    state.cycle.running = false;
    return true;
}

Effect note_machine_coordinates(GCode, const BlockValues &, State &, CodeParts &) {
    return true;
}

bool check_pitch(const BlockValues &values, const CodeParts &parts, const State &state, int spindle,
                 double pitch, char word) {
    const SpindleState &turning = state.spindles[static_cast<std::size_t>(spindle)];
    if (parts.settings.max_velocity_mm_s <= 0.0 || turning.is_constant_surface) {
        return true;
    }
    constexpr double MM_PER_INCH = 25.4, SECONDS_PER_MINUTE = 60.0;
    const double unit = state.units == LengthUnits::MM ? 1.0 : MM_PER_INCH;
    const double needed = std::fabs(pitch) * unit * turning.speed / SECONDS_PER_MINUTE;
    if (needed <= parts.settings.max_velocity_mm_s) {
        return true;
    }
    return values.fail(
        fmt::format("A pitch of {:g} at {:g} rev/min needs {:.4g} mm/s; the machine's limit is "
                    "{:.4g} mm/s",
                    pitch, turning.speed, needed, parts.settings.max_velocity_mm_s),
        word, "use a lower spindle speed");
}

Effect move_with_spindle(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0;
    const std::string name = code_name(code);
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    if (!values.hasAxes()) {
        return values.fail("All axes missing with motion code");
    }
    if (spindle < 0) {
        return values.fail(fmt::format("{} follows one spindle: $ must not be negative", name), '$');
    }
    if (state.comp.isOn()) {
        return values.fail(fmt::format("Cannot do {} with cutter radius compensation on", name));
    }
    if (state.spindles[static_cast<std::size_t>(spindle)].direction == 0) {
        return values.fail(fmt::format("Spindle not turning in {}", name));
    }
    if (!(values.at('k') > 0.0)) {
        return values.fail(fmt::format("The pitch K of {} must be greater than 0", name), 'k',
                           "the sign of K does not set the hand of the thread: the end point and the spindle "
                           "direction set it");
    }
    constexpr double SAME_SPEED = 1.0;
    const double scale = values.at('i', SAME_SPEED);
    if (!(scale > 0.0)) {
        return values.fail(fmt::format("The factor I of {} must be greater than 0", name), 'i');
    }
    Pose end;
    const double pitch = values.at('k') * std::max(SAME_SPEED, scale);
    if (!check_pitch(values, parts, state, spindle, pitch, 'k') || !straight_target(values, state, end)) {
        return false;
    }
    state.motion = code;
    state.cycle.running = false;
    state.comp.set_exit(false);
    parts.canon.take(StartSpeedFeedSynch{spindle, values.at('k'), false});
    if (code == G(33)) {
        parts.canon.take(StraightFeed{end});
        state.position = end;
    } else {
        parts.canon.take(
            RigidTap{end[geometry::AXIS_X], end[geometry::AXIS_Y], end[geometry::AXIS_Z], scale});
    }
    parts.canon.take(StopSpeedFeedSynch{});
    return true;
}

Effect move_probe(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (!values.hasAxes()) {
        return values.fail("All axes missing with motion code");
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot probe with cutter radius comp on");
    }
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        return values.fail("Cannot probe in inverse time feed mode");
    }
    if (state.feed == 0.0) {
        return values.fail("Cannot probe with zero feed rate");
    }
    if (!check_feed(values, code_name(code), state)) {
        return false;
    }
    Pose end;
    if (!straight_target(values, state, end)) {
        return false;
    }
    if (end == state.position) {
        return values.fail("Start point too close to probe point");
    }
    state.motion = code;
    state.cycle.running = false;
    state.comp.set_exit(false);
    parts.canon.take(StraightProbe{end, static_cast<ProbeKind>(number_of(code) - number_of(G(38, 2)))});
    state.position = end;
    // The end position without contact, until the machine reports the result.
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        parts.parameters.set(P_PROBE_RESULT + axis, end[axis]);
    }
    parts.parameters.set(P_PROBE_SUCCESS, 0.0);
    parts.awaited.isProbe = true;
    return Outcome::SYNC;
}

}  // namespace mw::gcode::detail
