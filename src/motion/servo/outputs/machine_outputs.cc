// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/outputs/machine_outputs.hh"

#include <bit>
#include <cmath>
#include <cstdint>

namespace mw::motion {

namespace {

/// Sets `target` to `value`; true if it changes.
bool replace(double &target, double value) noexcept {
    const bool isOther = std::bit_cast<std::uint64_t>(target) != std::bit_cast<std::uint64_t>(value);
    target = value;
    return isOther;
}

}  // namespace

void MachineOutputs::set_digital(int index, bool isOn) noexcept {
    const std::uint64_t bit = std::uint64_t{1} << index;
    digital_ = isOn ? digital_ | bit : digital_ & ~bit;
}

CommandResult MachineOutputs::take(const SetDigitalOutput &command) noexcept {
    if (!hasDigital(command.index)) {
        return {Reason::NO_SUCH_OUTPUT};
    }
    set_digital(command.index, command.isOn);
    return {};
}

CommandResult MachineOutputs::take(const SetAnalogOutput &command) noexcept {
    if (!hasAnalog(command.index)) {
        return {Reason::NO_SUCH_OUTPUT};
    }
    if (!std::isfinite(command.value)) {
        return {Reason::NOT_A_NUMBER};
    }
    analog_[static_cast<std::size_t>(command.index)] = command.value;
    return {};
}

void MachineOutputs::fire(const trajectory::PathEvent &event, bool isStopping) noexcept {
    if (event.isAnalog) {
        double &output = analog_[static_cast<std::size_t>(event.index)];
        const bool isLess = std::abs(event.value) <= std::abs(output) && event.value * output >= 0;
        output = isLess || !isStopping ? event.value : output;
    } else if (event.value == 0 || !isStopping) {
        set_digital(event.index, event.value != 0);
    }
}

void MachineOutputs::fill(const Inputs &in, Outputs &out) const noexcept {
    Status &status = out.status;
    status.digital_in = in.digital_in;
    status.digital_out = digital_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(num_analog_); ++i) {
        const bool isInOther = replace(status.analog_in[i], in.analog_in[i]);
        const bool isOutOther = replace(status.analog_out[i], analog_[i]);
        out.touched |= part_range(status_part::ANALOG_IN, isInOther ? 1 : 0) |
                       part_range(status_part::ANALOG_OUT, isOutOther ? 1 : 0);
    }
}

}  // namespace mw::motion
