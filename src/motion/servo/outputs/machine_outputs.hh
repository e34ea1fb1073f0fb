// SPDX-License-Identifier: GPL-2.0-or-later
// Digital and analog outputs, set at once by a command or synchronized with the path.
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

class MachineOutputs {
  public:
    MachineOutputs(int num_digital, int num_analog) noexcept
        : num_digital_(num_digital), num_analog_(num_analog) {}

    CommandResult take(const SetDigitalOutput &command) noexcept;
    CommandResult take(const SetAnalogOutput &command) noexcept;
    /// Sets an output whose position on the path was passed; the path planner has checked its index. While a
    /// stop brakes along the path, nothing is switched on and no value grows: only changes that switch
    /// something off are done.
    void fire(const trajectory::PathEvent &event, bool isStopping) noexcept;
    /// Writes the outputs, and the values of the inputs.
    void fill(const Inputs &in, Outputs &out) const noexcept;

    bool hasDigital(int index) const noexcept { return index >= 0 && index < num_digital_; }
    bool hasAnalog(int index) const noexcept { return index >= 0 && index < num_analog_; }
    /// Bit per output.
    std::uint64_t digital() const noexcept { return digital_; }
    double analog(int index) const noexcept { return analog_[static_cast<std::size_t>(index)]; }

  private:
    void set_digital(int index, bool isOn) noexcept;

    int num_digital_, num_analog_;
    std::uint64_t digital_ = 0;
    std::array<double, MAX_ANALOG_IO> analog_{};
};

}  // namespace mw::motion
