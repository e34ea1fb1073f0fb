// SPDX-License-Identifier: GPL-2.0-or-later
// Takes the ordered queue to the machine: motion and I/O each at the right time (requirement D2).
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
#include "machine/task/sequencer/sent_moves.hh"
#include "machine/task/sequencer/tool_change.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// What the sequencer tells task that happened, in program order.
struct SequencerEvents {
    std::function<void(MessageKind, const std::string &)> message;
    std::function<void(const std::string &)> print;
    /// M0, M1, M60 are reached; true: the program is held there, nothing behind it may begin
    std::function<bool(const gcode::ProgramStop &, int line)> stop;
    std::function<void()> end;                      ///< the program is over
    std::function<void(const std::string &)> fail;  ///< something cannot be done; task aborts
    std::function<void(const gcode::UseOffsets &)> offsets;
    std::function<motion::CommandId(const gcode::UseToolOffset &)> tool_offset;
    /// Changes the planner at rest; the command whose answer is to be awaited, 0: nothing to wait for;
    /// nothing when it cannot be, and task aborts.
    std::function<std::optional<motion::CommandId>(const gcode::UsePlanner &)> planner_mode;
    /// Which files the run may write; null, or no function: any.
    std::function<const Confinement *()> confinement;
    /// Starts the program of a user M code.
    std::function<void(const gcode::UserCode &)> start_user_code;
    /// Nothing while the program of a user M code is started and runs, then how that ended.
    std::function<std::optional<Result<>>()> user_code_result;
};

/// Is told of each move when it is handed to the planner.
using MoveListener = std::function<void(motion::CommandId id, const motion::PathBody &move)>;

struct SequencerSettings {
    std::string changer_error_text{};        ///< [TASK]IO_ERROR
    bool isToolChangeWithSpindleOn = false;  ///< [EMCIO]TOOL_CHANGE_WITH_SPINDLE_ON
    int smooth_planner = 1;  ///< [TRAJ]SMOOTH_PLANNER: what G64 R above 0 means; 0: it is refused
    LogWorks log_works = LogWorks::ON_CALL;
    std::shared_ptr<LogDisk> log_disk = std::make_shared<LogDisk>();
};

/// The spindle that M19 is to bring to its angle.
struct AwaitedOrient {
    int spindle = 0;
    motion::CommandId command = 0;  ///< the last M19
    bool isTold = false;            ///< status is of a time after it
    double timeout_s = 0;
};

/// One thread; step() once a task cycle, never blocks.
class Sequencer {
  public:
    Sequencer(ItemQueue &queue, MotionLink &motion, io::DiscreteIo &io, ToolStore &tools,
              SequencerEvents events, SequencerSettings settings);

    enum class TravelRange : std::uint8_t {
        ALL,
        NO_TOOLS,  ///< up to the next item that uses the tool data: others read them now
    };
    /// Issues what may be issued now. `now_ns` is the clock of the scheduler.
    void step(std::int64_t now_ns, TravelRange reach = TravelRange::ALL);
    /// Drops everything that waits, also handshakes; the changer is told why.
    void abort(int reason);
    /// Nothing queued, nothing waited for, motion complete, no handshake.
    bool isIdle() const;
    /// Carries out one block and no more: isStepDone() is true once the next one could begin and the axes are
    /// stopped. Without `isSingle` it carries out all of them.
    void set_stepping(bool isSingle);
    bool isStepDone() const { return isStepDone_; }

    void on_tool_event(io::ToolEvent event);
    /// What is being waited for: a pin or a state.
    Waiting waiting_for() const;
    /// The same in the words of older clients.
    ExecState exec_state() const;
    /// [s] of a dwell; 0 when there is none.
    double dwell_left_s(std::int64_t now_ns) const;

