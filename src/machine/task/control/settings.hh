// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of task, and the pins that it reads and writes.
#pragma once

#include <string>

#include "gcode/interpreter/interpreter.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/run/task_canon.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "messages/declarations/status.hh"

namespace mw::task {

/// The pins of the I/O controller, which task reads and writes once in each cycle, and the person who changes
/// tools by hand.
class IoPins {
  public:
    virtual ~IoPins() = default;
    virtual io::Inputs read() = 0;
    virtual void write(const io::Outputs &outputs) = 0;
    /// True if a person is asked to change the tool.
    virtual bool isPersonAsked() const = 0;
    virtual void confirm_tool_change() = 0;
};

struct Settings {
    gcode::LengthUnits machine_units = gcode::LengthUnits::MM;
    messages::SettingsStatus shown;  ///< settings for clients; task adds the settings of motion
    unsigned axis_mask = 7;
    int num_joints = 3;
    int num_spindles = 1;
    bool isHomingForced = true;  ///< programs and MDI need all joints homed
    std::string parameter_file;  ///< empty: parameters are only in memory
    gcode::Settings interpreter;
    std::string interpreter_plugin;  ///< [TASK]INTERPRETER: a shared object; empty: RS-274/NGC
    SequencerSettings sequencer;
    Confinement confinement;  ///< for clients that may only operate
    io::Protocol changer_protocol;
    ToolChangePlace tool_change_place;
    int mdi_queued_commands = 10;  ///< number of MDI lines that may wait after the running one
    /// Waits within a cycle for the program of a user M code; for virtual clocks.
    bool user_program_awaited = false;
    /// The machine stops when task's loop hangs for this time.
    double watchdog_s = 0.5;
    /// Maximum blocks read in one cycle; the interpreter waits while the queue has more items than the limit.
    int blocks_per_cycle = 200;
    std::size_t read_ahead_items = 2000;
    /// Maximum number of interpreter steps read ahead of the machine, including those without calls. It is
    /// far above the queue of motion, because it limits only memory and must not shorten the path that motion
    /// plans.
    std::size_t read_ahead_steps = 50'000;
};

}  // namespace mw::task
