// SPDX-License-Identifier: GPL-2.0-or-later
// The parts in which the machine's status is published, so that frequent readers copy only changed parts.
#pragma once

#include <cstddef>

#include "base/parted_seqlock.hh"
#include "messages/declarations/status.hh"

namespace mw::messages::status_part {

/// TASK: cycle, commands, messages, states and position in the program; PATH: trajectory, probe, overrides,
/// motion with digital inputs and outputs; DEVICES: tool, I/O, the right to operate; APPROACH: approach and
/// recovery.
inline constexpr int TASK = 0, PROGRAM = 1, CODES = 2, OFFSETS = 3, PATH = 4, ANALOG_IN = 5, ANALOG_OUT = 6,
                     JOINTS = 7, AXES = JOINTS + MAX_JOINTS, SPINDLES = AXES + 1,
                     DEVICES = SPINDLES + MAX_SPINDLES, APPROACH = DEVICES + 1, SETTINGS = APPROACH + 1,
                     COUNT = SETTINGS + 1;

inline constexpr PartStarts<COUNT> STARTS = [] {
    PartStarts<COUNT> starts{};
    starts[PROGRAM] = offsetof(MachineStatus, task) + offsetof(TaskStatus, program);
    starts[CODES] = offsetof(MachineStatus, codes);
    starts[OFFSETS] = offsetof(MachineStatus, offsets);
    starts[PATH] = offsetof(MachineStatus, trajectory);
    starts[ANALOG_IN] = offsetof(MachineStatus, motion) + offsetof(MotionStatus, analog_in);
    starts[ANALOG_OUT] = offsetof(MachineStatus, motion) + offsetof(MotionStatus, analog_out);
    for (std::size_t i = 0; i < MAX_JOINTS; ++i) {
        starts[JOINTS + i] = offsetof(MachineStatus, joints) + i * sizeof(JointStatus);
    }
    starts[AXES] = offsetof(MachineStatus, axes);
    for (std::size_t i = 0; i < MAX_SPINDLES; ++i) {
        starts[SPINDLES + i] = offsetof(MachineStatus, spindles) + i * sizeof(SpindleStatus);
    }
    starts[DEVICES] = offsetof(MachineStatus, tool);
    starts[APPROACH] = offsetof(MachineStatus, approach);
    starts[SETTINGS] = offsetof(MachineStatus, settings);
    return starts;
}();

}  // namespace mw::messages::status_part

namespace mw::messages {

using PublishedStatus = PartedSeqlock<MachineStatus, status_part::STARTS>;

}  // namespace mw::messages
