// SPDX-License-Identifier: GPL-2.0-or-later
// Commands about spindles, coolant, lubrication, e-stop chain, tools and I/O.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

inline constexpr Range SPINDLES{0, MAX_SPINDLES - 1};

struct SpindleOn {
    int spindle = 0;
    double speed_rpm = 0;
};
template <>
inline constexpr auto DECLARED<SpindleOn> =
    declare("SpindleOn", 1304, "EMC_SPINDLE_ON_TYPE", "turns a spindle",
            field<&SpindleOn::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES),
            field<&SpindleOn::speed_rpm>("speed_rpm", "negative: counterclockwise; 0 stops", unit::RPM));

struct SpindleOff {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleOff> =
    declare("SpindleOff", 1305, "EMC_SPINDLE_OFF_TYPE", "stops a spindle",
            optional(field<&SpindleOff::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleIncrease {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleIncrease> = declare(
    "SpindleIncrease", 1309, "EMC_SPINDLE_INCREASE_TYPE", "turns a spindle faster by 100 rev/min",
    optional(field<&SpindleIncrease::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleDecrease {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleDecrease> = declare(
    "SpindleDecrease", 1310, "EMC_SPINDLE_DECREASE_TYPE", "turns a spindle slower by 100 rev/min",
    optional(field<&SpindleDecrease::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleConstant {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleConstant> = declare(
    "SpindleConstant", 1311, "EMC_SPINDLE_CONSTANT_TYPE", "ends a change of speed",
    optional(field<&SpindleConstant::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct ReleaseBrake {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<ReleaseBrake> = declare(
    "ReleaseBrake", 1312, "EMC_SPINDLE_BRAKE_RELEASE_TYPE", "releases the brake of a spindle",
    optional(field<&ReleaseBrake::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct EngageBrake {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<EngageBrake> =
    declare("EngageBrake", 1313, "EMC_SPINDLE_BRAKE_ENGAGE_TYPE", "engages the brake of a spindle",
            optional(field<&EngageBrake::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SetSpindleSpeed {
    int spindle = 0;
    double speed_rpm = 0;
};
template <>
inline constexpr auto DECLARED<SetSpindleSpeed> = declare(
    "SetSpindleSpeed", 1316, "EMC_SPINDLE_SPEED_TYPE", "sets the speed of a spindle",
    optional(field<&SetSpindleSpeed::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)),
    field<&SetSpindleSpeed::speed_rpm>("speed_rpm", "negative: counterclockwise", unit::RPM));

struct OrientSpindle {
    int spindle = 0;
    double angle_deg = 0;
    int mode = 0;
};
template <>
inline constexpr auto DECLARED<OrientSpindle> = declare(
    "OrientSpindle", 1317, "EMC_SPINDLE_ORIENT_TYPE", "turns a spindle to an angle and holds it there",
    optional(field<&OrientSpindle::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)),
    field<&OrientSpindle::angle_deg>("angle_deg", "of the spindle", unit::DEGREE),
    field<&OrientSpindle::mode>("mode", "0 shortest way, 1 clockwise, 2 counterclockwise", unit::NONE,
                                range(0, 2)));

struct WaitOriented {
    int spindle = 0;
    double timeout_s = 0;
};
template <>
inline constexpr auto DECLARED<WaitOriented> =
    declare("WaitOriented", 1318, "EMC_SPINDLE_WAIT_ORIENT_COMPLETE_TYPE",
            "waits until a spindle is oriented",
            optional(field<&WaitOriented::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)),
            field<&WaitOriented::timeout_s>("timeout_s", "how long", unit::SECOND, AT_LEAST_0));

struct MistOn {};
template <>
inline constexpr auto DECLARED<MistOn> = declare("MistOn", 1404, "EMC_COOLANT_MIST_ON_TYPE", "turns mist on");

struct MistOff {};
template <>
inline constexpr auto DECLARED<MistOff> =
    declare("MistOff", 1405, "EMC_COOLANT_MIST_OFF_TYPE", "turns mist off");

struct FloodOn {};
template <>
inline constexpr auto DECLARED<FloodOn> =
    declare("FloodOn", 1406, "EMC_COOLANT_FLOOD_ON_TYPE", "turns flood on");

struct FloodOff {};
template <>
inline constexpr auto DECLARED<FloodOff> =
    declare("FloodOff", 1407, "EMC_COOLANT_FLOOD_OFF_TYPE", "turns flood off");

struct LubeOn {};
template <>
inline constexpr auto DECLARED<LubeOn> = declare("LubeOn", 1504, "EMC_LUBE_ON_TYPE", "turns lubrication on");

struct LubeOff {};
template <>
inline constexpr auto DECLARED<LubeOff> =
    declare("LubeOff", 1505, "EMC_LUBE_OFF_TYPE", "turns lubrication off");

struct EstopOn {};
template <>
inline constexpr auto DECLARED<EstopOn> =
    declare("EstopOn", 1206, "EMC_AUX_ESTOP_ON_TYPE", "opens the e-stop chain");

struct EstopOff {};
template <>
inline constexpr auto DECLARED<EstopOff> =
    declare("EstopOff", 1207, "EMC_AUX_ESTOP_OFF_TYPE", "closes the e-stop chain from our side");

struct EstopReset {};
template <>
inline constexpr auto DECLARED<EstopReset> =
    declare("EstopReset", 1208, "EMC_AUX_ESTOP_RESET_TYPE", "resets the emergency stop");

struct WaitInput {
    int index = 0;
    bool isAnalog = false;
    int kind = 0;
    double timeout_s = 0;
};
template <>
inline constexpr auto DECLARED<WaitInput> = declare(
    "WaitInput", 1209, "EMC_AUX_INPUT_WAIT_TYPE", "waits for an input",
    field<&WaitInput::index>("index", "number of the input", unit::NONE, range(0, MAX_DIGITAL_IO - 1)),
    field<&WaitInput::isAnalog>("analog", "an analog input"),
    field<&WaitInput::kind>("kind", "0 at once, 1 rise, 2 fall, 3 high, 4 low", unit::NONE, range(0, 4)),
    field<&WaitInput::timeout_s>("timeout_s", "how long", unit::SECOND, AT_LEAST_0));

struct InitTool {};
template <>
inline constexpr auto DECLARED<InitTool> =
    declare("InitTool", 1101, "EMC_TOOL_INIT_TYPE", "sets the tool changer up");

struct HaltTool {};
template <>
inline constexpr auto DECLARED<HaltTool> =
    declare("HaltTool", 1102, "EMC_TOOL_HALT_TYPE", "ends the tool changer");

struct AbortTool {};
template <>
inline constexpr auto DECLARED<AbortTool> =
    declare("AbortTool", 1103, "EMC_TOOL_ABORT_TYPE", "stops the tool changer");

struct PrepareTool {
    int toolno = 0;
};
template <>
inline constexpr auto DECLARED<PrepareTool> =
    declare("PrepareTool", 1104, "EMC_TOOL_PREPARE_TYPE", "prepares a tool, as T",
            field<&PrepareTool::toolno>("toolno", "number of the tool", unit::NONE, range(0, 99999)));

struct LoadTool {};
template <>
inline constexpr auto DECLARED<LoadTool> =
    declare("LoadTool", 1105, "EMC_TOOL_LOAD_TYPE", "puts the prepared tool into the spindle, as M6");

struct UnloadTool {};
template <>
inline constexpr auto DECLARED<UnloadTool> =
    declare("UnloadTool", 1106, "EMC_TOOL_UNLOAD_TYPE", "empties the spindle");

struct LoadToolTable {};
template <>
inline constexpr auto DECLARED<LoadToolTable> =
    declare("LoadToolTable", 1107, "EMC_TOOL_LOAD_TOOL_TABLE_TYPE", "reads the tool table again");

struct SetToolEntry {
    int toolno = 0;
    int pocket = 0;
    geometry::Pose offset;
    double diameter = 0;
    double frontangle_deg = 0;
    double backangle_deg = 0;
    int orientation = 0;
};
template <>
inline constexpr auto DECLARED<SetToolEntry> = declare(
    "SetToolEntry", 1108, "EMC_TOOL_SET_OFFSET_TYPE", "changes an entry of the tool table",
    field<&SetToolEntry::toolno>("toolno", "number of the tool", unit::NONE, range(0, 99999)),
    optional(field<&SetToolEntry::pocket>("pocket", "where it is kept", unit::NONE, range(0, 1000))),
    field<&SetToolEntry::offset>("offset", "of the tool", unit::POSE),
    field<&SetToolEntry::diameter>("diameter", "of the tool", unit::LENGTH),
    optional(field<&SetToolEntry::frontangle_deg>("frontangle_deg", "lathe tools", unit::DEGREE)),
    optional(field<&SetToolEntry::backangle_deg>("backangle_deg", "lathe tools", unit::DEGREE)),
    optional(field<&SetToolEntry::orientation>("orientation", "lathe tools", unit::NONE, range(0, 9))));

struct AddTool {
    int toolno = 0;
    int pocket = 0;
    geometry::Pose offset;
    double diameter = 0;
    double frontangle_deg = 0;
    double backangle_deg = 0;
    int orientation = 0;
    std::string comment;
};
template <>
inline constexpr auto DECLARED<AddTool> = declare(
    "AddTool", 3012, "", "puts a new tool into the tool table",
    field<&AddTool::toolno>("toolno", "number of the tool, from 1 on", unit::NONE, range(0, 99999)),
    optional(field<&AddTool::pocket>("pocket", "where it is kept, 0: one that is free", unit::NONE,
                                     range(0, 1000))),
    optional(field<&AddTool::offset>("offset", "of the tool", unit::POSE)),
    optional(field<&AddTool::diameter>("diameter", "of the tool", unit::LENGTH)),
    optional(field<&AddTool::frontangle_deg>("frontangle_deg", "lathe tools", unit::DEGREE)),
    optional(field<&AddTool::backangle_deg>("backangle_deg", "lathe tools", unit::DEGREE)),
    optional(field<&AddTool::orientation>("orientation", "lathe tools", unit::NONE, range(0, 9))),
    optional(field<&AddTool::comment>("comment", "of the tool, on one line", unit::NONE, range(0, 200))));

struct RemoveTool {
    int toolno = 0;
};
template <>
inline constexpr auto DECLARED<RemoveTool> =
    declare("RemoveTool", 3013, "", "takes a tool out of the tool table; not the one in the spindle",
            field<&RemoveTool::toolno>("toolno", "number of the tool", unit::NONE, range(0, 99999)));

struct SetToolNumber {
    int toolno = 0;
};
template <>
inline constexpr auto DECLARED<SetToolNumber> =
    declare("SetToolNumber", 1109, "EMC_TOOL_SET_NUMBER_TYPE", "says which tool is in the spindle, as M61",
            field<&SetToolNumber::toolno>("toolno", "number of the tool", unit::NONE, range(0, 99999)));

struct StartToolChange {};
template <>
inline constexpr auto DECLARED<StartToolChange> =
    declare("StartToolChange", 1110, "EMC_TOOL_START_CHANGE_TYPE", "tells the changer that a change begins");

struct ConfirmToolChange {};
template <>
inline constexpr auto DECLARED<ConfirmToolChange> =
    declare("ConfirmToolChange", 3004, "", "a person says that the tool that was asked for is in");

struct InitIo {};
template <>
inline constexpr auto DECLARED<InitIo> = declare("InitIo", 1601, "EMC_IO_INIT_TYPE", "sets I/O up");

struct HaltIo {};
template <>
inline constexpr auto DECLARED<HaltIo> = declare("HaltIo", 1602, "EMC_IO_HALT_TYPE", "ends I/O");

struct AbortIo {};
template <>
inline constexpr auto DECLARED<AbortIo> = declare("AbortIo", 1603, "EMC_IO_ABORT_TYPE", "stops I/O");

struct SetIoCycleTime {
    double period_s = 0.1;
};
template <>
inline constexpr auto DECLARED<SetIoCycleTime> =
    declare("SetIoCycleTime", 1604, "EMC_IO_SET_CYCLE_TIME_TYPE", "sets the period of I/O",
            field<&SetIoCycleTime::period_s>("period_s", "of I/O", unit::SECOND, AT_LEAST_0));

struct CallIoPlugin {
    std::string call;
};
template <>
inline constexpr auto DECLARED<CallIoPlugin> =
    declare("CallIoPlugin", 1113, "EMC_IO_PLUGIN_CALL_TYPE", "calls a Python function of I/O",
            field<&CallIoPlugin::call>("call", "pickled name and arguments", unit::NONE, range(1, 1023)));

}  // namespace mw::messages
