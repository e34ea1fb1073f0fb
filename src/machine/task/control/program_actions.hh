// SPDX-License-Identifier: GPL-2.0-or-later
// Actions of a program other than moves: messages, stops, offsets, planner changes and user M codes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "machine/io/discrete_io.hh"
#include "machine/task/control/machine_port.hh"
#include "machine/task/control/settings.hh"
#include "machine/task/run/machine_world.hh"
#include "machine/task/run/program_reader.hh"
#include "machine/task/run/program_run.hh"
#include "machine/task/run/senders.hh"
#include "machine/task/sequencer/planner_mode.hh"
#include "machine/task/sequencer/user_program.hh"

namespace mw::task {

/// Executes the events of the sequencer, in program order. One thread; does not block.
class ProgramActions {
  public:
    struct Parts {
        const Settings &settings;
        MachinePort &port;
        io::DiscreteIo &io;
        const MachineWorld &world;
        ProgramReader &reader;
        ProgramRun &run;
        const Senders &senders;
        PlannerMode &planner;
    };
    explicit ProgramActions(const Parts &parts)
        : parts_(parts), user_program_(parts.settings.user_program_awaited ? UserProgram::Waits::IN_CALL
                                                                           : UserProgram::Waits::NEVER) {}
    ProgramActions(const ProgramActions &) = delete;
    ProgramActions &operator=(const ProgramActions &) = delete;

    SequencerEvents events();
    /// M0, M1 or M60 in `line`. False: the program does not stop at it.
    bool stop(const gcode::ProgramStop &stop, int line);
    UserProgram &user_program() { return user_program_; }

    struct Stops {
        int line = 0;  ///< line of the last M0, M1 or M60
        std::uint64_t count = 0;
    };
    const Stops &stops() const { return stops_; }
    /// The active offsets, for clients.
    const OffsetsStatus &offsets() const { return offsets_; }
    /// Called once in each cycle without a run: announced offsets are active at once.
    void show_announced_offsets();

  private:
    void use_offsets(const gcode::UseOffsets &item);
    motion::CommandId use_tool_offset(const gcode::UseToolOffset &item);
    std::optional<motion::CommandId> use_planner(const gcode::UsePlanner &item);
    void start_user_code(const gcode::UserCode &item);

    Parts parts_;
    UserProgram user_program_;
    Stops stops_;
    OffsetsStatus offsets_;
};

}  // namespace mw::task
