// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/program_checksum.hh"

#include <bit>

#include "base/overloaded.hh"

namespace mw::task {

void ProgramChecksum::mix(std::uint64_t word) {
    constexpr std::uint64_t FACTOR = 0x9E3779B97F4A7C15;  // 2^64 divided by the golden ratio
    constexpr unsigned HALF = 32;
    value_ = (value_ ^ word) * FACTOR;
    value_ ^= value_ >> HALF;
}

void ProgramChecksum::mix(double number) {
    mix(std::bit_cast<std::uint64_t>(number));
}

void ProgramChecksum::mix(const geometry::Pose &pose) {
    for (const double coordinate : pose.c) {
        mix(coordinate);
    }
}

void ProgramChecksum::mix(const geometry::MoveSettings &s) {
    constexpr unsigned MODE = 8, SPINDLE = 16;
    mix(static_cast<std::uint64_t>(s.isRapid) | static_cast<std::uint64_t>(s.velocity_synched) << 1U |
        static_cast<std::uint64_t>(s.mode) << MODE |
        static_cast<std::uint64_t>(static_cast<std::uint8_t>(s.synch_spindle)) << SPINDLE);
    mix(s.feed);
    mix(s.tolerance);
    mix(s.naivecam_tolerance);
    mix(s.corner_scale);
    mix(s.feed_per_revolution);
}

void ProgramChecksum::add(const gcode::MachineCall &call) {
    mix(static_cast<std::uint64_t>(call.index()));
    const auto whole = [this](int number) { mix(static_cast<std::uint64_t>(number)); };
    std::visit(
        Overloaded{
            [this](const OneOf<gcode::LineMove, gcode::ProbeMove> auto &move) {
                mix(move.end);
                mix(move.settings);
            },
            [this](const gcode::TapMove &move) {
                mix(move.end);
                mix(move.settings);
                mix(move.scale);
            },
            [this](const gcode::ArcMove &move) {
                mix(move.end);
                mix(move.centre);
                mix(move.normal);
                mix(move.angle_rad);
                mix(move.settings);
            },
            [this](const gcode::Dwell &dwell) { mix(dwell.seconds); },
            [this](const gcode::UseToolOffset &offset) { mix(offset.offset); },
            [&](const gcode::UseOffsets &offsets) {
                whole(offsets.g5x_index);
                mix(offsets.g5x);
                mix(offsets.g92);
                mix(offsets.rotation_xy_deg);
            },
            [&](const gcode::UseSpindleSpeed &speed) {
                whole(speed.spindle);
                mix(speed.speed);
            },
            [&](const OneOf<gcode::SelectTool, gcode::ChangeToolNumber> auto &tool) { whole(tool.toolno); },
            [&](const gcode::SetToolTableEntry &entry) {
                whole(entry.entry.toolno);
                mix(entry.entry.diameter);
                mix(entry.entry.offset);
            },
            [&](const gcode::SetDigitalOutput &output) {
                whole(output.index);
                whole(output.isOn ? 1 : 0);
            },
            [&](const gcode::SetAnalogOutput &output) {
                whole(output.index);
                mix(output.value);
            },
            [&](const gcode::StartSpindle &start) {
                whole(start.spindle);
                whole(start.clockwise ? 1 : 0);
            },
            [&](const gcode::StopSpindle &stop) { whole(stop.spindle); },
            [&](const OneOf<gcode::SwitchMist, gcode::SwitchFlood, gcode::SwitchFeedOverride,
                            gcode::SwitchFeedHold, gcode::SwitchAdaptiveFeed> auto &device) {
                whole(device.isOn ? 1 : 0);
            },
            // Only the type of these calls is included.
            [](const OneOf<gcode::UsePlanner, gcode::SetSpindleMode, gcode::OrientSpindle,
                           gcode::WaitOrientComplete, gcode::ChangeTool, gcode::ReloadTools,
                           gcode::SwitchSpeedOverride, gcode::WaitInput, gcode::ProgramStop,
                           gcode::ProgramEnd, gcode::PalletShuttle, gcode::Finish, gcode::UserCode,
                           gcode::ProgramComment, gcode::OperatorMessage, gcode::PrintLine, gcode::OpenLog,
                           gcode::LogLine, gcode::CloseLog, gcode::LogProbes, gcode::CanonError> auto &) {},
        },
        call);
}

}  // namespace mw::task
