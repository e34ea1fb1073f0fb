// SPDX-License-Identifier: GPL-2.0-or-later
// The class of each command. One row of the table in admission.hh applies to all commands of a class.
#pragma once

#include <algorithm>
#include <array>

#include "base/overloaded.hh"
#include "machine/task/command.hh"

namespace mw::task {

enum class CommandClass : std::uint8_t {
    ANY_TIME,      ///< stops, messages, overrides, ends of actions
    MODE,          ///< manual, auto and MDI mode
    PROGRAM_FILE,  ///< opens programs and sets up the interpreter
    RUN,           ///< starts a program
    STEP,          ///< runs one block
    PAUSE,         ///< pauses
    RESUME,        ///< resumes after a pause
    TURN,          ///< reverse run and forward run
    MDI,           ///< one line, or a tap sent by a client
    JOG,           ///< jogs
    TELEOP,        ///< jogging of axes or joints
    JOINTS,        ///< homing of joints, and their limits and homing parameters
    UNHOME,        ///< marks joints as not homed
    ENERGISE,      ///< starts a spindle, coolant, lubrication
    TOOL_TABLE,    ///< reads the tool table again, or sets an entry
    SCREW_TABLE,   ///< settings that change only while the machine is off
    CONFIRM,       ///< confirms a proposed approach
    RELEASE,       ///< releases the axes of a paused program for jogging
    OF_THE_MAILBOX,
    COUNT
};

namespace command_lists {

template <class T>
concept Mode = OneOf<T, SetMode>;
template <class T>
concept ProgramFile = OneOf<T, OpenProgram, CloseProgram, ResetInterpreter, SynchInterpreter, ForgetRecovery>;
template <class T>
concept Run = OneOf<T, RunProgram, RecoverProgram>;
template <class T>
concept Step = OneOf<T, StepProgram>;
template <class T>
concept Pause = OneOf<T, PauseProgram, StopOptionally>;
template <class T>
concept Resume = OneOf<T, ResumeProgram>;
template <class T>
concept Turn = OneOf<T, ReverseProgram, ForwardProgram>;
template <class T>
concept Line = OneOf<T, Mdi, SetSpindleSync, RigidTapMove>;
template <class T>
concept Jog = OneOf<T, JogContinuous, JogIncrement, JogAbsolute, SetTeleopVector>;
template <class T>
concept Teleop = OneOf<T, SetTeleop, SetMotionMode>;
template <class T>
concept JointSetting = OneOf<T, SetJointMinLimit, SetJointMaxLimit, SetJointFerror, SetJointMinFerror,
                             SetJointBacklash, SetJointHoming>;
template <class T>
concept Joints = OneOf<T, HomeJoint> || JointSetting<T>;
template <class T>
concept Unhome = OneOf<T, UnhomeJoint>;
template <class T>
concept Energise =
    OneOf<T, SpindleOn, SpindleIncrease, SpindleDecrease, SpindleConstant, MistOn, FloodOn, LubeOn>;
template <class T>
concept ToolTable = OneOf<T, LoadToolTable, SetToolEntry, AddTool, RemoveTool>;
template <class T>
concept ScrewTable = OneOf<T, LoadCompensation>;
template <class T>
concept Confirm = OneOf<T, ConfirmApproach>;
template <class T>
concept Release = OneOf<T, ReleaseAxes>;
template <class T>
concept OfTheMailbox = OneOf<T, ClaimOperation, HandOverOperation, ReleaseOperation>;
/// Commands for the internal use of motion (machine/task/link/motion_words.hh).
template <class T>
concept CarriedOutByMotion =
    OneOf<T, SetFeedOverride, SetRapidOverride, SetSpindleOverride, SetMaxVelocity, EnableFeedOverride,
          EnableSpindleOverride, EnableFeedHold, EnableAdaptiveFeed, OverrideLimits, EnableJoint,
          DisableJoint, ActivateJoint, DeactivateJoint, ClearProbe, SetDigitalOutput, SetAnalogOutput,
          EngageBrake, ReleaseBrake>;
template <class T>
concept AnyTime =
    CarriedOutByMotion<T> ||
    OneOf<T, SetState, AbortAll, SetDebug, JogStop, SpindleOff, MistOff, FloodOff, LubeOff, SetOptionalStop,
          SetBlockDelete, ConfirmToolChange, Null, OperatorError, OperatorText, OperatorDisplay>;

}  // namespace command_lists

/// A command that is in none of the lists, or in several, does not compile.
template <class T>
constexpr CommandClass class_of() {
    using namespace command_lists;
    constexpr std::array IS_IN{AnyTime<T>,
                               command_lists::Mode<T>,
                               ProgramFile<T>,
                               Run<T>,
                               Step<T>,
                               Pause<T>,
                               Resume<T>,
                               Turn<T>,
                               Line<T>,
                               Jog<T>,
                               Teleop<T>,
                               Joints<T>,
                               command_lists::Unhome<T>,
                               Energise<T>,
                               command_lists::ToolTable<T>,
                               ScrewTable<T>,
                               Confirm<T>,
                               Release<T>,
                               OfTheMailbox<T>};
    static_assert(IS_IN.size() == static_cast<std::size_t>(CommandClass::COUNT));
    static_assert(std::count(IS_IN.begin(), IS_IN.end(), true) == 1, "each command is of one class");
    return static_cast<CommandClass>(std::find(IS_IN.begin(), IS_IN.end(), true) - IS_IN.begin());
}

/// Class of a command with its values. A spindle command with 0 rev/min is a stop, and selecting the current
/// mode changes nothing.
CommandClass class_of(const Command &command, messages::Mode mode);

}  // namespace mw::task
