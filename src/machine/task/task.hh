// SPDX-License-Identifier: GPL-2.0-or-later
// Task: states, modes, programs and single lines; takes operators' commands and coordinates motion and I/O
// (D1-D3).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "machine/io/discrete_io.hh"
#include "machine/task/link/motion_link.hh"
#include "machine/task/link/shown_settings.hh"
#include "machine/task/link/shown_tools.hh"
#include "machine/task/run/admission.hh"
#include "machine/task/run/approach.hh"
#include "machine/task/run/left_place.hh"
#include "machine/task/run/machine_world.hh"
#include "machine/task/run/on_abort.hh"
#include "machine/task/run/parameter_file.hh"
#include "machine/task/run/program_reader.hh"
#include "machine/task/run/program_run.hh"
#include "machine/task/run/recovery.hh"
#include "machine/task/run/senders.hh"
#include "machine/task/sequencer/planner_mode.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "machine/task/sequencer/user_program.hh"
#include "machine/task/states/homing_request.hh"
#include "machine/task/states/inbox.hh"
#include "machine/task/states/machine_state.hh"
#include "machine/task/states/mdi_queue.hh"
#include "machine/task/states/motion_orders.hh"
#include "machine/task/states/operating_mode.hh"
#include "machine/task/status.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::task {

/// Why a command that waited was never begun.
inline constexpr const char *OVERTAKEN = "it came before a stop";

/// The pins of the I/O controller, as task reads and writes them once a cycle, and the person who changes
/// tools by hand.
class IoPins {
  public:
    virtual ~IoPins() = default;
    virtual io::Inputs read() = 0;
    virtual void write(const io::Outputs &outputs) = 0;
    /// A person is asked to change the tool.
    virtual bool isPersonAsked() const = 0;
    virtual void confirm_tool_change() = 0;
};

struct Settings {
    gcode::LengthUnits machine_units = gcode::LengthUnits::MM;
    messages::SettingsStatus shown;  ///< to clients; what motion is told is added by task
    unsigned axis_mask = 7;
    int num_joints = 3;
    int num_spindles = 1;
    bool isHomingForced = true;  ///< programs and MDI need all joints homed
    std::string parameter_file;  ///< empty: parameters live in memory only
    gcode::Settings interpreter;
    std::string interpreter_plugin;  ///< [TASK]INTERPRETER: a shared object; empty: RS-274/NGC
    SequencerSettings sequencer;
    Confinement confinement;  ///< of clients that have only the authority to operate
    io::Protocol changer_protocol;
    ToolChangePlace tool_change_place;
    int mdi_queued_commands = 10;  ///< lines of MDI that may wait behind the one that runs
    /// A program of a user M code is waited for within a cycle: for virtual clocks.
    bool isUserProgramWaitedFor = false;
    /// Task's loop standing still for so long stops the machine.
    double watchdog_s = 0.5;
    /// Blocks that the interpreter may read in one cycle, and queued items above which it waits.
    int blocks_per_cycle = 200;
    std::size_t read_ahead_items = 2000;
    /// Steps of the interpreter that may be read before the machine reaches them, those that ask for nothing
    /// included. Far above what motion holds: the limit is for memory and must not shorten the path that
    /// motion plans over.
    std::size_t read_ahead_steps = 50'000;
};

/// While another thread has task (LongCall).
struct Apart {
    bool isOn = false;
    bool isStopped = false;
    bool isTold = false;      ///< to the operator
    bool isWaitTold = false;  ///< that it does not end after a stop
    std::int64_t stopped_ns = 0;
    std::int64_t since_ns = 0;  ///< its first cycle
    std::vector<std::function<void()>> later;
};

/// What task is built from; all must outlive it.
struct Parts {
    motion::Channels &channels;
    IoPins &io_port;
    ToolStore &tools;
    gcode::ParameterSource &parameters;
    mailbox::Segment &mailbox;  ///< the only way in for commands, out for outcomes, messages and status
    journal::Writer *journal = nullptr;  ///< null: programs are not journalled
};

/// What Task::configure() has sent.
struct SentSettings {
    motion::CommandId last = 0;
    std::string refused;  ///< why the first one was
};

/// Owns the parts of task, hands each what it needs in its step and passes on what it tells. One thread;
/// step() never blocks.
class Task {
  public:
    Task(const Parts &parts, Settings settings);
    Task(const Task &) = delete;
    Task &operator=(const Task &) = delete;

