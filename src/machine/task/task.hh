// SPDX-License-Identifier: GPL-2.0-or-later
// Task: states, modes, programs and single lines; takes operators' commands and coordinates motion and I/O
// (D1-D3).
#pragma once

#include <string>
#include <vector>

#include "machine/task/control/command_dispatcher.hh"
#include "machine/task/control/status_writer.hh"

namespace mw::task {

/// Objects that task uses; all must outlive it.
struct Parts {
    motion::Channels &channels;
    IoPins &io_port;
    ToolStore &tools;
    gcode::ParameterSource &parameters;
    mailbox::Segment &mailbox;           ///< the only channel for commands, outcomes, messages and status
    journal::Writer *journal = nullptr;  ///< null: programs are not journalled
};

/// Creates the parts of task, and calls each part in its step. One thread; step() does not block.
class Task {
  public:
    Task(const Parts &parts, Settings settings);
    Task(const Task &) = delete;
    Task &operator=(const Task &) = delete;

    /// Sends settings and tables of screw errors to the motion controller. Each rejection becomes a message,
    /// and the first one is stored.
    void configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables = {});
    /// Changes one setting later; the caller has checked that it may change now.
    void change(const motion::SetParameter &parameter) { motion_settings_.change(parameter); }
    /// The current settings of motion.
    const motion::Settings &motion_settings() const { return motion_settings_.current(); }
    /// True when all settings have been answered; an error if a setting or table was rejected.
    Result<bool> isConfigured() const { return motion_settings_.isConfigured(); }

    /// Loads parameters and announces the start state to the interpreter. Errors name file, line and column.
    Result<> start();
    /// Writes the parameter file and waits for it. Called at the end of the machine, or for a reader of the
    /// file.
    Result<> save_parameters() { return runs_.save_parameters(); }

    /// One task cycle at clock time `now_ns`.
    void step(std::int64_t now_ns);
    /// A cycle of a thread that uses task while step() is in a long call: stops, pauses, overrides and the
    /// status. Actions that need the interpreter follow after the call; other commands wait.
    void step_apart(std::int64_t now_ns);
    /// For the thread that calls step_apart().
    LongCall &long_call() { return reader_.call().call; }

    /// A message for the operator, independent of the right to operate.
    void post(MessageKind kind, const std::string &text) { port_.post(kind, text); }

    const Status &status() const { return status_.status(); }
    /// The active planner, and the operator's requests to change it.
    PlannerMode &planner_mode() { return planner_mode_; }
    const motion::Status &motion_status() const { return port_.motion(); }
    /// The current or last program or MDI line.
    const ProgramRun &run() const { return run_; }
    const std::string &file_name(std::uint32_t index) const { return reader_.canon().file_name(index); }
    /// Called for each move that is sent to the planner (for figures and pictures).
    void set_move_listener(MoveListener listener) { sequencer_.set_move_listener(std::move(listener)); }

  private:
    void take_motion_news();
    void abandon_requests();
    void take_inputs();
    void end_requests();
    void step_run();
    void write_outputs();

    Settings settings_;
    IoPins &io_pins_;
    MachinePort port_;
    io::DiscreteIo io_;
    Senders senders_;
    MdiQueue mdi_queue_;
    MachineWorld world_;
    ProgramReader reader_;
    ParameterFile parameter_file_;
    Recovery recovery_;
    ProgramRun run_;
    PlannerMode planner_mode_;
    LongCalls calls_;
    ProgramActions actions_;
    Sequencer sequencer_;
    const RunParts parts_;

    WorkEnd end_;
    RunController runs_;
    ModeController modes_;
    ManualControl manual_;
    ProgramResume resume_;
    MotionSettings motion_settings_;
    ToolTableControl tools_;
    CommandDispatcher commands_;
    StatusWriter status_;
};

}  // namespace mw::task
