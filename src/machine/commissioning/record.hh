// SPDX-License-Identifier: GPL-2.0-or-later
// What the steps have found: the content of the report.
#pragma once

#include <string>
#include <vector>

#include "machine/setup/questions.hh"

namespace mw::commissioning {

enum class Fault {
    NONE,
    MOTOR_NOT_CONNECTED,
    ENCODER_NOT_CONNECTED,
    ENCODER_PHASES_SWAPPED,
    SWITCH_NOT_CONNECTED,
    SWITCH_AT_OTHER_INPUT,
    SWITCH_NOT_REACHED,
    SWITCH_NOT_REPEATABLE,
    ESTOP_NOT_CONNECTED,
    ESTOP_NORMALLY_OPEN,
    NOISE,
    LATE_THREAD,
    STALLED,
    DRIVE,
    SCALE,
    SPINDLE,
    PROBE_NOT_CONNECTED,
    NOT_TUNED,
    VALUE,     ///< what was measured does not fit the other answers
    GIVEN_UP,  ///< the operator could not do what the step needs
    STOPPED,   ///< the machine went off
};

/// "motor not connected".
std::string_view fault_name(Fault fault);
/// What to do about it.
std::string_view fault_remedy(Fault fault);

struct Value {
    std::string name;  ///< "scale"
    double number = 0;
    std::string unit;  ///< "steps/mm"
};

struct Finding {
    std::string step, motor;
    Fault fault = Fault::NONE;
    std::string detail;  ///< "input of Y changed"
    std::vector<Value> values;
    setup::Answers before;  ///< the answers that the step has changed, as they were
    setup::Answers after;   ///< and as they are now
};

}  // namespace mw::commissioning
