// SPDX-License-Identifier: GPL-2.0-or-later
// A canon call as text that shows every bit of its numbers.
#pragma once

#include <string>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "gcode/canon/machine_canon.hh"

namespace mw::gcode::test {

inline std::string bits(const geometry::Pose &pose) {
    std::string text;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        text += fmt::format(" {:a}", pose[axis]);
    }
    return text;
}

inline std::string bits(const geometry::MoveSettings &s) {
    return fmt::format(" {} {} {} {} {:a} {:a} {:a} {:a} {:a}", s.isRapid, static_cast<int>(s.mode),
                       static_cast<int>(s.synch_spindle), s.velocity_synched, s.feed, s.tolerance,
                       s.naivecam_tolerance, s.corner_scale, s.feed_per_revolution);
}

inline std::string bits(const MachineCall &call) {
    const std::string kind = fmt::format("{}", call.index());
    return kind +
           std::visit(
               Overloaded{
                   [](const LineMove &c) { return bits(c.end) + bits(c.settings); },
                   [](const ArcMove &c) {
                       return bits(c.end) + bits(c.centre) + bits(c.normal) +
                              fmt::format(" {:a}", c.angle_rad) + bits(c.settings);
                   },
                   [](const ProbeMove &c) { return bits(c.end) + bits(c.settings); },
                   [](const TapMove &c) {
                       return bits(c.end) + bits(c.settings) + fmt::format(" {:a}", c.scale);
                   },
                   [](const Dwell &c) { return fmt::format(" {:a}", c.seconds); },
                   [](const UseToolOffset &c) { return bits(c.offset); },
                   [](const UseOffsets &c) {
                       return fmt::format(" {} {:a}", c.g5x_index, c.rotation_xy_deg) + bits(c.g5x) +
                              bits(c.g92);
                   },
                   [](const UseSpindleSpeed &c) {
                       return fmt::format(" {} {:a} {:a}", c.spindle, c.speed, c.surface_unit);
                   },
                   [](const SetSpindleMode &c) { return fmt::format(" {} {:a}", c.spindle, c.css_max_rpm); },
                   [](const StartSpindle &c) { return fmt::format(" {} {}", c.spindle, c.clockwise); },
                   [](const StopSpindle &c) { return fmt::format(" {}", c.spindle); },
                   [](const SelectTool &c) { return fmt::format(" {}", c.toolno); },
                   [](const ChangeToolNumber &c) { return fmt::format(" {}", c.toolno); },
                   [](const SetToolTableEntry &c) {
                       return fmt::format(" {} {} {:a}", c.index, c.entry.toolno, c.entry.diameter) +
                              bits(c.entry.offset);
                   },
                   [](const OneOf<SwitchMist, SwitchFlood, SwitchFeedOverride, SwitchFeedHold,
                                  SwitchAdaptiveFeed> auto &c) { return fmt::format(" {}", c.isOn); },
                   [](const SwitchSpeedOverride &c) { return fmt::format(" {} {}", c.spindle, c.isOn); },
                   [](const SetDigitalOutput &c) {
                       return fmt::format(" {} {} {}", c.index, c.isOn, c.synched);
                   },
                   [](const SetAnalogOutput &c) { return fmt::format(" {} {:a}", c.index, c.value); },
                   [](const UserCode &c) { return fmt::format(" {} {:a} {:a}", c.code, c.p, c.q); },
                   [](const OneOf<ProgramComment, OperatorMessage, PrintLine, LogLine, CanonError> auto &c) {
                       return " " + c.text;
                   },
                   [](const OneOf<UsePlanner, OrientSpindle, WaitOrientComplete, ChangeTool, ReloadTools,
                                  WaitInput, ProgramStop, ProgramEnd, PalletShuttle, Finish, OpenLog,
                                  CloseLog, LogProbes> auto &) { return std::string(); },
               },
               call);
}

}  // namespace mw::gcode::test
