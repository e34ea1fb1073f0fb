// SPDX-License-Identifier: GPL-2.0-or-later
// A machine as the check and the time estimate of programs (gcode/analysis) need it.
#pragma once

#include "base/geometry/pose.hh"
#include "gcode/analysis/preview.hh"
#include "gcode/analysis/program_check.hh"
#include "gcode/analysis/time_estimate.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// Position of the homed machine; without trivial kinematics, a position within the limits.
geometry::Pose home_position(const MachineConfig &machine);

/// The machine at the start of a program, homed and without a tool; `machine` must outlive it.
gcode::PreviewMachine preview_stand(const MachineConfig &machine);

gcode::TimedMachine timed_machine(const MachineConfig &machine);

/// `machine` must outlive it.
gcode::CheckedMachine checked_machine(const MachineConfig &machine);

}  // namespace mw::machine
