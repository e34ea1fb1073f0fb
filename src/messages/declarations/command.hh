// SPDX-License-Identifier: GPL-2.0-or-later
// All commands: requests of an operator, a screen or another program to the machine. Each command ends as
// done, or as rejected or failed with a reason.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>

#include "base/overloaded.hh"
#include "messages/declarations/device_commands.hh"
#include "messages/declarations/joint_commands.hh"
#include "messages/declarations/motion_commands.hh"
#include "messages/declarations/program_commands.hh"

namespace mw::messages {

using CommandVariant = std::variant<
    SetState, SetMode, OpenProgram, RunProgram, ConfirmApproach, ReleaseAxes, RecoverProgram, ForgetRecovery,
    Mdi, PauseProgram, StepProgram, ResumeProgram, CloseProgram, ResetInterpreter, SynchInterpreter,
    SetOptionalStop, SetBlockDelete, StopOptionally, ReverseProgram, ForwardProgram, AbortAll, Null, SetDebug,
    OperatorError, OperatorText, OperatorDisplay, ClaimOperation, HandOverOperation, ReleaseOperation,
    HomeJoint, UnhomeJoint, JogContinuous, JogIncrement, JogAbsolute, JogStop, OverrideLimits,
    SetJointMinLimit, SetJointMaxLimit, SetJointFerror, SetJointMinFerror, SetJointBacklash, SetJointHoming,
    EnableJoint, DisableJoint, ActivateJoint, DeactivateJoint, LoadCompensation, SetFeedOverride,
    SetRapidOverride, SetSpindleOverride, EnableFeedOverride, EnableSpindleOverride, EnableFeedHold,
    EnableAdaptiveFeed, SetMaxVelocity, SetTeleop, SetMotionMode, SetTeleopVector, ClearProbe, SetSpindleSync,
    RigidTapMove, SetAnalogOutput, SetDigitalOutput, SpindleOn, SpindleOff, SpindleIncrease, SpindleDecrease,
    SpindleConstant, ReleaseBrake, EngageBrake, MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff,
    LoadToolTable, SetToolEntry, AddTool, RemoveTool, ConfirmToolChange>;

/// Index of a message in the variant.
template <class Message, class Variant>
inline constexpr std::size_t INDEX_IN = 0;
template <class Message, class... All>
inline constexpr std::size_t INDEX_IN<Message, std::variant<All...>> = [] {
    constexpr std::array IS_IT{std::is_same_v<Message, All>...};
    return static_cast<std::size_t>(std::find(IS_IT.begin(), IS_IT.end(), true) - IS_IT.begin());
}();

/// One of the commands. The operations of this large variant are compiled once, in command.cc.
class Command : public CommandVariant {
  public:
    using Variant = CommandVariant;
    Command();
    template <AlternativeOf<CommandVariant> Message>
    Command(Message message) : Command(INDEX_IN<Message, CommandVariant>, &message) {}
    Command(const Command &other);
    Command(Command &&other) noexcept;
    Command &operator=(const Command &other);
    Command &operator=(Command &&other) noexcept;
    ~Command();

  private:
    /// `message` is the alternative with that index; its content is moved.
    Command(std::size_t index, void *message);
};

}  // namespace mw::messages
