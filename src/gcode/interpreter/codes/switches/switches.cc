// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/scripts/user_codes.hh"

namespace mw::gcode::detail {

Effect switch_coolant(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    switch (code) {
    case M(7):
        state.isMist = true;
        parts.canon.take(SwitchMist{true});
        break;
    case M(8):
        state.isFlood = true;
        parts.canon.take(SwitchFlood{true});
        break;
    default:
        state.isMist = state.isFlood = false;
        parts.canon.take(SwitchMist{false});
        parts.canon.take(SwitchFlood{false});
        break;
    }
    return true;
}

Effect switch_overrides(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0;
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    spindle = spindle < 0 ? 0 : spindle;
    const bool on = code == M(48) || (code != M(49) && values.at('p', 1.0) != 0.0);
    const bool is_feed = code == M(48) || code == M(49) || code == M(50);
    const bool is_speed = code == M(48) || code == M(49) || code == M(51);
    if (is_feed) {
        state.is_feed_override = on;
        parts.canon.take(SwitchFeedOverride{on});
    }
    if (is_speed) {
        const bool all = !values.has('$') || values.at('$') < 0.0;
        for (int i = all ? 0 : spindle; i < (all ? parts.count_spindles() : spindle + 1); ++i) {
            state.spindles[static_cast<std::size_t>(i)].overridden = on;
            parts.canon.take(SwitchSpeedOverride{i, on});
        }
    }
    if (code == M(52)) {
        state.adaptive = on;
        parts.canon.take(SwitchAdaptiveFeed{on});
    }
    if (code == M(53)) {
        state.is_feed_hold = on;
        parts.canon.take(SwitchFeedHold{on});
    }
    return true;
}

Effect set_output(GCode code, const BlockValues &values, State &, CodeParts &parts) {
    const bool analog = code >= M(67);
    const char name = analog ? 'e' : 'p';
    int index = 0;
    if (!values.whole(name, index)) {
        return false;
    }
    const int limit = analog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return values.fail(fmt::format("The number of an output must be 0 to {}", limit - 1), name);
    }
    if (analog) {
        parts.canon.take(SetAnalogOutput{index, values.at('q'), code == M(67)});
    } else {
        parts.canon.take(SetDigitalOutput{index, code == M(62) || code == M(64), code <= M(63)});
    }
    return true;
}

Effect wait_for_input(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    const bool analog = values.has('e');
    if (analog == values.has('p')) {
        return values.fail("M66 needs either P, a digital input, or E, an analog one");
    }
    const char name = analog ? 'e' : 'p';
    int index = 0, kind = 0;
    if (!values.whole(name, index) || (values.has('l') && !values.whole('l', kind))) {
        return false;
    }
    const int limit = analog ? MAX_ANALOG_IO : MAX_DIGITAL_IO;
    if (index < 0 || index >= limit) {
        return values.fail(fmt::format("The number of an input must be 0 to {}", limit - 1), name);
    }
    if (kind < 0 || kind > 4) {
        return values.fail("The wait mode L of M66 must be 0 to 4", 'l');
    }
    if (analog && kind != 0) {
        return values.fail("Analog inputs cannot wait: only L0 is possible with E", 'l');
    }
    if (values.at('q', 0.0) < 0.0) {
        return values.fail("The timeout Q of M66 must not be negative", 'q');
    }
    if (kind != 0 && values.at('q', 0.0) == 0.0) {
        return values.fail("M66 with L1 to L4 needs a timeout Q above 0 seconds");
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot wait for an input with cutter radius compensation on");
    }
    parts.canon.take(WaitInput{index, analog, static_cast<WaitKind>(kind), values.at('q', 0.0)});
    parts.awaited.is_input = true;
    return Outcome::SYNC;
}

Effect run_user_code(GCode code, const BlockValues &values, State &, CodeParts &parts) {
    if (parts.settings.user_code_assumed ||
        !find_user_program(parts.settings.user_m_path, number_of(code)).empty()) {
        constexpr double NOT_GIVEN = -1.0;
        parts.canon.take(UserCode{number_of(code), values.at('p', NOT_GIVEN), values.at('q', NOT_GIVEN)});
        return true;
    }
    return values.fail(fmt::format("Unknown m code used: M{}", number_of(code)), 0,
                       "no executable program of this name in the folders of USER_M_PATH");
}

Effect dwell(GCode, const BlockValues &values, State &, CodeParts &parts) {
    if (!values.has('p')) {
        return values.fail("Dwell time missing with g4");
    }
    if (values.at('p') < 0.0) {
        return values.fail("The dwell time P of G4 must not be negative", 'p');
    }
    parts.canon.take(Dwell{values.at('p')});
    return true;
}

}  // namespace mw::gcode::detail
