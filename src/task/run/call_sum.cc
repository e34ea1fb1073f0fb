// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/call_sum.hh"

#include <bit>

#include "base/overloaded.hh"

namespace mw::task {

void CallSum::mix(std::uint64_t word) {
    constexpr std::uint64_t FACTOR = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
    constexpr unsigned HALF = 32;
    value_ = (value_ ^ word) * FACTOR;
    value_ ^= value_ >> HALF;
}

void CallSum::mix(double number) {
    mix(std::bit_cast<std::uint64_t>(number));
}

void CallSum::mix(const geom::Pose &pose) {
    for (const double coordinate : pose.c) {
        mix(coordinate);
    }
}

void CallSum::mix(const geom::MoveSettings &s) {
    constexpr unsigned MODE = 8, SPINDLE = 16;
    mix(static_cast<std::uint64_t>(s.isRapid) | static_cast<std::uint64_t>(s.isVelocitySynched) << 1U |
        static_cast<std::uint64_t>(s.mode) << MODE |
        static_cast<std::uint64_t>(static_cast<std::uint8_t>(s.synch_spindle)) << SPINDLE);
    mix(s.feed);
    mix(s.tolerance);
    mix(s.naivecam_tolerance);
    mix(s.corner_scale);
    mix(s.feed_per_revolution);
}

void CallSum::add(const interp::MachineCall &call) {
    mix(static_cast<std::uint64_t>(call.index()));
    const auto whole = [this](int number) { mix(static_cast<std::uint64_t>(number)); };
    std::visit(
        Overloaded{
            [this](const OneOf<interp::LineMove, interp::ProbeMove> auto &move) {
                mix(move.end);
                mix(move.settings);
            },
            [this](const interp::TapMove &move) {
                mix(move.end);
                mix(move.settings);
                mix(move.scale);
            },
            [this](const interp::ArcMove &move) {
                mix(move.end);
                mix(move.centre);
                mix(move.normal);
                mix(move.angle_rad);
                mix(move.settings);
            },
            [this](const interp::Dwell &dwell) { mix(dwell.seconds); },
            [this](const interp::UseToolOffset &offset) { mix(offset.offset); },
            [&](const interp::UseOffsets &offsets) {
                whole(offsets.g5x_index);
                mix(offsets.g5x);
                mix(offsets.g92);
                mix(offsets.rotation_xy_deg);
            },
            [&](const interp::UseSpindleSpeed &speed) {
                whole(speed.spindle);
                mix(speed.speed);
            },
            [&](const OneOf<interp::SelectTool, interp::ChangeToolNumber> auto &tool) { whole(tool.toolno); },
            [&](const interp::SetToolTableEntry &entry) {
                whole(entry.entry.toolno);
                mix(entry.entry.diameter);
                mix(entry.entry.offset);
            },
            [&](const interp::SetDigitalOutput &output) {
                whole(output.index);
                whole(output.isOn ? 1 : 0);
            },
            [&](const interp::SetAnalogOutput &output) {
                whole(output.index);
                mix(output.value);
            },
            [&](const interp::StartSpindle &start) {
                whole(start.spindle);
                whole(start.isClockwise ? 1 : 0);
            },
            [&](const interp::StopSpindle &stop) { whole(stop.spindle); },
            [&](const OneOf<interp::SwitchMist, interp::SwitchFlood, interp::SwitchFeedOverride,
                            interp::SwitchFeedHold, interp::SwitchAdaptiveFeed> auto &device) {
                whole(device.isOn ? 1 : 0);
            },
            // That they are made says enough of these.
            [](const OneOf<interp::UsePlanner, interp::SetSpindleMode, interp::OrientSpindle,
                           interp::WaitOrientComplete, interp::ChangeTool, interp::ReloadTools,
                           interp::SwitchSpeedOverride, interp::WaitInput, interp::ProgramStop,
                           interp::ProgramEnd, interp::PalletShuttle, interp::Finish, interp::UserCode,
                           interp::ProgramComment, interp::OperatorMessage, interp::PrintLine,
                           interp::OpenLog, interp::LogLine, interp::CloseLog, interp::LogProbes,
                           interp::CanonError> auto &) {},
        },
        call);
}

}  // namespace mw::task