    using ScrewTables = std::vector<std::vector<motion::LoadCompensation>>;
    /// Hands settings and tables of screw errors to the motion controller; a refused one comes as a message,
    /// and the first is kept.
    void configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables = {});
    /// One setting, later on; whoever asks has seen that it is no time at which it cannot be.
    void change(const motion::SetParameter &parameter) {
        shown_settings_.note(parameter);
        motion_.send(parameter);
    }
    /// The settings of motion, with all changes.
    const motion::Settings &motion_settings() const { return shown_settings_.settings(); }
    /// All settings handed over are answered; an error, once they are, when one or a table was refused.
    Result<bool> isConfigured() const;

    /// Loads parameters and announces the start state to the interpreter. Errors name file, line and column.
    Result<> start();
    /// Writes the parameter file and waits for it: at the end of the machine, or for one who is to read it.
    Result<> save_parameters();

    /// One task cycle at clock time `now_ns`.
    void step(std::int64_t now_ns);
    /// A cycle of a thread that has taken task over while step() is in a long call: stops, holds, overrides
    /// and the status. What needs the interpreter is done when the call has ended; other commands wait.
    void step_apart(std::int64_t now_ns);
    /// For the thread that calls step_apart().
    LongCall &long_call() { return reader_.call().call; }

    /// A line for the operator, whoever has the right to operate.
    void post(MessageKind kind, const std::string &text) { desk_.post(kind, text); }

    const Status &status() const { return status_; }
    /// The planner in force, and wishes of the operator about it.
    PlannerMode &planner_mode() { return planner_mode_; }
    const motion::Status &motion_status() const { return motion_.status(); }
    /// The last program error with its place, callers and text; nullptr when the last program ended well.
    const diagnostics::Diagnostic *program_error() const { return run_.error(); }
    const std::string &file_name(std::uint32_t index) const { return reader_.canon().file_name(index); }
    /// Is told of each move when it is handed to the planner (for figures and pictures).
    void set_move_listener(MoveListener listener) { sequencer_.set_move_listener(std::move(listener)); }

  private:
    struct Handler;
    friend struct Handler;
    /// Starts elsewhere than at the first line: task_search.cc.
    struct ProgramResume;
    friend struct ProgramResume;
    /// What is done beside a long call: task_apart.cc.
    struct Meanwhile;
    friend struct Meanwhile;
    /// The status: task_status.cc.
    struct Show;
    friend struct Show;

    SequencerEvents make_events();
    SourcePlace place_of(const motion::SourceTag &source) const;
    void take_motion_news();
    void update_state();
    void end_requests();
    void step_homing();
    void check_run_mode();
    void carry_out_commands();
    void carry_out(const mailbox::CommandServer::Delivery &delivery);
    void step_run();
    void run_interpreter();
    bool begin_run();
    void on_step_result(gcode::Step result);
    bool on_stop(const gcode::ProgramStop &stop, int line);

    // task_abort.cc
    void fail_program(diagnostics::Diagnostic what, AbortReason reason);
    /// `isCutShort`: nobody has wanted its end, so that it may be gone on with.
    void stop_run(const std::string &reason, bool isCutShort = true);
    void abort_work(AbortReason reason);
    void begin_clean_up(AbortReason reason);
    void step_clean_up();

    void finish_run(Progress progress, const std::string &reason);
    void tell(const std::optional<Ending> &ending);
    /// Takes the machine's position and state as the program's.
    void synch_interpreter();
    Result<> check_can_run() const;

    Settings settings_;
    Parts parts_;
    mailbox::CommandServer desk_;
    MotionLink motion_;
    io::DiscreteIo io_;

    Inbox inbox_;
    Senders senders_;
    MachineState state_;
    OperatingMode mode_;
    HomingRequest homing_;
    MotionOrders orders_;
    MdiQueue mdi_queue_;

    MachineWorld world_;
    ProgramReader reader_;
    ParameterFile parameter_file_;
    ProgramRun run_;
    Recovery recovery_;
    Approach approach_;
    std::optional<LeftPlace> left_;  ///< while the run is held
    OnAbort on_abort_;
    UserProgram user_program_;
    Sequencer sequencer_;
    PlannerMode planner_mode_;

    ShownTools tools_;
    ShownSettings shown_settings_;
    mailbox::Serial reload_command_ = 0;  ///< LoadToolTable that has not ended; 0: none
    Status status_;
    std::int64_t now_ns_ = 0;
    Apart apart_;
    SentSettings sent_settings_;
};

}  // namespace mw::task
