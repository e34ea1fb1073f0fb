// SPDX-License-Identifier: GPL-2.0-or-later
// A machine as it really is: random values that its owner does not know.
#pragma once

#include <string>
#include <vector>

#include "machine/setup/questions.hh"

namespace mw::commissioning_campaign {

enum class Board { PARPORT, MESA_STEPPER, MESA_SERVO };
enum class Trouble {
    NONE,
    MOTOR_NOT_CONNECTED,
    SWITCH_NOT_CONNECTED,
    ESTOP_NORMALLY_OPEN,
    ENCODER_SWAPPED,
    NOISE,
    LATE_THREAD,
    SWITCHES_EXCHANGED,
    ESTOP_NOT_CONNECTED,
    PROBE_NOT_CONNECTED,
    ENCODER_NOT_CONNECTED,
};

struct TrueAxis {
    char letter = 'X';
    double steps_per_rev = 800;    ///< of a stepper
    double counts_per_rev = 4000;  ///< of a servo
    double travel_per_rev = 5;  ///< of the table; negative: it moves against the shaft and its encoder [mm]
    double lower_end = 0, upper_end = 0;  ///< end stops [mm]
    double start = 0;                     ///< [mm]
    double switch_at = 0;                 ///< [mm]
    bool switch_above = false;            ///< actuated above it
    bool isContactOpening = false;
    double backlash = 0;           ///< [mm]
    double peak_acceleration = 0;  ///< of a stepper [mm/s2]
    double fastest = 0;            ///< of a stepper [mm/s]
    double full_rev_s = 50;        ///< of a servo drive at 10 V; negative: it turns in the other direction
    double lag_s = 0.01;
};

struct TrueMachine {
    unsigned seed = 0;
    Board board = Board::PARPORT;
    Trouble trouble = Trouble::NONE;
    std::size_t trouble_axis = 0;
    std::vector<TrueAxis> axes;
    double spindle_full_rpm = 0;
    bool isProbeOpening = false;
    bool isRaised = false;   ///< the owner also raises speed and acceleration
    setup::Answers answers;  ///< the values that the owner assumes
};

/// Seeds above FIRST_TROUBLE have a fault.
constexpr unsigned FIRST_TROUBLE = 100000;
TrueMachine make_true_machine(unsigned seed);
const char *trouble_name(Trouble trouble);

}  // namespace mw::commissioning_campaign
