// SPDX-License-Identifier: GPL-2.0-or-later
// Objects shared by the parts that run programs.
#pragma once

#include "machine/task/control/long_calls.hh"
#include "machine/task/control/program_actions.hh"
#include "machine/task/link/tool_store.hh"
#include "machine/task/run/parameter_file.hh"
#include "machine/task/run/recovery.hh"
#include "machine/task/states/mdi_queue.hh"

namespace mw::task {

/// Each object has its own state; all outlive their users.
struct RunParts {
    const Settings &settings;
    MachinePort &port;
    io::DiscreteIo &io;
    ToolStore &tools;
    MachineWorld &world;
    ProgramReader &reader;
    ProgramRun &run;
    Senders &senders;
    LongCalls &calls;
    ProgramActions &actions;
    Sequencer &sequencer;
    ParameterFile &parameters;
    Recovery &recovery;
    MdiQueue &mdi;

    /// Sets the program's position and state to those of the machine.
    void synch_interpreter() const {
        gcode::MachineSnapshot machine = snapshot_of(port.motion(), io.outputs, sequencer);
        machine.position = reader.canon().exact(machine.position);
        machine.probed_position = machine.isProbeTripped ? machine.probed_position : machine.position;
        world.show(machine);
        reader.synch(machine.position);
    }
    /// Called before the blocks of another run.
    void begin_blocks() const {
        reader.canon().reset();
        sequencer.forget_place();
        reader.begin_codes();
    }
};

}  // namespace mw::task
