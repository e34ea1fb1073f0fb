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
    const bool on = code.number == 48 || (code.number != 49 && values.at('p', 1.0) != 0.0);
    const bool is_feed = code.number == 48 || code.number == 49 || code.number == 50;
    const bool is_speed = code.number == 48 || code.number == 49 || code.number == 51;
    if (is_feed) {
        state.is_feed_override = on;
        canon.take(SwitchFeedOverride{on});
    }
    if (is_speed) {
        const bool all = !values.has('$') || values.at('$') < 0.0;
        for (int i = all ? 0 : spindle; i < (all ? machine.count_spindles() : spindle + 1); ++i) {
            state.spindles[static_cast<std::size_t>(i)].overridden = on;
            canon.take(SwitchSpeedOverride{i, on});
        }
    }
    if (code.number == 52) {
        state.adaptive = on;
        canon.take(SwitchAdaptiveFeed{on});
    }
    if (code.number == 53) {
        state.is_feed_hold = on;
        canon.take(SwitchFeedHold{on});
    }
    return true;
}

bool set_output(const Code &code, const BlockValues &values, State &, CanonQueue &canon, Fault &fault) {
    const bool analog = code.number >= 67;
    const char name = analog ? 'e' : 'p';
    int index = 0;
    if (!whole_word(values, name, index, fault)) {
        return false;
    }
    const int limit = analog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return fault.set(fmt::format("The number of an output must be 0 to {}", limit - 1),
                         values.column_of(name));
    }
    if (analog) {
        canon.take(SetAnalogOutput{index, values.at('q'), code.number == 67});
    } else {
        canon.take(SetDigitalOutput{index, code.number == 62 || code.number == 64, code.number <= 63});
    }
    return true;
}

bool wait_for_input(const Code &, const BlockValues &values, Parameters &, Awaited &awaited, State &state,
                    CanonQueue &canon, Fault &fault, Outcome &outcome) {
    const bool analog = values.has('e');
    if (analog == values.has('p')) {
        return fault.set("M66 needs either P, a digital input, or E, an analog one");
    }
    const char name = analog ? 'e' : 'p';
    int index = 0, kind = 0;
    if (!whole_word(values, name, index, fault) ||
        (values.has('l') && !whole_word(values, 'l', kind, fault))) {
        return false;
    }
    const int limit = analog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return fault.set(fmt::format("The number of an input must be 0 to {}", limit - 1),
                         values.column_of(name));
    }
    if (kind < 0 || kind > 4) {
        return fault.set("The wait mode L of M66 must be 0 to 4", values.column_of('l'));
    }
    if (analog && kind != 0) {
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
    canon.take(WaitInput{index, analog, static_cast<WaitKind>(kind), values.at('q', 0.0)});
    awaited.is_input = true;
    outcome = Outcome::SYNC;
    return true;
}

bool run_user_code(const Code &code, const BlockValues &values, const Machine &machine, State &,
                   CanonQueue &canon, Fault &fault) {
    if (machine.settings.user_code_assumed ||
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
