// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/switches/program_calls.hh"

#include <fmt/format.h>

#include "gcode/interpreter/codes/block_words.hh"
#include "gcode/interpreter/codes/switches/program_end.hh"

namespace mw::gcode::detail {

bool call_or_return(const Code &code, const BlockValues &values, const Machine &machine,
                    const BlockPlace &place, FanucCall &call, Parameters &parameters, State &state,
                    CanonQueue &canon, Fault &fault, Outcome &outcome) {
    if (machine.settings.fanuc_sub_disabled) {
        return fault.set(fmt::format("DISABLE_FANUC_STYLE_SUB set in INI file, but found m{}", code.number));
    }
    if (code.number == 99) {
        if (place.call_level == 0) {
            if (!machine.settings.is_task) {
                return end_program(*find_code('m', 2), values, machine, parameters, state, canon, fault,
                                   outcome);
            }
            outcome = Outcome::RESTART;
            return true;
        }
        outcome = Outcome::RETURN_FANUC;
        return true;
    }
    if (!values.has('p')) {
        return fault.set("Found 'm98' code with no P-word");
    }
    call.count = 1;
    if (!whole_word(values, 'p', call.label, fault) ||
        (values.has('l') && !whole_word(values, 'l', call.count, fault))) {
        return false;
    }
    if (call.count < 0) {
        return fault.set("The number of calls L of M98 must not be negative", values.column_of('l'));
    }
    outcome = Outcome::CALL_FANUC;
    return true;
}

}  // namespace mw::gcode::detail
