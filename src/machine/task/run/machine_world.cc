// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/machine_world.hh"

namespace mw::task {

gcode::MachineSnapshot snapshot_of(const motion::Status &motion, const io::Outputs &io,
                                   const Sequencer &sequencer) {
    gcode::MachineSnapshot s;
    s.position = motion::programmed_position(motion);
    // A probe without contact is treated as stopped at its end.
    s.probed_position = motion.isProbeTripped ? motion.probed_pos : s.position;
    s.isProbeTripped = motion.isProbeTripped;
    s.input_value = sequencer.input().value;
    s.isInputTimedOut = sequencer.input().timed_out;
    s.isMistOn = io.coolant_mist;
    s.isFloodOn = io.coolant_flood;
    s.isFeedOverrideEnabled = motion.isFeedOverrideEnabled;
    s.isFeedHoldEnabled = motion.isFeedHoldEnabled;
    s.isAdaptiveFeedEnabled = motion.isAdaptiveFeedEnabled;
    s.speed_override_enabled = motion.spindle[0].isOverrideEnabled;
    for (std::size_t i = 0; i < s.spindle_speed.size(); ++i) {
        s.spindle_speed[i] = sequencer.spindles().speed(static_cast<int>(i));
        s.spindle_direction[i] = sequencer.spindles().direction(static_cast<int>(i));
    }
    const std::optional<int> fault = sequencer.tool_change().fault_reason();
    s.tool_in_spindle = io.tool_number;
    s.tool_faulted = fault.has_value();
    s.tool_fault_reason = fault.value_or(0);
    s.selected_pocket = sequencer.selected_tool_index();
    return s;
}

}  // namespace mw::task
