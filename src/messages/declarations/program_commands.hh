// SPDX-License-Identifier: GPL-2.0-or-later
// Commands for the machine's state, modes, programs and lines, and texts for the operator.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

/// Maximum length of a path and of an MDI line. [bytes]
inline constexpr std::size_t MAX_TEXT = 1023;
inline constexpr Range LINE{1, MAX_TEXT};

struct SetState {
    State state = State::ESTOP;
};
template <>
inline constexpr auto DECLARED<SetState> =
    declare("SetState", 505, "switches the machine on or off, sets or resets the emergency stop",
            field<&SetState::state>("state", "wanted state; done when it is reached"));

struct SetMode {
    Mode mode = Mode::MANUAL;
};
template <>
inline constexpr auto DECLARED<SetMode> =
    declare("SetMode", 504, "sets the mode of operation; done when motion has followed",
            field<&SetMode::mode>("mode", "rejected while a program or line runs"));

struct OpenProgram {
    std::string path;
};
template <>
inline constexpr auto DECLARED<OpenProgram> =
    declare("OpenProgram", 506, "opens a program",
            field<&OpenProgram::path>("path", "of the file", unit::NONE, LINE));

struct RunProgram {
    int from_line = 0;  ///< line of the main program; earlier lines are interpreted without motion
};
template <>
inline constexpr auto DECLARED<RunProgram> =
    declare("RunProgram", 507, "runs the open program; done at its end",
            optional(field<&RunProgram::from_line>(
                "from_line",
                "0 and 1: the start; above: the lines before are calculated, and the approach is confirmed; "
                "-1: only reads it",
                unit::NONE, range(-1, 1e9))));

/// A person has seen the moves in ApproachStatus and confirms them.
struct ConfirmApproach {
    std::uint64_t number = 0;
};
template <>
inline constexpr auto DECLARED<ConfirmApproach> =
    declare("ConfirmApproach", 3005, "executes the proposed moves, then resumes the program",
            field<&ConfirmApproach::number>("number", "of the proposal, as ApproachStatus shows it"));

/// For a paused program: it resumes at the position where it was paused.
struct ReleaseAxes {};
template <>
inline constexpr auto DECLARED<ReleaseAxes> =
    declare("ReleaseAxes", 3006, "permits jogs of the axes while a program is paused");

struct RecoverProgram {};
template <>
inline constexpr auto DECLARED<RecoverProgram> =
    declare("RecoverProgram", 3007,
            "resumes the program that a power cut or a crash has ended, once the approach is confirmed");

struct ForgetRecovery {};
template <>
inline constexpr auto DECLARED<ForgetRecovery> =
    declare("ForgetRecovery", 3008, "withdraws the offer to resume an interrupted program");

struct Mdi {
    std::string line;
};
template <>
inline constexpr auto DECLARED<Mdi> =
    declare("Mdi", 509, "executes one line; done at its end",
            field<&Mdi::line>("line", "of G-code", unit::NONE, range(0, MAX_TEXT)));

struct PauseProgram {};
template <>
inline constexpr auto DECLARED<PauseProgram> =
    declare("PauseProgram", 510, "pauses the program or MDI line on its path");

/// Runs one block and pauses; starts the program when idle.
struct StepProgram {};
template <>
inline constexpr auto DECLARED<StepProgram> =
    declare("StepProgram", 511, "runs one block and pauses; starts the program when idle");

struct ResumeProgram {};
template <>
inline constexpr auto DECLARED<ResumeProgram> =
    declare("ResumeProgram", 512, "resumes after a pause or a program stop");

struct CloseProgram {};
template <>
inline constexpr auto DECLARED<CloseProgram> = declare("CloseProgram", 514, "closes the open program");

struct ResetInterpreter {};
template <>
inline constexpr auto DECLARED<ResetInterpreter> =
    declare("ResetInterpreter", 515, "ends the active work of the interpreter and closes the program");

struct SynchInterpreter {};
template <>
inline constexpr auto DECLARED<SynchInterpreter> = declare(
    "SynchInterpreter", 516, "takes the machine's position as the program's; writes the parameter file");

struct SetOptionalStop {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<SetOptionalStop> =
    declare("SetOptionalStop", 517, "says whether M1 stops", field<&SetOptionalStop::isOn>("on", "M1 stops"));

struct SetBlockDelete {
    bool isOn = true;
};
template <>
inline constexpr auto DECLARED<SetBlockDelete> =
    declare("SetBlockDelete", 518, "says whether lines that begin with / are left out",
            field<&SetBlockDelete::isOn>("on", "such lines are left out"));

struct StopOptionally {};
template <>
inline constexpr auto DECLARED<StopOptionally> =
    declare("StopOptionally", 519, "holds as M1 does, where optional stops are on");

struct ReverseProgram {};
template <>
inline constexpr auto DECLARED<ReverseProgram> =
    declare("ReverseProgram", 520, "goes back along the path, of a held program when it is resumed");

struct ForwardProgram {};
template <>
inline constexpr auto DECLARED<ForwardProgram> =
    declare("ForwardProgram", 521, "goes forward along the path again");

/// The operator's abort: accepted from every client.
struct AbortAll {};
template <>
inline constexpr auto DECLARED<AbortAll> =
    declare("AbortAll", 503, "stops everything along its path within the limits");

struct Null {};
template <>
inline constexpr auto DECLARED<Null> = declare("Null", 21, "does nothing; shows that commands are taken");

struct SetDebug {
    std::uint32_t mask = 0;
};
template <>
inline constexpr auto DECLARED<SetDebug> =
    declare("SetDebug", 22, "sets what is logged, as [EMC]DEBUG", field<&SetDebug::mask>("mask", "bits"));

/// Texts for the operator, from task, or from a client to all other clients.
struct OperatorError {
    std::string text;
};
template <>
inline constexpr auto DECLARED<OperatorError> =
    declare("OperatorError", 11, "an error for the operator",
            field<&OperatorError::text>("text", "what, where, what to do", unit::NONE, LINE));
struct OperatorText {
    std::string text;
};
template <>
inline constexpr auto DECLARED<OperatorText> =
    declare("OperatorText", 12, "a note for the operator",
            field<&OperatorText::text>("text", "the note", unit::NONE, LINE));
struct OperatorDisplay {
    std::string text;
};
template <>
inline constexpr auto DECLARED<OperatorDisplay> =
    declare("OperatorDisplay", 13, "a message of the program, as (MSG) and (DEBUG)",
            field<&OperatorDisplay::text>("text", "the message", unit::NONE, LINE));

// --- the right to operate, managed by the mailbox

/// From now on only commands of this client are accepted, except e-stop, abort, hold and the commands of
/// halui.
struct ClaimOperation {
    double lease_s = 5;
};
template <>
inline constexpr auto DECLARED<ClaimOperation> =
    declare("ClaimOperation", 3001, "requests the exclusive right to operate, or renews it",
            optional(field<&ClaimOperation::lease_s>("lease_s", "it ends by itself after so long",
                                                     unit::SECOND, range(0.1, 3600))));
struct HandOverOperation {
    std::uint32_t client = 0;
};
template <>
inline constexpr auto DECLARED<HandOverOperation> =
    declare("HandOverOperation", 3002, "gives the right to operate to another client",
            field<&HandOverOperation::client>("client", "number of a connected client"));
struct ReleaseOperation {};
template <>
inline constexpr auto DECLARED<ReleaseOperation> =
    declare("ReleaseOperation", 3003, "opens the machine to all clients again");

}  // namespace mw::messages
