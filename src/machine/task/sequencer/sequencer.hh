// SPDX-License-Identifier: GPL-2.0-or-later
// Executes the ordered queue: motion and I/O each at the right time (requirement D2).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/result.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/link/motion_link.hh"
#include "machine/task/link/tool_store.hh"
#include "machine/task/sequencer/items.hh"
#include "machine/task/sequencer/program_logs.hh"
#include "machine/task/sequencer/program_spindles.hh"
#include "machine/task/sequencer/program_wait.hh"
#include "machine/task/sequencer/sent_moves.hh"
#include "machine/task/sequencer/tool_change.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// Events that the sequencer reports to task, in program order.
struct SequencerEvents {
    std::function<void(MessageKind, const std::string &)> message;
    std::function<void(const std::string &)> print;
    /// M0, M1, M60 are reached; true: the program pauses there, and no later item may start
    std::function<bool(const gcode::ProgramStop &, int line)> stop;
    std::function<void()> end;                      ///< the program has ended
    std::function<void(const std::string &)> fail;  ///< an action failed; task aborts
    std::function<void(const gcode::UseOffsets &)> offsets;
    std::function<motion::CommandId(const gcode::UseToolOffset &)> tool_offset;
    /// Changes the planner at standstill. Returns the command whose answer is awaited, 0: none. If the change
    /// is not possible it returns nothing, and task aborts.
    std::function<std::optional<motion::CommandId>(const gcode::UsePlanner &)> planner_mode;
    /// The files that the run may write; null, or no function: any file.
    std::function<const Confinement *()> confinement;
    /// Starts the program of a user M code.
    std::function<void(const gcode::UserCode &)> start_user_code;
    /// Result of the program of a user M code; nothing while it starts and runs.
    std::function<std::optional<Result<>>()> user_code_result;
};

/// A move that was sent to the planner.
struct SentMove {
    motion::CommandId id = 0;
    geometry::Pose start;  ///< programmed start position
    const motion::PathBody &body;
};
/// Called for each move that is sent to the planner.
using MoveListener = std::function<void(const SentMove &move)>;

struct SequencerSettings {
    std::string changer_error_text{};          ///< [TASK]IO_ERROR
    bool tool_change_with_spindle_on = false;  ///< [EMCIO]TOOL_CHANGE_WITH_SPINDLE_ON
    int smooth_planner = 1;  ///< [TRAJ]SMOOTH_PLANNER: effect of G64 R above 0; 0: G64 R is rejected
    LogWorks log_works = LogWorks::ON_CALL;
    std::shared_ptr<LogDisk> log_disk = std::make_shared<LogDisk>();
};

/// One thread; step() is called once in each task cycle and does not block.
class Sequencer {
  public:
    Sequencer(ItemQueue &queue, MotionLink &motion, io::DiscreteIo &io, ToolStore &tools,
              SequencerEvents events, SequencerSettings settings);

    enum class TravelRange : std::uint8_t {
        ALL,
        NO_TOOLS,  ///< up to the next item that uses tool data, because another call reads the tools now
    };
    /// Starts the items that may start now. `now_ns` is the clock of the scheduler.
    void step(std::int64_t now_ns, TravelRange reach = TravelRange::ALL);
    /// Drops all waiting items and handshakes; the changer receives the reason.
    void abort(int reason);
    /// True if nothing is queued or awaited, motion is complete and there is no handshake.
    bool isIdle() const;
    /// Executes only one block: isStepDone() is true when the next block could start and the axes are
    /// stopped. Without `single` all blocks are executed.
    void set_stepping(bool single);
    bool isStepDone() const { return step_done_; }

    void on_tool_event(io::ToolEvent event);
    /// The pin or state that is awaited.
    Waiting waiting_for() const { return wait_.waiting_for(); }
    /// LinuxCNC's exec_state.
    ExecState exec_state() const { return wait_.exec_state(blocked_); }
    /// Remaining time of a dwell [s]; 0 when there is none.
    double dwell_left_s(std::int64_t now_ns) const { return wait_.dwell_left_s(now_ns); }

    /// The result of M66.
    ProgramWait::InputResult input() const { return wait_.input(); }
    /// Position of the first block that is not done; number 0 before the first block.
    ItemPlace place() const;
    /// Called when another program starts.
    void forget_place() { last_begun_ = {}; }
    /// Task updates it from motion once in each cycle, before anything that may end a program.
    SentMoves &sent() { return sent_; }
    /// Starts or stops a spindle at once (operator's command).
    void command_spindle(int spindle, double signed_rpm, bool waiting) {
        spindles_.command(spindle, signed_rpm, waiting, motion_);
    }
    /// Spindles as programmed (unscaled).
    const ProgramSpindles &spindles() const { return spindles_; }
    /// For a paused program: puts all moves that the planner has not done back into the queue; the caller
    /// stops motion. An error explains why the program cannot continue from `place`.
    Result<> take_back(const geometry::Pose &place);
    void stop_spindles() { spindles_.stop_all(motion_); }
    /// True if a probe was made since the last call.
    bool take_probe() { return std::exchange(probe_made_, false); }
    ProgramLogs &logs() { return logs_; }
    const ToolChange &tool_change() const { return tool_change_; }
    /// Table index of the prepared tool; -1: none.
    int selected_tool_index() const { return tool_change_.selected_index(tools_); }
    void set_move_listener(MoveListener listener) { move_listener_ = std::move(listener); }

  private:
    bool isWaitOver(std::int64_t now_ns);
    bool isReady(const Item &item);
    bool isStepBoundary(const Item &item);
    /// Reports a failure; nothing starts after it.
    void check(const Result<> &result);
    /// False when the item must be tried again next cycle.
    bool execute(const Item &item, std::int64_t now_ns);
    bool push_move(const motion::PathBody &move, const geometry::MoveSettings &settings, const Item &item);
    bool push_output(const gcode::SetDigitalOutput &output);
    bool push_output(const gcode::SetAnalogOutput &output);
    bool begin(const gcode::UsePlanner &planner);
    // Actions without duration; for some of them the sequencer waits afterwards.
    void perform(const gcode::Dwell &dwell, std::int64_t now_ns);
    void perform(const gcode::WaitInput &input, std::int64_t now_ns);
    void perform(const gcode::WaitOrientComplete &orient, std::int64_t now_ns);
    void perform(const gcode::UserCode &code);
    void perform(const gcode::ChangeTool &change);

    ItemQueue &queue_;
    MotionLink &motion_;
    io::DiscreteIo &io_;
    ToolStore &tools_;
    SequencerEvents events_;
    SequencerSettings settings_;
    MoveListener move_listener_;

    ExecState blocked_ = ExecState::DONE;  ///< condition for which the front item waited in the last step
    SentMoves sent_;
    ToolChange tool_change_;
    ProgramSpindles spindles_;
    bool stepping_ = false, step_done_ = false;
    bool held_ = false;            ///< paused by the last stop, for the rest of the cycle
    bool failed_ = false;          ///< nothing starts until abort()
    std::uint64_t step_read_ = 0;  ///< step executed by single step; 0: none yet
    ItemPlace last_begun_;         ///< position of the last started item
    ProgramLogs logs_;
    ProgramWait wait_;
    bool probe_made_ = false;
};

}  // namespace mw::task
