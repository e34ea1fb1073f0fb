// SPDX-License-Identifier: GPL-2.0-or-later
// Coolant, overrides, outputs and inputs, dwell, stops and the end.
#include <fmt/format.h>

#include "interp/codes/executor.hh"
#include "interp/scripts/user_codes.hh"

namespace mw::interp::detail {

bool Executor::do_coolant(const Code &code, const BlockValues &) {
    switch (code.number) {
    case 7:
        state.isMist = true;
        canon.take(SwitchMist{true});
        break;
    case 8:
        state.isFlood = true;
        canon.take(SwitchFlood{true});
        break;
    default:
        state.isMist = state.isFlood = false;
        canon.take(SwitchMist{false});
        canon.take(SwitchFlood{false});
        break;
    }
    return true;
}

/// M48 to M53: P0 switches off.
bool Executor::do_override(const Code &code, const BlockValues &values) {
    int spindle = 0;
    if (!spindle_of(values, spindle)) {
        return false;
    }
    spindle = spindle < 0 ? 0 : spindle;
    const bool isOn = code.number == 48 || (code.number != 49 && values.at('p', 1.0) != 0.0);
    const bool isFeed = code.number == 48 || code.number == 49 || code.number == 50;
    const bool isSpeed = code.number == 48 || code.number == 49 || code.number == 51;
    if (isFeed) {
        state.isFeedOverride = isOn;
        canon.take(SwitchFeedOverride{isOn});
    }
    if (isSpeed) {
        const bool isAll = !values.has('$') || values.at('$') < 0.0;
        for (int i = isAll ? 0 : spindle; i < (isAll ? world_.count_spindles() : spindle + 1); ++i) {
            state.spindles[static_cast<std::size_t>(i)].isOverridden = isOn;
            canon.take(SwitchSpeedOverride{i, isOn});
        }
    }
    if (code.number == 52) {
        state.isAdaptive = isOn;
        canon.take(SwitchAdaptiveFeed{isOn});
    }
    if (code.number == 53) {
        state.isFeedHold = isOn;
        canon.take(SwitchFeedHold{isOn});
    }
    return true;
}

/// M62 to M65 (digital) and M67, M68 (analog).
bool Executor::do_output(const Code &code, const BlockValues &values) {
    const bool isAnalog = code.number >= 67;
    const char name = isAnalog ? 'e' : 'p';
    int index = 0;
    if (!whole_word(values, name, index)) {
        return false;
    }
    const int limit = isAnalog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return fault.set(fmt::format("The number of an output must be 0 to {}", limit - 1),
                         values.column_of(name));
    }
    if (isAnalog) {
        canon.take(SetAnalogOutput{index, values.at('q'), code.number == 67});
    } else {
        canon.take(SetDigitalOutput{index, code.number == 62 || code.number == 64, code.number <= 63});
    }
    return true;
}

bool Executor::do_wait_input(const Code &, const BlockValues &values) {
    const bool isAnalog = values.has('e');
    if (isAnalog == values.has('p')) {
        return fault.set("M66 needs either P, a digital input, or E, an analog one");
    }
    const char name = isAnalog ? 'e' : 'p';
    int index = 0, kind = 0;
    if (!whole_word(values, name, index) || (values.has('l') && !whole_word(values, 'l', kind))) {
        return false;
    }
    const int limit = isAnalog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return fault.set(fmt::format("The number of an input must be 0 to {}", limit - 1),
                         values.column_of(name));
    }
    if (kind < 0 || kind > 4) {
        return fault.set("The wait mode L of M66 must be 0 to 4", values.column_of('l'));
    }
    if (isAnalog && kind != 0) {
        return fault.set("An analog input is read at once: only L0 is possible with E",
                         values.column_of('l'));
    }
    if (values.at('q', 0.0) < 0.0) {
        return fault.set("The timeout Q of M66 must not be negative", values.column_of('q'));
    }
    if (kind != 0 && values.at('q', 0.0) == 0.0) {
        return fault.set("M66 that waits needs a timeout Q above 0 seconds");
    }
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot wait for an input with cutter radius compensation on");
    }
    canon.take(WaitInput{index, isAnalog, static_cast<WaitKind>(kind), values.at('q', 0.0)});
    awaited.isInput = true;
    outcome = Outcome::SYNC;
    return true;
}

