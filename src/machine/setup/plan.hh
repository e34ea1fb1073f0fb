// SPDX-License-Identifier: GPL-2.0-or-later
// The plan of a machine, parsed from the answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine/setup/questions.hh"

namespace mw::setup {

/// A terminal of the board; no value: not connected.
using Terminal = std::optional<int>;

/// Data of a drive with a speed command and an encoder. Output and gains are in machine units per second.
struct Servo {
    double counts_per_unit = 0;  ///< negative: the encoder is reversed
    double full_speed = 0;       ///< at 10 V [units/s]; negative: the command is reversed
    double p = 0, i = 0, d = 0, ff1 = 0, ff2 = 0;
};

/// Data of one joint.
struct Motor {
    std::string name;  ///< "y2"
    double travel_per_turn = 0;
    double steps_per_unit = 0;
    Servo servo{};
    double backlash = 0;  ///< [units]
    int channel = 0;      ///< connector of the board: step generator, or servo output with its encoder
    int step_pin = 0, dir_pin = 0;
    Terminal home_pin{};
    bool home_contact_closed = false;  ///< the contact of its switch is closed when not actuated
};

struct Axis {
    char letter = 0;
    double min = 0, max = 0;             ///< [units]
    double speed = 0, acceleration = 0;  ///< [units/s], [units/s2]
    bool home_at_max = false;
    double home_speed = 0;  ///< [units/s]
    std::vector<Motor> motors;

    bool isRotary() const { return letter >= 'A' && letter <= 'C'; }
};

enum class Board : std::uint8_t { NONE, PARPORT, MESA_7I76E, MESA_7I97 };
enum class Switches : std::uint8_t { NONE, HOME, HOME_AND_LIMITS };
enum class Spindle : std::uint8_t { NONE, ON_OFF, SPEED };
enum class SpeedCommand : std::uint8_t { PWM, ANALOG, STEP, MODBUS };

struct SpindleWiring {
    SpeedCommand command = SpeedCommand::PWM;
    double full_output = 0;  ///< [rev/min]
    double pwm_hz = 0, steps_per_turn = 0;
    Terminal on_pin{}, speed_pin{};
    std::string vfd, device;
};

/// Connections of the board, and the generation of steps.
struct Wiring {
    std::string address;       ///< address of the board
    bool isSimulated = false;  ///< the board is simulated
    int step_length_ns = 0, step_space_ns = 0, dir_setup_ns = 0, dir_hold_ns = 0;
    int base_period_ns = 0;  ///< 0: no base thread
    Terminal enable_pin{}, flood_pin{}, mist_pin{}, estop_pin{}, probe_pin{}, torch_pin{}, arc_ok_pin{};
    bool probe_contact_closed = false;
    bool hasWheel = false;
    SpindleWiring spindle;
};

struct Plan {
    std::string kind, name;
    bool metric = true, is_stepper = false, is_servo = false, is_tool_changed_by_hand = false;
    Board board = Board::NONE;
    Switches switches = Switches::NONE;
    Spindle spindle = Spindle::NONE;
    double spindle_max = 0;  ///< [rev/min]; for a hot wire: S for full heat
    double foam_width = 0;   ///< [units]
    std::vector<Axis> axes;
    Wiring wiring;

    int joints() const;
    double fastest() const;  ///< maximum speed of all linear axes [units/s]
    double millimetres(double mm) const { return metric ? mm : mm / 25.4; }
    /// A length of this many mm for a linear axis, or this many degrees for a rotary axis.
    double small(const Axis &axis, double mm) const { return axis.isRotary() ? mm : millimetres(mm); }
    bool hasBoard() const { return board != Board::NONE; }
    bool hasBaseThread() const { return wiring.base_period_ns > 0; }
};

/// The reason why an answer is not valid.
struct Fault {
    std::string key, text;
};

struct Planned {
    Plan plan;
    std::vector<Fault> faults;  ///< empty if the plan is valid
};

Planned plan_of(const Answers &given);

}  // namespace mw::setup
