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

/// The pins of the I/O controller, which task reads and writes once a cycle, and the person who changes tools
/// by hand.
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
    messages::SettingsStatus shown;  ///< for clients; task adds the settings of motion
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
    /// Waits within a cycle for the program of a user M code: for virtual clocks.
    bool user_program_awaited = false;
    /// The machine stops when task's loop hangs for this time.
    double watchdog_s = 0.5;
    /// Maximum blocks read in one cycle; the interpreter waits while the queue has more items than the limit.
    int blocks_per_cycle = 200;
    std::size_t read_ahead_items = 2000;
    /// Maximum number of interpreter steps read ahead of the machine, including those without calls. Far
    /// above the queue of motion: it limits memory and must not shorten the path that motion plans.
    std::size_t read_ahead_steps = 50'000;
};

/// State while another thread uses task (LongCall).
struct Apart {
    bool isOn = false;
    bool stopped = false;
    bool isTold = false;         ///< to the operator
    bool wait_reported = false;  ///< reported that it does not end after a stop
    std::int64_t stopped_ns = 0;
    std::int64_t since_ns = 0;  ///< time of its first cycle
    std::vector<std::function<void()>> later;
};

/// Objects that task uses; all must outlive it.
struct Parts {
    motion::Channels &channels;
    IoPins &io_port;
    ToolStore &tools;
    gcode::ParameterSource &parameters;
    mailbox::Segment &mailbox;           ///< the only channel for commands, outcomes, messages and status
    journal::Writer *journal = nullptr;  ///< null: programs are not journalled
};

/// Settings sent by Task::configure().
struct SentSettings {
    motion::CommandId last = 0;
    std::string refused;  ///< why the first one was rejected
};

/// Owns the parts of task, calls each in its step and passes on their results. One thread; step() does not
/// block.
class Task {
  public:
    Task(const Parts &parts, Settings settings);
    Task(const Task &) = delete;
    Task &operator=(const Task &) = delete;

    using ScrewTables = std::vector<std::vector<motion::LoadCompensation>>;
    /// Sends settings and tables of screw errors to the motion controller; a rejected one becomes a message,
    /// and the first is kept.
    void configure(const std::vector<motion::SetParameter> &parameters, const ScrewTables &tables = {});
    /// Changes one setting later; the caller has checked that it may change now.
    void change(const motion::SetParameter &parameter) {
        shown_settings_.note(parameter);
        motion_.send(parameter);
    }
    /// The current settings of motion.
    const motion::Settings &motion_settings() const { return shown_settings_.settings(); }
    /// All settings have been answered; then an error when one or a table was rejected.
    Result<bool> isConfigured() const;

    /// Loads parameters and announces the start state to the interpreter. Errors name file, line and column.
    Result<> start();
    /// Writes the parameter file and waits for it: at the end of the machine, or for a reader of the file.
    Result<> save_parameters();

    /// One task cycle at clock time `now_ns`.
    void step(std::int64_t now_ns);
    /// A cycle of a thread that uses task while step() is in a long call: stops, pauses, overrides and the
    /// status. Actions that need the interpreter follow when the call has ended; other commands wait.
    void step_apart(std::int64_t now_ns);
    /// For the thread that calls step_apart().
    LongCall &long_call() { return reader_.call().call; }

    /// A message for the operator, independent of the right to operate.
    void post(MessageKind kind, const std::string &text) { desk_.post(kind, text); }

    const Status &status() const { return status_; }
    /// The active planner, and the operator's requests to change it.
    PlannerMode &planner_mode() { return planner_mode_; }
    const motion::Status &motion_status() const { return motion_.status(); }
    /// The current or last program or MDI line.
    const ProgramRun &run() const { return run_; }
    const std::string &file_name(std::uint32_t index) const { return reader_.canon().file_name(index); }
    /// Called for each move that is sent to the planner (for figures and pictures).
    void set_move_listener(MoveListener listener) { sequencer_.set_move_listener(std::move(listener)); }

  private:
    struct Handler;
    friend struct Handler;
    /// Starts at other lines than the first: task_search.cc.
    struct ProgramResume;
    friend struct ProgramResume;
    /// Work during a long call: task_apart.cc.
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
    /// `interrupted`: the end was not requested, so the program may be continued.
    void stop_run(const std::string &reason, bool interrupted = true);
    void abort_work(AbortReason reason);
    void begin_clean_up(AbortReason reason);
    void step_clean_up();

    void finish_run(Progress progress, const std::string &reason);
    void tell(const std::optional<Ending> &ending);
    /// Sets the program's position and state to those of the machine.
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
    std::optional<LeftPlace> left_;  ///< while the run is paused
    OnAbort on_abort_;
    UserProgram user_program_;
    Sequencer sequencer_;
    PlannerMode planner_mode_;

    ShownTools tools_;
    ShownSettings shown_settings_;
    mailbox::Serial reload_command_ = 0;  ///< the active LoadToolTable; 0: none
    Status status_;
    std::int64_t now_ns_ = 0;
    Apart apart_;
    SentSettings sent_settings_;
};

}  // namespace mw::task
