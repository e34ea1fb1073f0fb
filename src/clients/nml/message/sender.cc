// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/message/sender.hh"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "clients/nml/message/vocabulary.hh"
#include "messages/declarations/command.hh"

namespace mw::nml {
namespace {

using namespace messages;

template <class T>
concept OfInterpreter =
    OneOf<T, LinearMove, CircularMove, ProbeMove, Delay, SetTermination, SetG5x, SetG92, SetRotation,
          SetToolOffset, SetTrajVelocity, SetTrajAcceleration, SetMotionId, OrientSpindle, WaitOriented,
          WaitInput, PrepareTool, LoadTool, UnloadTool, SetToolNumber, StartToolChange, SetToolEntry,
          ClearProbe, SetSpindleSpeed, CallTaskPlugin, CallIoPlugin>;

template <class T>
concept OfStart = OneOf<T, SetJointKind, SetJointUnits, SetJointMaxVelocity, SetTrajAxes, SetTrajUnits,
                        SetTrajCycleTime, SetMaxAcceleration, SetTrajHome, SetIoCycleTime, InitTask, HaltTask,
                        InitMachine, HaltMachine, InitMotion, HaltMotion, InitTraj, HaltTraj, InitJoint,
                        HaltJoint, InitTool, HaltTool, InitIo, HaltIo>;

template <class T>
concept OfOperator =
    OneOf<T, SetState, SetMode, OpenProgram, RunProgram, ConfirmApproach, ReleaseAxes, RecoverProgram,
          ForgetRecovery, ReadProgram, Mdi, PauseProgram, StepProgram, ResumeProgram, EndProgram,
          CloseProgram, ResetInterpreter, SynchInterpreter, SetOptionalStop, SetBlockDelete, StopOptionally,
          ReverseProgram, ForwardProgram, AbortAll, AbortMachine, Null, SetDebug, SystemCommand,
          OperatorError, OperatorText, OperatorDisplay, ClaimOperation, HandOverOperation,
          ReleaseOperation> ||
    OneOf<T, HomeJoint, UnhomeJoint, JogContinuous, JogIncrement, JogAbsolute, JogStop, OverrideLimits,
          AbortJoint, EnableJoint, DisableJoint, ActivateJoint, DeactivateJoint, LoadCompensation,
          SetJointMinLimit, SetJointMaxLimit, SetJointFerror, SetJointMinFerror, SetJointBacklash,
          SetJointHoming> ||
    OneOf<T, SetFeedOverride, SetRapidOverride, SetSpindleOverride, EnableFeedOverride, EnableSpindleOverride,
          EnableFeedHold, EnableAdaptiveFeed, SetMaxVelocity, SetTeleop, SetMotionMode, SetTeleopVector,
          EnableTraj, DisableTraj, AbortTraj, PauseTraj, StepTraj, ResumeTraj, AbortMotion, SetAnalogOutput,
          SetDigitalOutput, SetSpindleSync, RigidTapMove> ||
    OneOf<T, SpindleOn, SpindleOff, SpindleIncrease, SpindleDecrease, SpindleConstant, ReleaseBrake,
          EngageBrake, MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff, EstopOn, EstopOff, EstopReset,
          AbortTool, LoadToolTable, AddTool, RemoveTool, ConfirmToolChange, AbortIo>;

/// A command in none or in several of the lists does not compile.
template <class T>
constexpr Sender sender() {
    static_assert(OfInterpreter<T> + OfStart<T> + OfOperator<T> == 1, "each command has one sender");
    return OfInterpreter<T> ? Sender::INTERPRETER : OfStart<T> ? Sender::START : Sender::OPERATOR;
}

struct Row {
    const Declaration *declaration;
    Sender sender;
};

template <class... Body>
constexpr auto rows(std::type_identity<std::variant<Body...>>) {
    return std::array{Row{&DECLARATION<Body>, sender<Body>()}...};
}
constexpr auto ROWS = rows(std::type_identity<CommandVariant>{});

const char *words_of(Sender sender) {
    switch (sender) {
    case Sender::OPERATOR: return "operator";
    case Sender::INTERPRETER: return "interpreter";
    case Sender::START: return "start";
    case Sender::STATUS: return "status";
    }
    return "";
}

}  // namespace

Sender sender_of(const Declaration &declaration) {
    const auto found = std::find_if(ROWS.begin(), ROWS.end(),
                                    [&](const Row &row) { return row.declaration == &declaration; });
    return found == ROWS.end() ? Sender::STATUS : found->sender;
}

std::string nml_reference_page() {
    std::string page = "# NML messages\n"
                       "Generated from the declarations in "
                       "`src/messages/declarations`; the fields "
                       "of each message are in\n"
                       "`messages.md`. Who sends it: *operator*: screens, panels and other programs; "
                       "*interpreter*: a word of G-code,\n"
                       "an operator gives it as G-code (`EMC_TASK_PLAN_EXECUTE_TYPE`); *start*: the INI file "
                       "and the start and end of\n"
                       "the machine; *status*: the machine itself, to all who listen. Which commands a "
                       "machine carries out is said by\n"
                       "their outcome: what it does not carry out it refuses with the reason. 11 to 13 also "
                       "come from the machine, on\n"
                       "the channel of errors.\n"
                       "\n"
                       "| number | name | message | class | sent by |\n"
                       "|---|---|---|---|---|\n";
    const Vocabulary vocabulary = Vocabulary::standard();
    for (const auto &[number, kind] : vocabulary.kinds()) {
        const Declaration &declaration = *kind.declaration;
        page += fmt::format("| {} | {} | {} | {} | {} |\n", number, declaration.nml, declaration.name,
                            name_of(kind.base), words_of(sender_of(declaration)));
    }
    return page;
}

}  // namespace mw::nml
