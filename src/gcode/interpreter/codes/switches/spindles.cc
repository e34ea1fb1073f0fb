// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/switches/spindles.hh"

#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"

namespace mw::gcode::detail {
namespace {

/// G96 without D: practically no limit [rev/min].
constexpr double UNLIMITED_RPM = 1e30;

}  // namespace

bool set_speed(const Code &, const BlockValues &values, const Machine &machine, State &state,
               CanonQueue &canon, Fault &fault) {
    const double speed = values.at('s');
    int spindle = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
        return false;
    }
    if (speed < 0.0) {
        return fault.set("Negative spindle speed used", values.column_of('s'));
    }
    for (int i = 0; i < machine.count_spindles(); ++i) {
        if (spindle == i || spindle == ALL_SPINDLES) {
            state.spindles[static_cast<std::size_t>(i)].speed = speed;
            canon.take(SetSpindleSpeed{i, speed});
        }
    }
    return true;
}

bool set_spindle_mode(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault) {
    int spindle = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
        return false;
    }
    if (spindle == ALL_SPINDLES) {
        return fault.set(fmt::format("{} is for one spindle: $ must not be negative", code_name(code)),
                         values.column_of('$'));
    }
    const bool is_constant_surface = code.number == 960;
    const double limit = values.has('d') ? std::fabs(values.at('d')) : UNLIMITED_RPM;
    state.active_spindle = spindle;  // the spindle of canned cycles and G95
    SpindleState &one = state.spindles[static_cast<std::size_t>(spindle)];
    one.is_constant_surface = is_constant_surface;
    one.css_max_rpm = is_constant_surface ? limit : 0.0;
    canon.take(SetSpindleMode{spindle, one.css_max_rpm});
    return true;
}

bool turn_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                  CanonQueue &canon, Fault &fault) {
    int spindle = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
        return false;
    }
    const bool all = spindle == ALL_SPINDLES;
    for (int i = 0; i < machine.count_spindles(); ++i) {
        if (spindle != i && !all) {
            continue;
        }
        state.spindles[static_cast<std::size_t>(i)].direction =
            code.number == 3 ? 1 : (code.number == 4 ? -1 : 0);
        switch (code.number) {
        case 3: canon.take(StartSpindle{i, true, true}); break;
        case 4: canon.take(StartSpindle{i, false, true}); break;
        default: canon.take(StopSpindle{i}); break;
        }
    }
    return true;
}

bool orient_spindle(const Code &, const BlockValues &values, const Machine &machine, State &state,
                    CanonQueue &canon, Fault &fault) {
    int spindle = 0, mode = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault) ||
        (values.has('p') && !whole_word(values, 'p', mode, fault))) {
        return false;
    }
    if (spindle == ALL_SPINDLES) {
        return fault.set("M19 orients one spindle: $ must not be negative", values.column_of('$'));
    }
    constexpr double FULL_CIRCLE = 360.0;
    const double programmed = values.at('r', 0.0);
    if (programmed < 0.0 || programmed > FULL_CIRCLE) {
        return fault.set("The angle R of M19 must be 0 to 360 degrees", values.column_of('r'));
    }
    if (mode < 0 || mode > 2) {
        return fault.set("The direction P of M19 must be 0 (shortest), 1 (clockwise) or 2 (counterclockwise)",
                         values.column_of('p'));
    }
    if (values.has('q') && values.at('q') <= 0.0) {
        return fault.set("The timeout Q of M19 must be above 0 seconds", values.column_of('q'));
    }
    double angle = programmed + machine.settings.orient_offset_deg;
    if (values.has('r') || values.has('p')) {
        angle = std::fmod(angle, FULL_CIRCLE);
        angle = angle < 0.0 ? angle + FULL_CIRCLE : angle;
        state.spindles[static_cast<std::size_t>(spindle)].direction = 0;
        canon.take(OrientSpindle{spindle, angle, mode});
    }
    if (values.has('q')) {
        canon.take(WaitOrientComplete{spindle, values.at('q')});
    }
    return true;
}

}  // namespace mw::gcode::detail
