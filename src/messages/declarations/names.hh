// SPDX-License-Identifier: GPL-2.0-or-later
// The enumerations of the messages. Values that LinuxCNC's clients compare are the same.
#pragma once

#include "messages/declarations/describe.hh"

namespace mw::messages {

enum class State : std::uint8_t { ESTOP = 1, ESTOP_RESET = 2, OFF = 3, ON = 4 };
template <>
inline constexpr auto NAMES<State> =
    std::array{named(State::ESTOP, "ESTOP"), named(State::ESTOP_RESET, "ESTOP_RESET"),
               named(State::OFF, "OFF"), named(State::ON, "ON")};

enum class Mode : std::uint8_t { MANUAL = 1, AUTO = 2, MDI = 3 };
template <>
inline constexpr auto NAMES<Mode> =
    std::array{named(Mode::MANUAL, "MANUAL"), named(Mode::AUTO, "AUTO"), named(Mode::MDI, "MDI")};

enum class InterpState : std::uint8_t { IDLE = 1, READING = 2, PAUSED = 3, WAITING = 4 };
template <>
inline constexpr auto NAMES<InterpState> =
    std::array{named(InterpState::IDLE, "IDLE"), named(InterpState::READING, "READING"),
               named(InterpState::PAUSED, "PAUSED"), named(InterpState::WAITING, "WAITING")};

/// The condition that task waits for, as clients of LinuxCNC read it.
enum class ExecState : std::uint8_t {
    ERROR = 1,
    DONE = 2,
    WAITING_FOR_MOTION = 3,
    WAITING_FOR_MOTION_QUEUE = 4,
    WAITING_FOR_IO = 5,
    WAITING_FOR_MOTION_AND_IO = 7,
    WAITING_FOR_DELAY = 8,
    WAITING_FOR_SYSTEM_CMD = 9,
    WAITING_FOR_SPINDLE_ORIENTED = 10
};
template <>
inline constexpr auto NAMES<ExecState> =
    std::array{named(ExecState::ERROR, "ERROR"),
               named(ExecState::DONE, "DONE"),
               named(ExecState::WAITING_FOR_MOTION, "WAITING_FOR_MOTION"),
               named(ExecState::WAITING_FOR_MOTION_QUEUE, "WAITING_FOR_MOTION_QUEUE"),
               named(ExecState::WAITING_FOR_IO, "WAITING_FOR_IO"),
               named(ExecState::WAITING_FOR_MOTION_AND_IO, "WAITING_FOR_MOTION_AND_IO"),
               named(ExecState::WAITING_FOR_DELAY, "WAITING_FOR_DELAY"),
               named(ExecState::WAITING_FOR_SYSTEM_CMD, "WAITING_FOR_SYSTEM_CMD"),
               named(ExecState::WAITING_FOR_SPINDLE_ORIENTED, "WAITING_FOR_SPINDLE_ORIENTED")};

/// Target of moves that a person must confirm before they start.
enum class ApproachTo : std::uint8_t { NOTHING, LINE, PLACE_LEFT, PLACE_LOST };
template <>
inline constexpr auto NAMES<ApproachTo> =
    std::array{named(ApproachTo::NOTHING, "NOTHING"), named(ApproachTo::LINE, "LINE"),
               named(ApproachTo::PLACE_LEFT, "PLACE_LEFT"), named(ApproachTo::PLACE_LOST, "PLACE_LOST")};

enum class MotionMode : std::uint8_t { FREE = 1, COORD = 2, TELEOP = 3 };
template <>
inline constexpr auto NAMES<MotionMode> = std::array{
    named(MotionMode::FREE, "FREE"), named(MotionMode::COORD, "COORD"), named(MotionMode::TELEOP, "TELEOP")};

/// Type of the current move.
enum class MoveKind : std::uint8_t {
    NONE = 0,
    TRAVERSE = 1,
    FEED = 2,
    ARC = 3,
    TOOL_CHANGE = 4,
    PROBE = 5,
    INDEX_ROTARY = 6
};
template <>
inline constexpr auto NAMES<MoveKind> = std::array{named(MoveKind::NONE, "NONE"),
                                                   named(MoveKind::TRAVERSE, "TRAVERSE"),
                                                   named(MoveKind::FEED, "FEED"),
                                                   named(MoveKind::ARC, "ARC"),
                                                   named(MoveKind::TOOL_CHANGE, "TOOL_CHANGE"),
                                                   named(MoveKind::PROBE, "PROBE"),
                                                   named(MoveKind::INDEX_ROTARY, "INDEX_ROTARY")};

enum class JointKind : std::uint8_t { LINEAR = 1, ANGULAR = 2 };
template <>
inline constexpr auto NAMES<JointKind> =
    std::array{named(JointKind::LINEAR, "LINEAR"), named(JointKind::ANGULAR, "ANGULAR")};

/// Relation between joints and axes.
enum class Kinematics : std::uint8_t { IDENTITY = 1, FORWARD_ONLY = 2, INVERSE_ONLY = 3, BOTH = 4 };
template <>
inline constexpr auto NAMES<Kinematics> =
    std::array{named(Kinematics::IDENTITY, "IDENTITY"), named(Kinematics::FORWARD_ONLY, "FORWARD_ONLY"),
               named(Kinematics::INVERSE_ONLY, "INVERSE_ONLY"), named(Kinematics::BOTH, "BOTH")};

/// Condition for continuing the program. The argument is the number of the pin, joint or spindle.
enum class WaitFor : std::uint8_t {
    NOTHING,
    DWELL,
    DIGITAL_INPUT,
    ANALOG_INPUT,
    TOOL_PREPARED,
    TOOL_PREPARED_OFF,
    TOOL_CHANGED,
    TOOL_CHANGED_OFF,
    TOOL_START_CHANGE,
    TOOL_ABORT_TAKEN,
    TOOL_DATA,
    SPINDLE_ORIENTED,
    SETTING,
    USER_CODE,
    HOMING,
};
template <>
inline constexpr auto NAMES<WaitFor> = std::array{named(WaitFor::NOTHING, "NOTHING"),
                                                  named(WaitFor::DWELL, "DWELL"),
                                                  named(WaitFor::DIGITAL_INPUT, "DIGITAL_INPUT"),
                                                  named(WaitFor::ANALOG_INPUT, "ANALOG_INPUT"),
                                                  named(WaitFor::TOOL_PREPARED, "TOOL_PREPARED"),
                                                  named(WaitFor::TOOL_PREPARED_OFF, "TOOL_PREPARED_OFF"),
                                                  named(WaitFor::TOOL_CHANGED, "TOOL_CHANGED"),
                                                  named(WaitFor::TOOL_CHANGED_OFF, "TOOL_CHANGED_OFF"),
                                                  named(WaitFor::TOOL_START_CHANGE, "TOOL_START_CHANGE"),
                                                  named(WaitFor::TOOL_ABORT_TAKEN, "TOOL_ABORT_TAKEN"),
                                                  named(WaitFor::TOOL_DATA, "TOOL_DATA"),
                                                  named(WaitFor::SPINDLE_ORIENTED, "SPINDLE_ORIENTED"),
                                                  named(WaitFor::SETTING, "SETTING"),
                                                  named(WaitFor::USER_CODE, "USER_CODE"),
                                                  named(WaitFor::HOMING, "HOMING")};

/// Progress of a command. A command that takes time (homing, MDI, a program) is STARTED until it ends.
enum class Progress : std::uint8_t { STARTED, DONE, REFUSED, FAILED };
template <>
inline constexpr auto NAMES<Progress> =
    std::array{named(Progress::STARTED, "STARTED"), named(Progress::DONE, "DONE"),
               named(Progress::REFUSED, "REFUSED"), named(Progress::FAILED, "FAILED")};

enum class MessageKind : std::uint8_t { OPERATOR_ERROR = 11, OPERATOR_TEXT = 12, OPERATOR_DISPLAY = 13 };
template <>
inline constexpr auto NAMES<MessageKind> =
    std::array{named(MessageKind::OPERATOR_ERROR, "ERROR"), named(MessageKind::OPERATOR_TEXT, "TEXT"),
               named(MessageKind::OPERATOR_DISPLAY, "DISPLAY")};

}  // namespace mw::messages
