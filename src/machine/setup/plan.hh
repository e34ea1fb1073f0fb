// SPDX-License-Identifier: GPL-2.0-or-later
// A machine as it is wanted: answers that have been understood.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "machine/setup/questions.hh"

namespace mw::setup {

/// Of one joint.
struct Motor {
    std::string name;  ///< "y2"
    double steps_per_unit = 0;
    int step_pin = 0, dir_pin = 0, home_pin = 0;
};

struct Axis {
    char letter = 0;
    double min = 0, max = 0;             ///< [units]
    double speed = 0, acceleration = 0;  ///< [units/s], [units/s2]
    bool isHomeAtMax = false;
    double home_speed = 0;  ///< [units/s]
    std::vector<Motor> motors;
};

enum class Switches : std::uint8_t { NONE, HOME, HOME_AND_LIMITS };
enum class Spindle : std::uint8_t { NONE, ON_OFF, SPEED };

/// Numbers of pins of a parallel port; 0: none.
struct Stepping {
    int step_length_ns = 0, step_space_ns = 0, dir_setup_ns = 0, dir_hold_ns = 0;
    int base_period_ns = 0;
    int enable_pin = 0, spindle_on_pin = 0, spindle_pwm_pin = 0, flood_pin = 0, estop_pin = 0;
    double pwm_hz = 0;
    bool areContactsClosed = false;  ///< of the switches, while nothing touches them
};

struct Plan {
    std::string kind, name;
    bool isMetric = true, isStepper = false, isToolChangedByHand = false;
    Switches switches = Switches::NONE;
    Spindle spindle = Spindle::NONE;
    double spindle_max = 0;  ///< [rev/min]; of a hot wire: S of full heat
    double foam_width = 0;   ///< [units]
    std::vector<Axis> axes;
    Stepping stepping;

    int joints() const;
    double fastest() const;  ///< of all axes [units/s]
    double millimetres(double mm) const { return isMetric ? mm : mm / 25.4; }
};

/// Why an answer cannot be.
struct Fault {
    std::string key, text;
};

struct Planned {
    Plan plan;
    std::vector<Fault> faults;  ///< empty: the plan holds
};

Planned plan_of(const Answers &given);

}  // namespace mw::setup
