// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles: S, M3 to M5, M19, G96 and G97.
#include <cmath>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

/// G96 without D: no limit worth the name [rev/min].
constexpr double UNLIMITED_RPM = 1e30;
constexpr int ALL_SPINDLES = -1;

}  // namespace

/// The word $; spindle 0 without it.
bool Executor::spindle_of(const BlockValues &values, int &spindle) {
    spindle = 0;
    if (!values.has('$')) {
        return true;
    }
    if (!whole_word(values, '$', spindle)) {
        return false;
    }
    if (spindle < ALL_SPINDLES || spindle >= world_.count_spindles()) {
        return fault.set(
            fmt::format("There is no spindle {}: $ may be 0 to {}", spindle, world_.count_spindles() - 1),
            values.column_of('$'));
    }
    return true;
}

bool Executor::do_speed_word(const Code &, const BlockValues &values) {
    const double speed = values.at('s');
    int spindle = 0;
    if (!spindle_of(values, spindle)) {
        return false;
    }
    if (speed < 0.0) {
        return fault.set("Negative spindle speed used", values.column_of('s'));
    }
    for (int i = 0; i < world_.count_spindles(); ++i) {
        if (spindle == i || spindle == ALL_SPINDLES) {
            state.spindles[static_cast<std::size_t>(i)].speed = speed;
            canon.take(SetSpindleSpeed{i, speed});
        }
    }
    return true;
}

bool Executor::do_spindle_mode(const Code &code, const BlockValues &values) {
    int spindle = 0;
    if (!spindle_of(values, spindle)) {
        return false;
    }
    if (spindle == ALL_SPINDLES) {
        return fault.set(fmt::format("{} is for one spindle: $ must not be negative", code_name(code)),
                         values.column_of('$'));
    }
    const bool isConstantSurface = code.number == 960;
    const double limit = values.has('d') ? std::fabs(values.at('d')) : UNLIMITED_RPM;
    state.active_spindle = spindle;  // what canned cycles and G95 go by
    SpindleState &one = state.spindles[static_cast<std::size_t>(spindle)];
    one.isConstantSurface = isConstantSurface;
    one.css_max_rpm = isConstantSurface ? limit : 0.0;
    canon.take(SetSpindleMode{spindle, one.css_max_rpm});
    return true;
}

bool Executor::do_spindle(const Code &code, const BlockValues &values) {
    int spindle = 0;
    if (!spindle_of(values, spindle)) {
        return false;
    }
    const bool isAll = spindle == ALL_SPINDLES;
    for (int i = 0; i < world_.count_spindles(); ++i) {
        if (spindle != i && !isAll) {
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

bool Executor::do_orient(const Code &, const BlockValues &values) {
    int spindle = 0, mode = 0;
    if (!spindle_of(values, spindle) || (values.has('p') && !whole_word(values, 'p', mode))) {
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
    double angle = programmed + settings_.orient_offset_deg;
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

}  // namespace mw::interp::detail
