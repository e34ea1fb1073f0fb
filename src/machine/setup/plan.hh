// SPDX-License-Identifier: GPL-2.0-or-later
// The plan of a machine: the parsed answers.
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
    bool home_at_max = false;
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
    bool contacts_closed = false;  ///< contact state of the switches when not actuated
};

struct Plan {
    std::string kind, name;
    bool metric = true, is_stepper = false, is_tool_changed_by_hand = false;
    Switches switches = Switches::NONE;
    Spindle spindle = Spindle::NONE;
    double spindle_max = 0;  ///< [rev/min]; for a hot wire: S for full heat
    double foam_width = 0;   ///< [units]
    std::vector<Axis> axes;
    Stepping stepping;

    int joints() const;
    double fastest() const;  ///< maximum of all axes [units/s]
    double millimetres(double mm) const { return metric ? mm : mm / 25.4; }
};

/// Why an answer is not valid.
struct Fault {
    std::string key, text;
};

struct Planned {
    Plan plan;
    std::vector<Fault> faults;  ///< empty: the plan is valid
};

Planned plan_of(const Answers &given);

}  // namespace mw::setup
