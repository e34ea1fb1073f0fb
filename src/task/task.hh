// SPDX-License-Identifier: GPL-2.0-or-later
// Task: states, modes, programs and single lines; takes operators' commands and coordinates motion and I/O
// (D1-D3).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "interp/interpreter.hh"
#include "interp/machine_frame.hh"
#include "io/controller.hh"
#include "mailbox/desk.hh"
#include "task/command.hh"
#include "task/motion_link.hh"
#include "task/planner_mode.hh"
#include "task/run_state.hh"
#include "task/sequencer.hh"
#include "task/status.hh"
#include "task/task_canon.hh"
#include "task/tool_store.hh"
#include "task/user_program.hh"

namespace mw::task {

/// The pins of the I/O controller, as task reads and writes them once a cycle, and the person who changes
/// tools by hand.
class IoPort {
  public:
    virtual ~IoPort() = default;
    virtual io::Inputs read() = 0;
    virtual void write(const io::Outputs &outputs) = 0;
    /// A person is asked to change the tool.
    virtual bool isPersonAsked() const = 0;
    virtual void confirm_tool_change() = 0;
};

struct Settings {
    interp::LengthUnits machine_units = interp::LengthUnits::MM;
    unsigned axis_mask = 7;
    int num_joints = 3;
    int num_spindles = 1;
    bool isHomingForced = true;  ///< programs and MDI need all joints homed
    std::string parameter_file;  ///< empty: parameters live in memory only
    interp::Settings interpreter;
    std::string interpreter_plugin;  ///< [TASK]INTERPRETER: a shared object; empty: RS-274/NGC
    SequencerSettings sequencer;
    ToolChangePlace tool_change_place;
    /// A program of a user M code is waited for within a cycle: for virtual clocks.
    bool isClockHeldByUserPrograms = false;
    /// Task's loop standing still for so long stops the machine.
    double watchdog_s = 0.5;
    /// Blocks that the interpreter may read in one cycle, and queued items above which it waits.
    int blocks_per_cycle = 200;
    std::size_t read_ahead_items = 2000;
};

/// What task is built from; all must outlive it.
struct Parts {
    motion::Channels &channels;
    IoPort &io_port;
    ToolStore &tools;
    interp::ParameterSource &parameters;
    mailbox::Segment &mailbox;  ///< the only way in for commands, out for outcomes, messages and status
};

/// One thread; step() never blocks.
class Task final : public interp::World {
  public:
    Task(const Parts &parts, Settings settings);
    ~Task() override;

    /// Hands settings to the motion controller; a refused one comes as a message.
    void configure(const std::vector<motion::SetParameter> &parameters);
    /// All settings handed over are answered.
    bool isConfigured() const { return motion_.isAnswered(last_setting_); }

    /// Loads parameters and announces the start state to the interpreter. Errors name file, line and column.
    Result<> start();
    /// Writes the parameter file. Call once at a clean end.
    Result<> save_parameters() const;

    /// One task cycle at clock time `now_ns`.
    void step(std::int64_t now_ns);

    /// A line for the operator, whoever has the right to operate.
    void post(MessageKind kind, const std::string &text) { desk_.post(kind, text); }

    const Status &status() const { return status_; }
    /// The planner in force, and wishes of the operator about it.
    PlannerMode &planner_mode() { return planner_mode_; }
    const motion::Status &motion_status() const { return motion_.status(); }
    /// The last program error with its place, callers and text; nullptr when the last program ended well.
    const diag::Diagnostic *program_error() const {
        return program_error_.has_value() ? &*program_error_ : nullptr;
    }
    const std::string &file_name(std::uint32_t index) const { return canon_.file_name(index); }
    /// Is told of each move when it is handed to the planner (for figures and pictures).
    void set_move_listener(MoveListener listener) { sequencer_.set_move_listener(std::move(listener)); }

    // interp::World
    interp::MachineSnapshot snapshot() const override;
    interp::LengthUnits machine_units() const override { return settings_.machine_units; }
    unsigned axis_mask() const override { return settings_.axis_mask; }
    int count_spindles() const override { return settings_.num_spindles; }
    bool isBlockDeleteOn() const override { return status_.task.isBlockDelete; }
    bool isOptionalStopOn() const override { return status_.task.isOptionalStop; }

  private:
    enum class RunKind : std::uint8_t { PROGRAM, MDI };
    struct Handler;
    friend struct Handler;

    SequencerEvents make_events();
    SourcePlace place_of(const motion::SourceTag &source) const;
    void take_motion_news();
    void take_io();
    void update_state();
    void update_pending();
    void check_run_mode();
    void carry_out_commands();
    void run_interpreter();
    bool begin_run();
    void log_probe();
    bool isReadAheadAllowed() const;
    void on_step_result(interp::Step result);
    bool on_stop(const interp::ProgramStop &stop, int line);

    // task_abort.cc
    void fail_program(diag::Diagnostic what, AbortReason reason);
    void abort_work(AbortReason reason);
    void begin_clean_up(AbortReason reason);
    void step_clean_up();
    void end_clean_up(const std::string &trouble);
    interp::Step read_clean_up(AbortReason reason);

    void change_run(RunEvent event);
    void finish_run(Progress progress, const std::string &reason);
    void finish(mailbox::Serial &id, Progress progress, const std::string &reason);
    void tell(mailbox::Serial id, Progress progress, const std::string &reason);
    void publish_tools();
    void update_status();
    bool isRunning() const { return run_.isRunning(); }
    /// Takes the machine's position and state as the program's.
    void synch_interpreter();
    Result<> check_can_run() const;

    Settings settings_;
    Parts parts_;
    mailbox::Desk desk_;
    MotionLink motion_;
    io::Controller io_;
    ItemQueue queue_;
    TaskCanon canon_;
    interp::MachineFrame frame_;
    std::unique_ptr<interp::ProgramInterpreter> interp_;
    UserProgram user_program_;
    Sequencer sequencer_;
    PlannerMode planner_mode_;

    Status status_;
    std::int64_t now_ns_ = 0;
    RunState run_;
    RunKind run_kind_ = RunKind::PROGRAM;  ///< of the last run
    std::string mdi_line_;
    std::string pending_failure_;
    std::optional<int> tool_fault_;  ///< reason, when the last work of the changer ended with a fault
    bool isCleanedUp_ = false;       ///< nothing has run since the last abort
    std::deque<mailbox::Desk::Delivery> inbox_;
    mailbox::Serial run_request_ = 0, state_request_ = 0, home_request_ = 0, mode_request_ = 0;
    Mode wanted_mode_ = Mode::MANUAL;
    motion::Mode wanted_motion_mode_ = motion::Mode::FREE;
    motion::CommandId mode_command_ = 0;
    std::int64_t mode_deadline_ns_ = 0;
    std::int64_t out_of_mode_since_ns_ = -1;  ///< -1: not
    State wanted_state_ = State::ESTOP;
    int homing_joint_ = -1;
    motion::CommandId home_command_ = 0, enable_command_ = 0, last_setting_ = 0;
    std::int64_t state_deadline_ns_ = 0;
    std::optional<diag::Diagnostic> program_error_;
    std::uint64_t tools_version_ = 0;  ///< of the table that was published
};

}  // namespace mw::task
