// SPDX-License-Identifier: GPL-2.0-or-later
// Digital and analog outputs, set at once by command or synchronized with the path.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

struct MachineOutputs {
    int num_digital = 0, num_analog = 0;
    std::uint64_t digital = 0;  ///< bit per output
    std::array<double, MAX_ANALOG_IO> analog{};
};

CommandResult take(MachineOutputs &outputs, const SetDigitalOutput &command) noexcept;
CommandResult take(MachineOutputs &outputs, const SetAnalogOutput &command) noexcept;
/// An output change whose position on the path has been passed; the path planner has checked its index. While
/// a stop brakes along the path, nothing is switched on and no value grows: only changes that switch
/// something off are done.
void fire(MachineOutputs &outputs, const trajectory::PathEvent &event, bool isStopping) noexcept;
/// Outputs, and the values of the inputs.
void fill(const MachineOutputs &outputs, const Inputs &in, Outputs &out) noexcept;

}  // namespace mw::motion
