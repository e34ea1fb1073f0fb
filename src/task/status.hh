// SPDX-License-Identifier: GPL-2.0-or-later
// What task tells: states, program position, offsets. One owner, copied whole by readers.
#pragma once

#include <cstdint>
#include <string>

#include "geom/pose.hh"
#include "interp/interpreter.hh"
#include "task/command.hh"

namespace mw::task {

enum class InterpState : std::uint8_t { IDLE = 1, READING = 2, PAUSED = 3, WAITING = 4 };

/// What the program waits for; the text names the pin or state.
struct Waiting {
    std::string what;  ///< empty: for nothing
};

struct Status {
    State state = State::ESTOP;
    Mode mode = Mode::MANUAL;
    InterpState interp_state = InterpState::IDLE;
    bool isPaused = false;
    bool isStoppedByProgram = false;  ///< paused by M0, M1 or M60
    bool isOptionalStop = true;
    bool isBlockDelete = true;
    std::string program;       ///< path of the open program
    int read_line = 0;         ///< last line that the interpreter has read
    int stop_line = 0;         ///< of the last M0, M1 or M60 reached
    std::uint64_t stops = 0;   ///< M0, M1 and M60 that have stopped a program
    int motion_line = 0;       ///< line of the move being executed
    std::uint64_t blocks = 0;  ///< executed since the program started
    int call_level = 0;
    interp::ActiveCodes codes;
    int g5x_index = 1;
    geom::Pose g5x_offset, g92_offset, tool_offset;  ///< [machine units]
    double rotation_xy_deg = 0;
    bool isMistOn = false, isFloodOn = false;
    int tool_in_spindle = 0;
    Waiting waiting;
    std::uint64_t programs_ended = 0;  ///< counts M2, M30 and ends of file
};

/// Why all work was stopped: the argument of [RS274NGC]ON_ABORT_COMMAND.
enum class AbortReason : std::uint8_t {
    EXECUTION_ERROR = 1,  ///< a move was refused, or something that the program asked for failed
    ESTOP_CHAIN = 2,
    MOTION_FAULT = 3,  ///< following error, limit switch, amplifier
    STATE_OFF = 4,
    STATE_ESTOP_RESET = 5,
    STATE_ESTOP = 6,
    STATE_NOT_ON = 7,  ///< the machine went off by itself
    ABORT = 8,         ///< the operator's
    INTERPRETER_ERROR = 9,
    INTERPRETER_ERROR_MDI = 10,
};

enum class MessageKind : std::uint8_t { OPERATOR_ERROR = 11, OPERATOR_TEXT = 12, OPERATOR_DISPLAY = 13 };

/// A line for the operator.
struct Message {
    MessageKind kind = MessageKind::OPERATOR_ERROR;
    std::string text;
};

}  // namespace mw::task
