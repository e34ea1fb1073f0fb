// SPDX-License-Identifier: GPL-2.0-or-later
// Functions that the HAL files of a machine share: names of the board's terminals, and the list of its
// joints.
#pragma once

#include <string>
#include <vector>

#include "machine/setup/files.hh"
#include "machine/setup/plan.hh"

namespace mw::setup::detail {

/// First lines of a HAL file: the licence, then the purpose of the file.
std::string heading(const std::string &purpose);

/// Calls `act` for each motor with its joint number.
template <class Act>
void each_motor(const Plan &plan, Act act) {
    int joint = 0;
    for (const Axis &axis : plan.axes) {
        for (const Motor &motor : axis.motors) {
            act(axis, motor, joint++);
        }
    }
}

/// "hm2_7i76e.0": the board in HAL.
std::string board_name(const Plan &plan);
/// The pin of an input. It is true while the contact is actuated, if `inverted` matches the contact.
std::string in_pin(const Plan &plan, int number, bool inverted = false);
std::string out_pin(const Plan &plan, int number);
/// Prefix of the step generator or of the PWM output of a motor.
std::string stepgen_name(const Plan &plan, const Motor &motor, int joint);
std::string servo_output_name(const Plan &plan, int channel);
bool hasSimulatedEncoder(const Plan &plan);
/// The step generator of a spindle that takes steps.
std::string spindle_stepgen_name(const Plan &plan);

// hal_text.cc
std::string motion_hal(const Plan &plan);
std::string tool_change_hal(const Plan &plan);
/// The order of the functions, in the last file of the machine.
std::string threads_hal(const Plan &plan);
// hal_motors.cc
std::string board_hal(const Plan &plan);
std::string motors_hal(const Plan &plan);
std::string switches_hal(const Plan &plan);
// hal_devices.cc
std::string spindle_hal(const Plan &plan);
std::string torch_hal(const Plan &plan);
std::string coolant_hal(const Plan &plan);
std::string estop_hal(const Plan &plan);
std::string probe_hal(const Plan &plan);
std::string pendant_hal(const Plan &plan);
// hal_simulated.cc
std::string simulated_motors_hal(const Plan &plan);
std::string simulated_switches_hal(const Plan &plan);
std::string simulated_spindle_hal(const Plan &plan);
std::string simulated_wires_hal(const Plan &plan);
std::string simulated_board_hal(const Plan &plan);
/// Motors and switches of a simulated Mesa board, as hm2-board reads them.
std::string simulated_motors_text(const Plan &plan);

inline constexpr const char *MOTORS_FILE = "simulated_motors.txt";

}  // namespace mw::setup::detail
