// SPDX-License-Identifier: GPL-2.0-or-later
// Status of task, interpreter, tool changer and I/O.
#pragma once

#include <string>

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

struct Waiting {
    WaitFor what = WaitFor::NOTHING;
    int index = -1;
};
template <>
inline constexpr auto DECLARED<Waiting> =
    declare("Waiting", 0, "what has to happen before the program continues",
            field<&Waiting::what>("what", "kind"),
            field<&Waiting::index>("index", "number of the pin, joint or spindle; -1: all or none"));

/// "pin motion.digital-in-03", "the end of a dwell"; empty if task does not wait.
std::string waiting_text(const Waiting &waiting);

/// Maximum length of the program's path in the status. [bytes]
inline constexpr std::size_t MAX_STATUS_TEXT = 1023;
/// Maximum length of a block in the status; a longer block is cut at the end. [bytes]
inline constexpr std::size_t MAX_STATUS_BLOCK = 255;

struct TaskStatus {
    State state = State::ESTOP;
    Mode mode = Mode::MANUAL;
    InterpState interp_state = InterpState::IDLE;
    ExecState exec_state = ExecState::DONE;
    bool isAway = false;
    bool isPaused = false;
    bool isStoppedByProgram = false;
    bool isOptionalStop = true;
    bool isBlockDelete = true;
    int read_line = 0;
    int motion_line = 0;
    int stop_line = 0;
    std::uint64_t stops = 0;
    std::uint64_t blocks = 0;
    int call_level = 0;
    int queued_mdi = 0;
    std::uint64_t programs_ended = 0;
    Waiting waiting;
    double delay_left_s = 0;
    bool isInputTimedOut = false;
    int error_code = 0;
    alignas(8) FixedText<MAX_STATUS_TEXT> program;
    FixedText<MAX_STATUS_BLOCK> block;
};
template <>
inline constexpr auto DECLARED<TaskStatus> =
    declare("TaskStatus", 599, "states, program and place in it",
            field<&TaskStatus::state>("state", "of the machine"),
            field<&TaskStatus::mode>("mode", "of operation"),
            field<&TaskStatus::interp_state>("interp_state", "of the program"),
            field<&TaskStatus::exec_state>("exec_state", "what task waits for"),
            field<&TaskStatus::isAway>("is_away", "the axes of a paused program are released for jogs"),
            field<&TaskStatus::isPaused>("is_paused", "paused"),
            field<&TaskStatus::isStoppedByProgram>("stopped_by_program", "paused by M0, M1 or M60"),
            field<&TaskStatus::isOptionalStop>("optional_stop", "M1 stops"),
            field<&TaskStatus::isBlockDelete>("block_delete", "lines that begin with / are skipped"),
            field<&TaskStatus::program>("program", "path of the open program"),
            field<&TaskStatus::read_line>("read_line", "last line that the interpreter has read"),
            field<&TaskStatus::motion_line>("motion_line", "line of the move that is executed"),
            field<&TaskStatus::stop_line>("stop_line", "line of the last M0, M1 or M60 reached"),
            field<&TaskStatus::stops>("stops", "M0, M1 and M60 that have paused a program"),
            field<&TaskStatus::blocks>("blocks", "executed since the program started"),
            field<&TaskStatus::call_level>("call_level", "depth of subroutines"),
            field<&TaskStatus::queued_mdi>("queued_mdi", "lines of MDI that wait behind the one that runs"),
            field<&TaskStatus::programs_ended>("programs_ended", "by M2, M30, end of file, abort or error"),
            field<&TaskStatus::waiting>("waiting", "what the program waits for"),
            field<&TaskStatus::delay_left_s>("delay_left", "of a dwell", unit::SECOND),
            field<&TaskStatus::isInputTimedOut>("input_timeout", "the last M66 has timed out"),
            field<&TaskStatus::error_code>("error_code", "0; 5 after a program or line that failed"),
            field<&TaskStatus::block>("block", "that was read last; of MDI, the line"));

struct CodesStatus {
    std::array<int, 17> g{};
    std::array<int, 10> m{};
    std::array<double, 5> settings{};
};
template <>
inline constexpr auto DECLARED<CodesStatus> =
    declare("CodesStatus", 0, "active modal codes",
            field<&CodesStatus::g>("g", "[0] sequence number, then ten times the code, -1 none"),
            field<&CodesStatus::m>("m", "[0] sequence number, then codes, -1 none"),
            field<&CodesStatus::settings>("settings", "sequence number, feed, speed, G64 P, G64 Q"));

struct OffsetsStatus {
    int g5x_index = 1;
    geometry::Pose g5x;
    geometry::Pose g92;
    geometry::Pose tool;
    double rotation_xy_deg = 0;
};
template <>
inline constexpr auto DECLARED<OffsetsStatus> =
    declare("OffsetsStatus", 0, "active offsets",
            field<&OffsetsStatus::g5x_index>("g5x_index", "1 G54 ... 9 G59.3"),
            field<&OffsetsStatus::g5x>("g5x", "work offset", unit::POSE),
            field<&OffsetsStatus::g92>("g92", "G92 offset", unit::POSE),
            field<&OffsetsStatus::tool>("tool", "tool offset", unit::POSE),
            field<&OffsetsStatus::rotation_xy_deg>("rotation_xy_deg", "of the coordinate system about Z",
                                                   unit::DEGREE));

struct ApproachMove {
    geometry::Pose end;
    bool isRapid = true;
};
template <>
inline constexpr auto DECLARED<ApproachMove> =
    declare("ApproachMove", 0, "a move of an approach",
            field<&ApproachMove::end>("end", "where it ends, machine coordinates", unit::POSE),
            field<&ApproachMove::isRapid>("rapid", "a rapid; else at feed"));

