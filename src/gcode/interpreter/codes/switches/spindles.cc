// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"

namespace mw::gcode::detail {
namespace {

/// G96 without D: practically unlimited [rev/min].
constexpr double UNLIMITED_RPM = 1e30;

}  // namespace

Effect set_speed(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    const double speed = values.at('s');
    int spindle = 0;
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    if (speed < 0.0) {
        return values.fail("Negative spindle speed used", 's');
    }
    for (int i = 0; i < parts.count_spindles(); ++i) {
        if (spindle == i || spindle == ALL_SPINDLES) {
            state.spindles[static_cast<std::size_t>(i)].speed = speed;
            parts.canon.take(SetSpindleSpeed{i, speed});
        }
    }
    return true;
}

Effect set_spindle_mode(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0;
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    if (spindle == ALL_SPINDLES) {
        return values.fail(fmt::format("{} is for one spindle: $ must not be negative", code_name(code)),
                           '$');
    }
    const bool is_constant_surface = code == G(96);
    const double limit = values.has('d') ? std::fabs(values.at('d')) : UNLIMITED_RPM;
    state.active_spindle = spindle;  // the spindle of canned cycles and G95
    SpindleState &one = state.spindles[static_cast<std::size_t>(spindle)];
    one.is_constant_surface = is_constant_surface;
    one.css_max_rpm = is_constant_surface ? limit : 0.0;
    parts.canon.take(SetSpindleMode{spindle, one.css_max_rpm});
    return true;
}

Effect turn_spindle(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0;
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    const bool all = spindle == ALL_SPINDLES;
    for (int i = 0; i < parts.count_spindles(); ++i) {
        if (spindle != i && !all) {
            continue;
        }
        state.spindles[static_cast<std::size_t>(i)].direction = code == M(3) ? 1 : (code == M(4) ? -1 : 0);
        switch (code) {
        case M(3): parts.canon.take(StartSpindle{i, true, true}); break;
        case M(4): parts.canon.take(StartSpindle{i, false, true}); break;
        default: parts.canon.take(StopSpindle{i}); break;
        }
    }
    return true;
}

Effect orient_spindle(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0, mode = 0;
    if (!values.spindle(parts.count_spindles(), spindle) || (values.has('p') && !values.whole('p', mode))) {
        return false;
    }
    if (spindle == ALL_SPINDLES) {
        return values.fail("M19 orients one spindle: $ must not be negative", '$');
    }
    constexpr double FULL_CIRCLE = 360.0;
    const double programmed = values.at('r', 0.0);
    if (programmed < 0.0 || programmed > FULL_CIRCLE) {
        return values.fail("The angle R of M19 must be 0 to 360 degrees", 'r');
    }
    if (mode < 0 || mode > 2) {
        return values.fail(
            "The direction P of M19 must be 0 (shortest), 1 (clockwise) or 2 (counterclockwise)", 'p');
    }
    if (values.has('q') && values.at('q') <= 0.0) {
        return values.fail("The timeout Q of M19 must be above 0 seconds", 'q');
    }
    double angle = programmed + parts.settings.orient_offset_deg;
    if (values.has('r') || values.has('p')) {
        angle = std::fmod(angle, FULL_CIRCLE);
        angle = angle < 0.0 ? angle + FULL_CIRCLE : angle;
        state.spindles[static_cast<std::size_t>(spindle)].direction = 0;
        parts.canon.take(OrientSpindle{spindle, angle, mode});
    }
    if (values.has('q')) {
        parts.canon.take(WaitOrientComplete{spindle, values.at('q')});
    }
    return true;
}

}  // namespace mw::gcode::detail