    /// The result of M66.
    struct InputResult {
        double value = 0;
        bool isTimedOut = false;
    };
    InputResult input() const { return {input_value_, isInputTimedOut_}; }
    /// Of the first block that is not done; number 0 before the first.
    ItemPlace place() const;
    /// Another program begins.
    void forget_place() { last_begun_ = {}; }
    /// Task lets it follow motion once a cycle, before anything that may end a program.
    SentMoves &sent() { return sent_; }
    /// Starts or stops a spindle at once (operator's command).
    void command_spindle(int spindle, double signed_rpm, bool isWaiting) {
        spindles_.command(spindle, signed_rpm, isWaiting, motion_);
    }
    /// As programmed (unscaled).
    const ProgramSpindles &spindles() const { return spindles_; }
    /// Of a program that is held: all that the planner has not done comes back into the queue; the caller
    /// stops motion. An error says why it cannot be begun again from `place`.
    Result<> take_back(const geometry::Pose &place);
    void stop_spindles() { spindles_.stop_all(motion_); }
    /// Whether a probe was made since the last call.
    bool take_probe() { return std::exchange(isProbeMade_, false); }
    ProgramLogs &logs() { return logs_; }
    const ToolChange &tool_change() const { return tool_change_; }
    /// Of the tool that is ready, in the table; -1: none.
    int selected_tool_index() const { return tool_change_.selected_index(tools_); }
    void set_move_listener(MoveListener listener) { move_listener_ = std::move(listener); }

  private:
    enum class Wait : std::uint8_t { NONE, DWELL, INPUT, TOOL, TOOL_DATA, ORIENT, USER_CODE, SETTING, LOG };
    bool isWaitOver(std::int64_t now_ns);
    bool isInputWaitOver(std::int64_t now_ns);
    bool isOrientWaitOver(std::int64_t now_ns);
    bool isReady(const Item &item);
    bool isStepBoundary(const Item &item);
    /// Tells a failure and begins nothing after it.
    void check(const Result<> &result);
    /// False when the item must be tried again next cycle.
    bool execute(const Item &item, std::int64_t now_ns);
    bool push_move(const motion::PathBody &move, const geometry::MoveSettings &settings, const Item &item);
    bool push_output(const gcode::SetDigitalOutput &output);
    bool push_output(const gcode::SetAnalogOutput &output);
    bool begin(const gcode::UsePlanner &planner);
    // What is done in no time; some of it is waited for afterwards.
    void perform(const gcode::Dwell &dwell, std::int64_t now_ns);
    void perform(const gcode::WaitInput &input, std::int64_t now_ns);
    void perform(const gcode::WaitOrientComplete &orient, std::int64_t now_ns);
    void perform(const gcode::UserCode &code);
    void perform(const gcode::ChangeTool &change);
    /// Done once motion has it, so that pins show it when the block is over.
    void wait_for_setting(motion::CommandId setting) {
        awaited_setting_ = setting;
        wait_ = Wait::SETTING;
    }

    ItemQueue &queue_;
    MotionLink &motion_;
    io::DiscreteIo &io_;
    ToolStore &tools_;
    SequencerEvents events_;
    SequencerSettings settings_;
    MoveListener move_listener_;

    Wait wait_ = Wait::NONE;
    ExecState blocked_ = ExecState::DONE;  ///< what the item in front has waited for in the last step
    std::int64_t deadline_ns_ = 0;         ///< of a dwell or a time limit; 0: none
    gcode::WaitInput awaited_input_{};
    double input_value_ = 0, last_input_ = 0;
    bool isInputTimedOut_ = false;
    AwaitedOrient orient_;
    motion::CommandId awaited_setting_ = 0;
    SentMoves sent_;
    ToolChange tool_change_;
    ProgramSpindles spindles_;
    bool isStepping_ = false, isStepDone_ = false;
    bool isHeld_ = false;          ///< by the stop that was executed last, for the rest of the cycle
    bool hasFailed_ = false;       ///< nothing more is begun until abort()
    std::uint64_t step_read_ = 0;  ///< what the single step carries out; 0: nothing yet
    ItemPlace last_begun_;         ///< of the last item that was begun
    ProgramLogs logs_;
    bool isProbeMade_ = false;
};

}  // namespace mw::task