inline constexpr std::size_t MAX_APPROACH_MOVES = 4;
/// Maximum length of an explanation in the status. [bytes]
inline constexpr std::size_t MAX_STATUS_REASON = 255;

/// Active codes and offsets at the position where a program will resume, and the approach to it.
struct ApproachStatus {
    std::uint64_t number = 0;
    ApproachTo to = ApproachTo::NOTHING;
    int line = 0;
    int tool = 0;
    bool mustChangeTool = false;
    bool isMistOn = false;
    bool isFloodOn = false;
    double feed = 0;
    std::array<double, MAX_SPINDLES> speeds_rpm{};
    OffsetsStatus offsets;
    CodesStatus codes;
    std::uint32_t num_moves = 0;
    std::array<ApproachMove, MAX_APPROACH_MOVES> moves{};
};
template <>
inline constexpr auto DECLARED<ApproachStatus> =
    declare("ApproachStatus", 0,
            "how a program is to resume; ConfirmApproach with its number executes the moves",
            field<&ApproachStatus::number>("number", "of the proposal, 0: none"),
            field<&ApproachStatus::to>("to", "target of the moves"),
            field<&ApproachStatus::line>("line", "that is executed next"),
            field<&ApproachStatus::tool>("tool", "that is to be in the spindle, 0 none"),
            field<&ApproachStatus::mustChangeTool>("must_change_tool", "another is in the spindle now"),
            field<&ApproachStatus::isMistOn>("mist", "mist is switched on before the last move"),
            field<&ApproachStatus::isFloodOn>("flood", "flood is switched on before the last move"),
            field<&ApproachStatus::feed>("feed", "of the last move", unit::SPEED),
            field<&ApproachStatus::speeds_rpm>("speeds_rpm",
                                               "of the spindles that start before the last move", unit::RPM),
            field<&ApproachStatus::offsets>("offsets", "active at that line"),
            field<&ApproachStatus::codes>("codes", "active at that line"),
            field<&ApproachStatus::num_moves>("num_moves", "number of moves"),
            field<&ApproachStatus::moves>("moves", "in their order"));

struct RecoveryStatus {
    bool isOffered = false;
    int line = 0;
    std::uint64_t block = 0;
    FixedText<MAX_STATUS_TEXT> program;
    FixedText<MAX_STATUS_REASON> refusal;
};
template <>
inline constexpr auto DECLARED<RecoveryStatus> =
    declare("RecoveryStatus", 0, "the program that was interrupted when the controller last ended",
            field<&RecoveryStatus::isOffered>("offered", "RecoverProgram resumes it"),
            field<&RecoveryStatus::line>("line", "at which it resumes"),
            field<&RecoveryStatus::block>("block", "the same as a number, of the blocks since the start"),
            field<&RecoveryStatus::program>("program", "path"),
            field<&RecoveryStatus::refusal>(
                "refusal", "why it cannot resume; empty: it can, or no program was interrupted"));

struct ToolStatus {
    int in_spindle = 0;
    int from_pocket = 0;
    int prepared_index = -1;
    std::uint64_t table_version = 0;
    bool isPersonAsked = false;
    bool isFaulted = false;
    double cut_time_s = 0;
    double cut_length = 0;
};
template <>
inline constexpr auto DECLARED<ToolStatus> = declare(
    "ToolStatus", 1199, "the tool changer",
    field<&ToolStatus::in_spindle>("in_spindle", "number of the tool, 0 none"),
    field<&ToolStatus::from_pocket>("from_pocket", "where it was taken from"),
    field<&ToolStatus::prepared_index>("prepared_index", "entry of the tool table prepared by T, -1 none"),
    field<&ToolStatus::table_version>("table_version", "counts changes of the tool table"),
    field<&ToolStatus::isPersonAsked>("person_asked", "task waits for ConfirmToolChange"),
    field<&ToolStatus::isFaulted>("faulted", "the changer has reported a fault that is not cleared"),
    field<&ToolStatus::cut_time_s>("cut_time_s", "that the tool in the spindle has cut in its life",
                                   unit::SECOND),
    field<&ToolStatus::cut_length>("cut_length", "that it has cut", unit::LENGTH));

struct AuxStatus {
    bool isEstopRequested = true;
    bool isChainClosed = false;
};
template <>
inline constexpr auto DECLARED<AuxStatus> =
    declare("AuxStatus", 1299, "the e-stop chain",
            field<&AuxStatus::isEstopRequested>("estop_requested", "our side of the chain is open"),
            field<&AuxStatus::isChainClosed>("chain_closed", "pin iocontrol.0.emc-enable-in"));

struct CoolantStatus {
    bool isMistOn = false;
    bool isFloodOn = false;
};
template <>
inline constexpr auto DECLARED<CoolantStatus> =
    declare("CoolantStatus", 1499, "coolant", field<&CoolantStatus::isMistOn>("mist", "mist is on"),
            field<&CoolantStatus::isFloodOn>("flood", "flood is on"));

struct LubeStatus {
    bool isOn = false;
    bool hasOil = true;
};
template <>
inline constexpr auto DECLARED<LubeStatus> =
    declare("LubeStatus", 1599, "lubrication", field<&LubeStatus::isOn>("on", "lubrication is on"),
            field<&LubeStatus::hasOil>("level_ok", "pin iocontrol.0.lube_level"));

struct IoStatus {
    AuxStatus aux;
    CoolantStatus coolant;
    LubeStatus lube;
};
template <>
inline constexpr auto DECLARED<IoStatus> =
    declare("IoStatus", 1699, "the I/O controller", field<&IoStatus::aux>("aux", "e-stop chain"),
            field<&IoStatus::coolant>("coolant", "mist and flood"),
            field<&IoStatus::lube>("lube", "lubrication"));

}  // namespace mw::messages
