// SPDX-License-Identifier: GPL-2.0-or-later
// The steps of commissioning. Each step shows prompts, and moves at most one joint, slowly, by a limited
// distance, while a button is pressed. The guide switches the machine off after each step.
#pragma once

#include "machine/commissioning/stage.hh"

namespace mw::commissioning {

// check_inputs.cc
Flow<Finding> check_thread(Stage &stage, int joint);
Flow<Finding> check_inputs(Stage &stage, int joint);
Flow<Finding> check_estop(Stage &stage, int joint);
Flow<Finding> check_probe(Stage &stage, int joint);
// check_motor.cc
Flow<Finding> check_direction(Stage &stage, int joint);
Flow<Finding> check_scale(Stage &stage, int joint);
Flow<Finding> measure_backlash(Stage &stage, int joint);
// check_home.cc
Flow<Finding> check_home(Stage &stage, int joint);
Flow<Finding> check_travel(Stage &stage, int joint);
// check_spindle.cc
Flow<Finding> check_spindle(Stage &stage, int joint);
/// Homes while the button is pressed, over at most slightly more than the travel of the joint.
Flow<Fault> home_while_held(Stage &stage, int joint);
/// The counts of the board for the joint at standstill after homing. The joint is then unhomed. Nothing: the
/// board has no such pin, and the machine is off.
Flow<std::optional<double>> counts_at_home(Stage &stage, int joint);
// tune_limits.cc
Flow<Finding> tune_limits(Stage &stage, int joint);
// tune_servo.cc
Flow<Finding> tune_servo(Stage &stage, int joint);

/// A finding without values.
Finding found(const char *step, const Stage &stage, int joint, Fault fault, std::string detail = "");

}  // namespace mw::commissioning
