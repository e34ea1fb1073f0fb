// SPDX-License-Identifier: GPL-2.0-or-later
// What an operator, a screen or another program asks of task. Each command ends as done or refused with a
// reason.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace mw::task {

enum class State : std::uint8_t {
    ESTOP = 1,
    ESTOP_RESET = 2,
    OFF = 3,
    ON = 4
};  ///< numbers of the reference's status
enum class Mode : std::uint8_t { MANUAL = 1, AUTO = 2, MDI = 3 };

struct SetState {
    State state = State::ESTOP;
};
struct SetMode {
    Mode mode = Mode::MANUAL;
};
struct OpenProgram {
    std::string path;
};
struct RunProgram {
    int from_line = 0;  ///< only 0 and 1 (the start) are supported
};
struct StepProgram {};  ///< runs one block and pauses; starts the program when idle
struct PauseProgram {};
struct ResumeProgram {};
struct AbortAll {};
struct Mdi {
    std::string line;
};
struct SetOptionalStop {
    bool isOn = true;
};
struct SetBlockDelete {
    bool isOn = true;
};

enum class Override : std::uint8_t { FEED, RAPID, SPINDLE };
struct SetOverride {
    Override what = Override::FEED;
    double factor = 1.0;  ///< 1.0 is 100 %
    int spindle = 0;
};
struct SetMaxVelocity {
    double velocity = 0;  ///< [machine units/s]
};
struct SetTeleop {
    bool isTeleop = true;  ///< false: free (joint) mode
};
struct HomeJoint {
    int joint = -1;  ///< -1: all
};
struct UnhomeJoint {
    int joint = -1;
};
enum class JogKind : std::uint8_t { CONTINUOUS, INCREMENTAL, ABSOLUTE, STOP };
struct Jog {
    JogKind kind = JogKind::STOP;
    bool isJoint = true;
    int index = 0;
    double velocity = 0;  ///< [units/s]
    double distance = 0;  ///< or the target of an absolute jog
};
struct OverrideLimits {};
struct Spindle {
    int spindle = 0;
    double speed_rpm = 0;  ///< signed; 0 stops
};
struct SpindleBrake {
    int spindle = 0;
    bool isOn = false;
};
struct Coolant {
    bool isMist = false;
    bool isOn = false;
};
struct LoadToolTable {};

using Command =
    std::variant<SetState, SetMode, OpenProgram, RunProgram, StepProgram, PauseProgram, ResumeProgram,
                 AbortAll, Mdi, SetOptionalStop, SetBlockDelete, SetOverride, SetMaxVelocity, SetTeleop,
                 HomeJoint, UnhomeJoint, Jog, OverrideLimits, Spindle, SpindleBrake, Coolant, LoadToolTable>;

/// How far a command has come. A command that takes time (homing, MDI, a program) is STARTED until it ends.
enum class Progress : std::uint8_t { STARTED, DONE, REFUSED, FAILED };

}  // namespace mw::task
