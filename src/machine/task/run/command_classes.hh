// SPDX-License-Identifier: GPL-2.0-or-later
// What kind of thing each command asks for: one row of the table in admission.hh decides for all of a kind.
#pragma once

#include <algorithm>
#include <array>

#include "base/overloaded.hh"
#include "machine/task/command.hh"

namespace mw::task {

enum class CommandClass : std::uint8_t {
    ANY_TIME,        ///< stops, messages, overrides, what ends something
    MODE,            ///< what manual, auto and MDI are
    PROGRAM_FILE,    ///< which program is open, and what the interpreter is set to
    RUN,             ///< begins a program
    STEP,            ///< one block
    PAUSE,           ///< holds what runs
    RESUME,          ///< goes on after a hold
    TURN,            ///< backwards along the path, and forwards again
    MDI,             ///< one line, or a tap that a client sends
    JOG,             ///< moves by hand
    TELEOP,          ///< whether moves by hand are those of axes or of joints
    JOINTS,          ///< homing of joints, and their limits and homing parameters
    UNHOME,          ///< forgets where joints are
    ENERGISE,        ///< starts a spindle, coolant, lubrication
    TOOL_TABLE,      ///< reads it again, or sets an entry
    SCREW_TABLE,     ///< what is set only while the machine is off
    CONFIRM,         ///< of an approach that is proposed
    RELEASE,         ///< lets the axes of a held program be jogged
    OF_THE_MAILBOX,  ///< the right to operate: the mailbox executes them
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
/// What motion does by itself (machine/task/link/motion_words.hh).
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

/// A command that stands in none of the lists, or in several, does not compile.
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

/// Of a command as it is given: a spindle at 0 rev/min is a stop, and the mode that is in force already
/// changes nothing.
CommandClass class_of(const Command &command, messages::Mode mode);

}  // namespace mw::task
