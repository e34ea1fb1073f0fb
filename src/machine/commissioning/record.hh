// SPDX-License-Identifier: GPL-2.0-or-later
// The findings of the steps: the content of the report.
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
    VALUE,     ///< a measured value does not fit the other answers
    GIVEN_UP,  ///< the operator could not do what the step requires
    STOPPED,   ///< the machine was switched off
};

/// "motor not connected".
std::string_view fault_name(Fault fault);
/// Instruction for this fault.
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
    setup::Answers before;  ///< the changed answers with their previous values
    setup::Answers after;   ///< the changed answers with their new values
};

}  // namespace mw::commissioning
