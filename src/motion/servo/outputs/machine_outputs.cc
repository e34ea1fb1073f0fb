// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/outputs/machine_outputs.hh"

#include <bit>
#include <cmath>
#include <cstdint>

namespace mw::motion {

namespace {

void set_digital(MachineOutputs &outputs, int index, bool isOn) noexcept {
    const std::uint64_t bit = std::uint64_t{1} << index;
    outputs.digital = isOn ? outputs.digital | bit : outputs.digital & ~bit;
}

/// Sets `place` to `value`; true if it changes.
bool replace(double &place, double value) noexcept {
    const bool isOther = std::bit_cast<std::uint64_t>(place) != std::bit_cast<std::uint64_t>(value);
    place = value;
    return isOther;
}

}  // namespace

CommandResult take(MachineOutputs &outputs, const SetDigitalOutput &command) noexcept {
    if (command.index < 0 || command.index >= outputs.num_digital) {
        return {Reason::NO_SUCH_OUTPUT};
    }
    set_digital(outputs, command.index, command.isOn);
    return {};
}

CommandResult take(MachineOutputs &outputs, const SetAnalogOutput &command) noexcept {
    if (command.index < 0 || command.index >= outputs.num_analog) {
        return {Reason::NO_SUCH_OUTPUT};
    }
    if (!std::isfinite(command.value)) {
        return {Reason::NOT_A_NUMBER};
    }
    outputs.analog[static_cast<std::size_t>(command.index)] = command.value;
    return {};
}

void fire(MachineOutputs &outputs, const trajectory::PathEvent &event, bool isStopping) noexcept {
    if (event.isAnalog) {
        double &output = outputs.analog[static_cast<std::size_t>(event.index)];
        const bool isLess = std::abs(event.value) <= std::abs(output) && event.value * output >= 0;
        output = isLess || !isStopping ? event.value : output;
    } else if (event.value == 0 || !isStopping) {
        set_digital(outputs, event.index, event.value != 0);
    }
}

void fill(const MachineOutputs &outputs, const Inputs &in, Outputs &out) noexcept {
    Status &status = out.status;
    status.digital_in = in.digital_in;
    status.digital_out = outputs.digital;
    for (std::size_t i = 0; i < static_cast<std::size_t>(outputs.num_analog); ++i) {
        const bool isInOther = replace(status.analog_in[i], in.analog_in[i]);
        const bool isOutOther = replace(status.analog_out[i], outputs.analog[i]);
        out.touched |= part_range(status_part::ANALOG_IN, isInOther ? 1 : 0) |
                       part_range(status_part::ANALOG_OUT, isOutOther ? 1 : 0);
    }
}

}  // namespace mw::motion
