// SPDX-License-Identifier: GPL-2.0-or-later
// Canon calls except motion: spindles, tools, switches, program flow, texts. canon_calls.hh explains NAME and
// FIELDS.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "gcode/canon/canon_moves.hh"
#include "gcode/tools/entry.hh"

namespace mw::gcode {

using tools::ToolEntry;

// ---- spindles and tools -----------------------------------------------------------------------------------

/// G96 and G97.
struct SetSpindleMode {
    int spindle = 0;
    double css_max_rpm = 0;  ///< > 0: constant surface speed with this maximum [rev/min]; 0: constant speed

    static constexpr std::string_view NAME = "SET_SPINDLE_MODE";
    static constexpr std::tuple FIELDS{&SetSpindleMode::spindle, &SetSpindleMode::css_max_rpm};
};

/// S.
struct SetSpindleSpeed {
    int spindle = 0;
    double speed = 0;  ///< [rev/min; under constant surface speed metres/min or feet/min]

    static constexpr std::string_view NAME = "SET_SPINDLE_SPEED";
    static constexpr std::tuple FIELDS{&SetSpindleSpeed::spindle, &SetSpindleSpeed::speed};
};

/// M3, M4.
struct StartSpindle {
    int spindle = 0;
    bool clockwise = true;
    bool waiting = true;  ///< the next cut waits until the spindle is at speed

    int direction() const { return clockwise ? 1 : -1; }

    static constexpr std::array<std::string_view, 2> NAMES{"START_SPINDLE_COUNTERCLOCKWISE",
                                                           "START_SPINDLE_CLOCKWISE"};
    static constexpr std::tuple CHOICES{&StartSpindle::clockwise};
    static constexpr std::tuple FIELDS{&StartSpindle::spindle};
};

/// M5.
struct StopSpindle {
    int spindle = 0;

    static constexpr std::string_view NAME = "STOP_SPINDLE_TURNING";
    static constexpr std::tuple FIELDS{&StopSpindle::spindle};
};

/// M19.
struct OrientSpindle {
    int spindle = 0;
    double angle_deg = 0;
    int mode = 0;  ///< M19 P: 0 the shorter way, 1 clockwise, 2 counterclockwise

    static constexpr std::string_view NAME = "ORIENT_SPINDLE";
    static constexpr std::tuple FIELDS{&OrientSpindle::spindle, &OrientSpindle::angle_deg,
                                       &OrientSpindle::mode};
};

/// M19 Q: waits until the spindle is oriented.
struct WaitOrientComplete {
    int spindle = 0;
    double timeout_s = 0;  ///< a longer time is an error

    static constexpr std::string_view NAME = "WAIT_ORIENT_COMPLETE";
};

/// T: prepares this tool in the changer.
struct SelectTool {
    int toolno = 0;

    static constexpr std::string_view NAME = "SELECT_TOOL";
    static constexpr std::tuple FIELDS{&SelectTool::toolno};
};

/// M6: loads the selected tool into the spindle.
struct ChangeTool {
    static constexpr std::string_view NAME = "CHANGE_TOOL";
    static constexpr std::tuple<> FIELDS{};
};

/// M61: sets the tool in the spindle without a change.
struct ChangeToolNumber {
    int toolno = 0;

    static constexpr std::string_view NAME = "CHANGE_TOOL_NUMBER";
    static constexpr std::tuple FIELDS{&ChangeToolNumber::toolno};
};

/// G10 L1, L10, L11: changes an entry of the tool table.
struct SetToolTableEntry {
    int index = 0;    ///< in the tool table
    ToolEntry entry;  ///< [machine units, degrees]

    static constexpr std::string_view NAME = "SET_TOOL_TABLE_ENTRY";
};

/// G10 L0: reads the tool table from its file again.
struct ReloadTools {
    static constexpr std::string_view NAME = "RELOAD_TOOLDATA";
    static constexpr std::tuple<> FIELDS{};
};

// ---- switches, outputs, inputs ----------------------------------------------------------------------------

/// M7, M9.
struct SwitchMist {
    bool isOn = false;

    static constexpr std::array<std::string_view, 2> NAMES{"MIST_OFF", "MIST_ON"};
    static constexpr std::tuple CHOICES{&SwitchMist::isOn};
    static constexpr std::tuple<> FIELDS{};
};

/// M8, M9.
struct SwitchFlood {
    bool isOn = false;

    static constexpr std::array<std::string_view, 2> NAMES{"FLOOD_OFF", "FLOOD_ON"};
    static constexpr std::tuple CHOICES{&SwitchFlood::isOn};
    static constexpr std::tuple<> FIELDS{};
};

/// M48 to M50: enables the operator's feed override.
struct SwitchFeedOverride {
    bool isOn = true;

    static constexpr std::array<std::string_view, 2> NAMES{"DISABLE_FEED_OVERRIDE", "ENABLE_FEED_OVERRIDE"};
    static constexpr std::tuple CHOICES{&SwitchFeedOverride::isOn};
    static constexpr std::tuple<> FIELDS{};
};

/// M48, M49, M51: enables the operator's spindle override.
struct SwitchSpeedOverride {
    int spindle = 0;
    bool isOn = true;

    static constexpr std::array<std::string_view, 2> NAMES{"DISABLE_SPEED_OVERRIDE", "ENABLE_SPEED_OVERRIDE"};
    static constexpr std::tuple CHOICES{&SwitchSpeedOverride::isOn};
    static constexpr std::tuple FIELDS{&SwitchSpeedOverride::spindle};
};

/// M53: enables pin motion.feed-hold.
struct SwitchFeedHold {
    bool isOn = true;