/// M100 to M199: a program of that name in one of the folders for them.
bool Executor::do_user(const Code &code, const BlockValues &values) {
    if (settings_.isUserCodeAssumed || !find_user_program(settings_, code.number).empty()) {
        constexpr double NOT_GIVEN = -1.0;
        canon.take(UserCode{code.number, values.at('p', NOT_GIVEN), values.at('q', NOT_GIVEN)});
        return true;
    }
    return fault.set(fmt::format("Unknown m code used: M{}", code.number), 0,
                     "no executable program of this name in the folders of USER_M_PATH");
}

bool Executor::do_dwell(const Code &, const BlockValues &values) {
    if (!values.has('p')) {
        return fault.set("Dwell time missing with g4");
    }
    if (values.at('p') < 0.0) {
        return fault.set("The dwell time P of G4 must not be negative", values.column_of('p'));
    }
    canon.take(Dwell{values.at('p')});
    return true;
}

bool Executor::do_stop(const Code &code, const BlockValues &) {
    if (code.number == 60) {
        canon.take(PalletShuttle{});
    }
    if (code.number == 1) {
        canon.take(ProgramStop{true});
    } else {
        canon.take(ProgramStop{});
    }
    return true;
}

/// What M2 and M30 put back: facts of the manual's "Program Stop and Program End".
void Executor::restore_modes_at_end() {
    state.comp = CompSide::OFF;
    state.comp_code = 400;
    state.comp_last = {};
    state.isCompExit = false;
    Frame made = frame();
    if (!settings_.isCoordinateSystemKept) {
        made.g5x = parameter_pose(P_G5X);
        made.rotation_deg = parameters.get(P_G5X + 9);
        change_frame(made);
        state.g5x_index = 1;
        parameters.set(P_COORDINATE_SYSTEM, 1.0);
    }
    send_coordinates();
    if (state.plane != Plane::XY) {
        state.plane = Plane::XY;
        canon.take(SelectPlane{state.plane});
    }
    state.isIncremental = false;
    state.feed_mode = FeedMode::UNITS_PER_MINUTE;
    canon.take(SetFeedMode{0, state.feed_mode});
    state.feed = 0.0;
    canon.take(SetFeedRate{0.0});
    if (!state.isFeedOverride) {
        state.isFeedOverride = true;
        canon.take(SwitchFeedOverride{true});
    }
    for (int i = 0; i < world_.count_spindles(); ++i) {
        SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        if (!spindle.isOverridden) {
            canon.take(SwitchSpeedOverride{i, true});
        }
        const double speed = spindle.speed;
        spindle = {};
        spindle.speed = speed;
        canon.take(StopSpindle{i});
        canon.take(SetSpindleMode{i, 0.0});
    }
    state.motion = 10;
    if (settings_.isG92PersistenceDisabled) {
        made = frame();
        made.g92 = {};
        change_frame(made);
        set_parameter_pose(P_G92, {});
        parameters.set(P_G92_APPLIED, 0.0);
        canon.take(SetG92Offset{});
    }
    if (state.isMist) {
        state.isMist = false;
        canon.take(SwitchMist{false});
    }
    if (state.isFlood) {
        state.isFlood = false;
        canon.take(SwitchFlood{false});
    }
}

bool Executor::do_end(const Code &code, const BlockValues &) {
    restore_modes_at_end();
    if (code.number == 30) {
        canon.take(PalletShuttle{});
    }
    canon.take(ProgramEnd{});
    outcome = Outcome::PROGRAM_END;
    return true;
}

}  // namespace mw::interp::detail
