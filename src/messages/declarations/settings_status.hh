// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of the INI file that clients need to read the rest of the status.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

struct JointSettings {
    double units = 1;
    double backlash = 0;
    double max_ferror = 0;
    double min_ferror = 0;
    alignas(8) JointKind kind = JointKind::LINEAR;
};
template <>
inline constexpr auto DECLARED<JointSettings> = declare(
    "JointSettings", 0, "what is set for a joint",
    field<&JointSettings::units>("units", "units of the joint in a millimetre or degree"),
    field<&JointSettings::backlash>("backlash", "play that is made up at each reversal", unit::JOINT),
    field<&JointSettings::max_ferror>("max_ferror", "following error allowed at full speed", unit::JOINT),
    field<&JointSettings::min_ferror>("min_ferror", "following error allowed at rest", unit::JOINT),
    field<&JointSettings::kind>("kind", "linear or angular"));

struct SettingsStatus {
    double linear_units = 1;
    double angular_units = 1;
    double cycle_time_s = 0;
    double max_velocity = 0;
    double max_acceleration = 0;
    std::uint32_t debug = 0;
    Kinematics kinematics = Kinematics::BOTH;
    alignas(8) std::array<JointSettings, MAX_JOINTS> joints{};
};
template <>
inline constexpr auto DECLARED<SettingsStatus> =
    declare("SettingsStatus", 0, "what is set for the machine",
            field<&SettingsStatus::linear_units>("linear_units", "machine units in a millimetre"),
            field<&SettingsStatus::angular_units>("angular_units", "machine units in a degree"),
            field<&SettingsStatus::cycle_time_s>("cycle_time", "period of the planner", unit::SECOND),
            field<&SettingsStatus::max_velocity>(
                "max_velocity", "of the path, as the operator has limited it last", unit::SPEED),
            field<&SettingsStatus::max_acceleration>("max_acceleration", "of the path", unit::ACCELERATION),
            field<&SettingsStatus::debug>("debug", "bits of [EMC]DEBUG"),
            field<&SettingsStatus::kinematics>("kinematics", "what relates joints and axes"),
            field<&SettingsStatus::joints>("joints", "by number"));

}  // namespace mw::messages