    static constexpr std::array<std::string_view, 2> NAMES{"DISABLE_FEED_HOLD", "ENABLE_FEED_HOLD"};
    static constexpr std::tuple CHOICES{&SwitchFeedHold::isOn};
    static constexpr std::tuple<> FIELDS{};
};

/// M52: enables pin motion.adaptive-feed.
struct SwitchAdaptiveFeed {
    bool isOn = true;

    static constexpr std::array<std::string_view, 2> NAMES{"DISABLE_ADAPTIVE_FEED", "ENABLE_ADAPTIVE_FEED"};
    static constexpr std::tuple CHOICES{&SwitchAdaptiveFeed::isOn};
    static constexpr std::tuple<> FIELDS{};
};

/// M62 to M65.
struct SetDigitalOutput {
    int index = 0;
    bool isOn = false;
    bool synched = false;  ///< with the next motion (M62, M63), else at once (M64, M65)

    static constexpr std::array<std::string_view, 4> NAMES{
        "CLEAR_AUX_OUTPUT_BIT", "SET_AUX_OUTPUT_BIT", "CLEAR_MOTION_OUTPUT_BIT", "SET_MOTION_OUTPUT_BIT"};
    static constexpr std::tuple CHOICES{&SetDigitalOutput::isOn, &SetDigitalOutput::synched};
    static constexpr std::tuple FIELDS{&SetDigitalOutput::index};
};

/// M67, M68.
struct SetAnalogOutput {
    int index = 0;
    double value = 0;
    bool synched = false;  ///< with the next motion (M67), else at once (M68)

    static constexpr std::array<std::string_view, 2> NAMES{"SET_AUX_OUTPUT_VALUE", "SET_MOTION_OUTPUT_VALUE"};
    static constexpr std::tuple CHOICES{&SetAnalogOutput::synched};
};

/// M66.
struct WaitInput {
    int index = 0;  ///< index of a digital or an analog input
    bool isAnalog = false;
    WaitKind kind = WaitKind::IMMEDIATE;
    double timeout_s = 0;

    static constexpr std::string_view NAME = "WAIT";
};

// ---- program flow -----------------------------------------------------------------------------------------

/// M0, M60; M1.
struct ProgramStop {
    bool optional = false;  ///< stops only if the operator has enabled optional stops

    static constexpr std::array<std::string_view, 2> NAMES{"PROGRAM_STOP", "OPTIONAL_PROGRAM_STOP"};
    static constexpr std::tuple CHOICES{&ProgramStop::optional};
    static constexpr std::tuple<> FIELDS{};
};

/// M2, M30.
struct ProgramEnd {
    static constexpr std::string_view NAME = "PROGRAM_END";
    static constexpr std::tuple<> FIELDS{};
};

/// M60 and M30: exchanges the pallets. The stop of M60 is a separate call.
struct PalletShuttle {
    static constexpr std::string_view NAME = "PALLET_SHUTTLE";
    static constexpr std::tuple<> FIELDS{};
};

/// Waits until all motion has ended. Called when the file ends without M2.
struct Finish {
    static constexpr std::string_view NAME = "FINISH";
    static constexpr std::tuple<> FIELDS{};
};

/// A user M code M100 to M199.
struct UserCode {
    int code = 100;
    double p = 0, q = 0;  ///< words of the code; -1 when not programmed

    static constexpr std::string_view NAME = "USER_DEFINED_FUNCTION";
    static constexpr std::tuple FIELDS{&UserCode::code, &UserCode::p, &UserCode::q};
};

// ---- texts ------------------------------------------------------------------------------------------------

struct ProgramComment {
    std::string text;

    static constexpr std::string_view NAME = "COMMENT";
    static constexpr std::tuple FIELDS{&ProgramComment::text};
};

/// (msg,...): message to the operator.
struct OperatorMessage {
    std::string text;

    static constexpr std::string_view NAME = "MESSAGE";
    static constexpr std::tuple FIELDS{&OperatorMessage::text};
};

/// (print,...): line on standard output.
struct PrintLine {
    std::string text;  ///< one line

    static constexpr std::string_view NAME = "PRINT";
};

/// (logopen,...), (logappend,...).
struct OpenLog {
    std::string path;
    bool appending = false;

    static constexpr std::array<std::string_view, 2> NAMES{"LOGOPEN", "LOGAPPEND"};
    static constexpr std::tuple CHOICES{&OpenLog::appending};
    static constexpr std::tuple FIELDS{&OpenLog::path};
};

/// (log,...).
struct LogLine {
    std::string text;

    static constexpr std::string_view NAME = "LOG";
    static constexpr std::tuple FIELDS{&LogLine::text};
};

/// (logclose).
struct CloseLog {
    static constexpr std::string_view NAME = "LOGCLOSE";
    static constexpr std::tuple<> FIELDS{};
};

/// (probeopen FILE), (probeclose): each successful probe from now on is written to the file, nine coordinates
/// per line.
struct LogProbes {
    std::string path;  ///< empty: ends writing

    static constexpr std::string_view NAME = "LOG_PROBES";
};

/// An error that a canon, or a script that calls one, reports to the operator.
struct CanonError {
    std::string text;

    static constexpr std::string_view NAME = "CANON_ERROR";
};

}  // namespace mw::gcode
