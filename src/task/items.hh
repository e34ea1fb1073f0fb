// SPDX-License-Identifier: GPL-2.0-or-later
// The ordered queue between the interpreter and the machine: what a program does, in program order.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <variant>

#include "interp/machine_canon.hh"
#include "motion/api/path_command.hh"
#include "task/status.hh"

namespace mw::task {

struct LineItem {
    interp::LineMove move;
};
struct ArcItem {
    interp::ArcMove move;
};
struct ProbeItem {
    interp::LineMove move;
    interp::ProbeKind kind;
};
struct RigidTapItem {
    interp::LineMove move;
    double scale;
};
struct DwellItem {
    double seconds;
};
struct SpindleModeItem {
    int spindle;
    double css_max_rpm;
};
struct SpindleSpeedItem {
    int spindle;
    double speed;         ///< [rev/min or surface units/min]
    double surface_unit;  ///< [machine units]
};
struct SpindleOnItem {
    int spindle;
    int direction;
    bool isWaiting;
};
struct SpindleOffItem {
    int spindle;
};
struct SpindleOrientItem {
    int spindle;
    double angle_deg;
    int mode;
};
struct WaitOrientItem {
    int spindle;
    double timeout_s;
};
struct SelectToolItem {
    int toolno;
};
struct ChangeToolItem {};
struct ChangeToolNumberItem {
    int toolno;
};
struct ToolEntryItem {
    int index;
    interp::ToolEntry entry;
};
struct CoolantItem {
    bool isMist;
    bool isOn;
};
struct OverrideSwitchItem {
    motion::Switch what;
    int spindle;
    bool isEnabled;
};
struct PlannerModeItem {
    bool isSmooth;
};
struct DigitalOutputItem {
    int index;
    bool isOn;
    bool isSynched;
};
struct AnalogOutputItem {
    int index;
    double value;
    bool isSynched;
};
struct WaitInputItem {
    int index;
    bool isAnalog;
    interp::WaitKind kind;
    double timeout_s;
};
struct StopItem {
    bool isOptional;
};
struct EndItem {
    bool isProgramEnd;  ///< M2 or M30, else the end of the file
};
struct MessageItem {
    MessageKind kind;
    std::string text;
};
struct PrintItem {
    std::string text;
};
struct LogItem {
    enum class What : std::uint8_t { OPEN, APPEND, WRITE, CLOSE } what;
    std::string text;      ///< path or line
    bool isProbe = false;  ///< for results of probes, not for (log,...)
};
struct ReloadToolsItem {};
struct UserCodeItem {
    int code;
    double p, q;
};
struct ToolOffsetItem {
    geom::Pose offset;
};
struct OffsetsItem {
    int g5x_index;
    geom::Pose g5x, g92;
    double rotation_xy_deg;
};

using ItemBody =
    std::variant<LineItem, ArcItem, ProbeItem, RigidTapItem, DwellItem, SpindleModeItem, SpindleSpeedItem,
                 SpindleOnItem, SpindleOffItem, SpindleOrientItem, WaitOrientItem, SelectToolItem,
                 ChangeToolItem, ChangeToolNumberItem, ToolEntryItem, CoolantItem, OverrideSwitchItem,
                 PlannerModeItem, DigitalOutputItem, AnalogOutputItem, WaitInputItem, StopItem, EndItem,
                 MessageItem, PrintItem, LogItem, ReloadToolsItem, UserCodeItem, ToolOffsetItem, OffsetsItem>;

struct Item {
    motion::SourceTag source;
    ItemBody body;
};

using ItemQueue = std::deque<Item>;

}  // namespace mw::task
