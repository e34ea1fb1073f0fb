// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/spindle_moves.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/moves/targets.hh"

namespace mw::gcode::detail {

bool check_pitch(const Machine &machine, const State &state, Fault &fault, int spindle, double pitch,
                 std::uint32_t column) {
    const SpindleState &turning = state.spindles[static_cast<std::size_t>(spindle)];
    if (machine.settings.max_velocity_mm_s <= 0.0 || turning.is_constant_surface) {
        return true;
    }
    constexpr double MM_PER_INCH = 25.4, SECONDS_PER_MINUTE = 60.0;
    const double unit = state.units == LengthUnits::MM ? 1.0 : MM_PER_INCH;
    const double needed = std::fabs(pitch) * unit * turning.speed / SECONDS_PER_MINUTE;
    if (needed <= machine.settings.max_velocity_mm_s) {
        return true;
    }
    return fault.set(fmt::format("A pitch of {:g} at {:g} rev/min needs {:.4g} mm/s; the machine's limit is "
                                 "{:.4g} mm/s",
                                 pitch, turning.speed, needed, machine.settings.max_velocity_mm_s),
                     column, "use a lower spindle speed");
}

bool move_with_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                       CanonQueue &canon, Fault &fault) {
    int spindle = 0;
    const std::string name = code_name(code);
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
        return false;
    }
    if (!values.hasAxes()) {
        return fault.set("All axes missing with motion code");
    }
    if (spindle < 0) {
        return fault.set(fmt::format("{} follows one spindle: $ must not be negative", name),
                         values.column_of('$'));
    }
    if (state.comp.isOn()) {
        return fault.set(fmt::format("Cannot do {} with cutter radius compensation on", name));
    }
    if (state.spindles[static_cast<std::size_t>(spindle)].direction == 0) {
        return fault.set(fmt::format("Spindle not turning in {}", name));
    }
    if (!(values.at('k') > 0.0)) {
        return fault.set(fmt::format("The pitch K of {} must be greater than 0", name), values.column_of('k'),
                         "the end point and the spindle direction make a right-hand or a left-hand thread");
    }
    constexpr double SAME_SPEED = 1.0;
    const double scale = values.at('i', SAME_SPEED);
    if (!(scale > 0.0)) {
        return fault.set(fmt::format("The factor I of {} must be greater than 0", name),
                         values.column_of('i'));
    }
    Pose end;
    const double pitch = values.at('k') * std::max(SAME_SPEED, scale);
    if (!check_pitch(machine, state, fault, spindle, pitch, values.column_of('k')) ||
        !straight_target(values, state, end, fault)) {
        return false;
    }
    state.motion = code.number;
    state.cycle.running = false;
    state.comp.set_exit(false);
    canon.take(StartSpeedFeedSynch{spindle, values.at('k'), false});
    if (code.number == 330) {
        canon.take(StraightFeed{end});
        state.position = end;
    } else {
        canon.take(RigidTap{end[geometry::AXIS_X], end[geometry::AXIS_Y], end[geometry::AXIS_Z], scale});
    }
    canon.take(StopSpeedFeedSynch{});
    return true;
}

}  // namespace mw::gcode::detail
