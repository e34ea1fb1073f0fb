// SPDX-License-Identifier: GPL-2.0-or-later
// Commands for spindles, coolant, lubrication, the e-stop chain, tools and I/O.
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
    declare("SpindleOn", 1304, "turns a spindle",
            field<&SpindleOn::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES),
            field<&SpindleOn::speed_rpm>("speed_rpm", "negative: counterclockwise; 0 stops", unit::RPM));

struct SpindleOff {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleOff> =
    declare("SpindleOff", 1305, "stops a spindle",
            optional(field<&SpindleOff::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleIncrease {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleIncrease> = declare(
    "SpindleIncrease", 1309, "turns a spindle faster by 100 rev/min",
    optional(field<&SpindleIncrease::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleDecrease {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleDecrease> = declare(
    "SpindleDecrease", 1310, "turns a spindle slower by 100 rev/min",
    optional(field<&SpindleDecrease::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct SpindleConstant {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<SpindleConstant> = declare(
    "SpindleConstant", 1311, "ends a change of speed",
    optional(field<&SpindleConstant::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct ReleaseBrake {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<ReleaseBrake> = declare(
    "ReleaseBrake", 1312, "releases the brake of a spindle",
    optional(field<&ReleaseBrake::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct EngageBrake {
    int spindle = 0;
};
template <>
inline constexpr auto DECLARED<EngageBrake> =
    declare("EngageBrake", 1313, "engages the brake of a spindle",
            optional(field<&EngageBrake::spindle>("spindle", "number of the spindle", unit::NONE, SPINDLES)));

struct MistOn {};
template <>
inline constexpr auto DECLARED<MistOn> = declare("MistOn", 1404, "turns mist on");

struct MistOff {};
template <>
inline constexpr auto DECLARED<MistOff> = declare("MistOff", 1405, "turns mist off");

struct FloodOn {};
template <>
inline constexpr auto DECLARED<FloodOn> = declare("FloodOn", 1406, "turns flood on");

struct FloodOff {};
template <>
inline constexpr auto DECLARED<FloodOff> = declare("FloodOff", 1407, "turns flood off");

struct LubeOn {};
template <>
inline constexpr auto DECLARED<LubeOn> = declare("LubeOn", 1504, "turns lubrication on");

struct LubeOff {};
template <>
inline constexpr auto DECLARED<LubeOff> = declare("LubeOff", 1505, "turns lubrication off");

struct LoadToolTable {};
template <>
inline constexpr auto DECLARED<LoadToolTable> = declare("LoadToolTable", 1107, "reads the tool table again");

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
    "SetToolEntry", 1108, "changes an entry of the tool table",
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
    "AddTool", 3012, "puts a new tool into the tool table",
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
    declare("RemoveTool", 3013, "takes a tool out of the tool table; not the one in the spindle",
            field<&RemoveTool::toolno>("toolno", "number of the tool", unit::NONE, range(0, 99999)));

struct ConfirmToolChange {};
template <>
inline constexpr auto DECLARED<ConfirmToolChange> =
    declare("ConfirmToolChange", 3004, "a person says that the tool that was asked for is in");

}  // namespace mw::messages
