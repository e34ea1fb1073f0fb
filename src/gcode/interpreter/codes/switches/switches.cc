// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/switches/switches.hh"

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/scripts/user_codes.hh"

namespace mw::gcode::detail {

bool switch_coolant(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &) {
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

bool switch_overrides(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault) {
    int spindle = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
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
        for (int i = isAll ? 0 : spindle; i < (isAll ? machine.count_spindles() : spindle + 1); ++i) {
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

bool set_output(const Code &code, const BlockValues &values, State &, CanonQueue &canon, Fault &fault) {
    const bool isAnalog = code.number >= 67;
    const char name = isAnalog ? 'e' : 'p';
    int index = 0;
    if (!whole_word(values, name, index, fault)) {
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

bool wait_for_input(const Code &, const BlockValues &values, Parameters &, Awaited &awaited, State &state,
                    CanonQueue &canon, Fault &fault, Outcome &outcome) {
    const bool isAnalog = values.has('e');
    if (isAnalog == values.has('p')) {
        return fault.set("M66 needs either P, a digital input, or E, an analog one");
    }
    const char name = isAnalog ? 'e' : 'p';
    int index = 0, kind = 0;
    if (!whole_word(values, name, index, fault) ||
        (values.has('l') && !whole_word(values, 'l', kind, fault))) {
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
    if (state.comp.isOn()) {
        return fault.set("Cannot wait for an input with cutter radius compensation on");
    }
    canon.take(WaitInput{index, isAnalog, static_cast<WaitKind>(kind), values.at('q', 0.0)});
    awaited.isInput = true;
    outcome = Outcome::SYNC;
    return true;
}

bool run_user_code(const Code &code, const BlockValues &values, const Machine &machine, State &,
                   CanonQueue &canon, Fault &fault) {
    if (machine.settings.isUserCodeAssumed ||
        !find_user_program(machine.settings.user_m_path, code.number).empty()) {
        constexpr double NOT_GIVEN = -1.0;
        canon.take(UserCode{code.number, values.at('p', NOT_GIVEN), values.at('q', NOT_GIVEN)});
        return true;
    }
    return fault.set(fmt::format("Unknown m code used: M{}", code.number), 0,
                     "no executable program of this name in the folders of USER_M_PATH");
}

bool dwell(const Code &, const BlockValues &values, State &, CanonQueue &canon, Fault &fault) {
    if (!values.has('p')) {
        return fault.set("Dwell time missing with g4");
    }
    if (values.at('p') < 0.0) {
        return fault.set("The dwell time P of G4 must not be negative", values.column_of('p'));
    }
    canon.take(Dwell{values.at('p')});
    return true;
}

}  // namespace mw::gcode::detail
