// SPDX-License-Identifier: GPL-2.0-or-later
// What a program waits for after an item: a dwell, an input, a handshake or an answer.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/link/motion_link.hh"
#include "machine/task/link/tool_store.hh"
#include "machine/task/sequencer/program_logs.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// At most one wait is active. Times are those of the scheduler.
class ProgramWait {
  public:
    enum class For : std::uint8_t { NONE, DWELL, INPUT, TOOL, TOOL_DATA, ORIENT, USER_CODE, SETTING, LOG };

    ProgramWait(MotionLink &motion, io::DiscreteIo &io, ToolStore &tools, ProgramLogs &logs)
        : motion_(motion), io_(io), tools_(tools), logs_(logs) {}

    For awaited() const { return for_; }
    void begin(For what) { for_ = what; }
    void end() { for_ = For::NONE; }
    void begin_dwell(double seconds, std::int64_t now_ns);
    void begin_input(const gcode::WaitInput &input, std::int64_t now_ns);
    void begin_orient(const gcode::WaitOrientComplete &orient, std::int64_t now_ns);
    /// The command of an M19, whose end begin_orient() awaits.
    void note_orient(motion::CommandId command) { orient_.command = command; }
    /// Waits until motion has executed the setting, so that pins show it at the end of the block.
    void begin_setting(motion::CommandId setting) {
        awaited_setting_ = setting;
        for_ = For::SETTING;
    }

    /// Result of the program of a user M code; nothing while it starts and runs.
    using UserCodeResult = std::function<std::optional<Result<>>()>;
    /// True if the event has occurred, or failed: `failure` is then its error. Call end() afterwards.
    bool isOver(std::int64_t now_ns, const UserCodeResult &user_code_result, Result<> &failure);

    /// The result of M66.
    struct InputResult {
        double value = 0;
        bool timed_out = false;
    };
    InputResult input() const { return {input_value_, is_input_timed_out_}; }
    /// Remaining time of a dwell [s]; 0 when there is none.
    double dwell_left_s(std::int64_t now_ns) const;
    /// The same as LinuxCNC's exec_state. `blocked`: that of the next item if nothing is awaited.
    ExecState exec_state(ExecState blocked) const;
    /// The pin or state that is awaited.
    Waiting waiting_for() const;

  private:
    bool isInputOver(std::int64_t now_ns);
    bool isOrientOver(std::int64_t now_ns, Result<> &failure);

    /// The spindle that M19 orients.
    struct AwaitedOrient {
        int spindle = 0;
        motion::CommandId command = 0;  ///< command of the last M19
        bool isTold = false;            ///< the status is newer than the command
        double timeout_s = 0;
    };

    MotionLink &motion_;
    io::DiscreteIo &io_;
    ToolStore &tools_;
    ProgramLogs &logs_;
    For for_ = For::NONE;
    std::int64_t deadline_ns_ = 0;  ///< end of a dwell or a timeout; 0: none
    gcode::WaitInput awaited_input_{};
    double input_value_ = 0, last_input_ = 0;
    bool is_input_timed_out_ = false;
    AwaitedOrient orient_;
    motion::CommandId awaited_setting_ = 0;
};

}  // namespace mw::task
