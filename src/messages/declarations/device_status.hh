// SPDX-License-Identifier: GPL-2.0-or-later
// Status of joints, axes and spindles.
#pragma once

#include "base/limits.hh"
#include "messages/declarations/names.hh"

namespace mw::messages {

struct JointStatus {
    bool isPresent = false;
    double pos_cmd = 0;
    double pos_fb = 0;
    double vel_cmd = 0;
    double motor_pos_cmd = 0;
    double motor_pos_fb = 0;
    double ferror = 0;
    double ferror_highmark = 0;
    double min_limit = 0;
    double max_limit = 0;
    double max_velocity = 0;
    double max_acceleration = 0;
    bool isActive = false;
    bool isInPosition = false;
    bool isEnabled = false;
    bool isHoming = false;
    bool isHomed = false;
    bool isFaulted = false;
    bool isOnNegSoftLimit = false;
    bool isOnPosSoftLimit = false;
    bool isOnNegHardLimit = false;
    bool isOnPosHardLimit = false;
    bool isFerrorTripped = false;
    bool isOverridingLimits = false;
};
template <>
inline constexpr auto DECLARED<JointStatus> =
    declare("JointStatus", 198, "a joint",
            field<&JointStatus::isPresent>(
                "is_present", "false: the machine has no such joint, nothing else here means anything"),
            field<&JointStatus::pos_cmd>("pos_cmd", "commanded position", unit::JOINT),
            field<&JointStatus::pos_fb>("pos_fb", "position by feedback", unit::JOINT),
            field<&JointStatus::vel_cmd>("vel_cmd", "commanded speed", unit::JOINT_SPEED),
            field<&JointStatus::motor_pos_cmd>(
                "motor_pos_cmd", "commanded position with compensation and homing offset", unit::JOINT),
            field<&JointStatus::motor_pos_fb>("motor_pos_fb", "the same by feedback", unit::JOINT),
            field<&JointStatus::ferror>("ferror", "following error", unit::JOINT),
            field<&JointStatus::ferror_highmark>(
                "ferror_highmark", "largest following error since the machine was enabled", unit::JOINT),
            field<&JointStatus::min_limit>("min_limit", "lower soft limit", unit::JOINT),
            field<&JointStatus::max_limit>("max_limit", "upper soft limit", unit::JOINT),
            field<&JointStatus::max_velocity>("max_velocity", "maximum speed", unit::JOINT_SPEED),
            field<&JointStatus::max_acceleration>("max_acceleration", "maximum acceleration",
                                                  unit::JOINT_ACCELERATION),
            field<&JointStatus::isActive>("is_active", "takes part"),
            field<&JointStatus::isInPosition>("in_position", "has reached its commanded position"),
            field<&JointStatus::isEnabled>("is_enabled", "amplifier enabled"),
            field<&JointStatus::isHoming>("is_homing", "is being homed"),
            field<&JointStatus::isHomed>("is_homed", "is homed"),
            field<&JointStatus::isFaulted>("is_faulted", "amplifier fault"),
            field<&JointStatus::isOnNegSoftLimit>("on_neg_soft_limit", "at the lower soft limit"),
            field<&JointStatus::isOnPosSoftLimit>("on_pos_soft_limit", "at the upper soft limit"),
            field<&JointStatus::isOnNegHardLimit>("on_neg_hard_limit", "on the lower limit switch"),
            field<&JointStatus::isOnPosHardLimit>("on_pos_hard_limit", "on the upper limit switch"),
            field<&JointStatus::isFerrorTripped>("ferror_tripped", "following error too large"),
            field<&JointStatus::isOverridingLimits>("overriding_limits",
                                                    "limit switches are overridden until the next jog"));

struct AxisStatus {
    bool isPresent = false;
    double velocity = 0;
    double min_limit = 0;
    double max_limit = 0;
};
template <>
inline constexpr auto DECLARED<AxisStatus> =
    declare("AxisStatus", 199, "an axis",
            field<&AxisStatus::isPresent>(
                "is_present", "false: the machine has no such axis, nothing else here means anything"),
            field<&AxisStatus::velocity>("velocity", "of a jog", unit::JOINT_SPEED),
            field<&AxisStatus::min_limit>("min_limit", "lower soft limit", unit::JOINT),
            field<&AxisStatus::max_limit>("max_limit", "upper soft limit", unit::JOINT));

struct SpindleStatus {
    bool isPresent = false;
    double speed_cmd_rpm = 0;
    double override_factor = 1.0;
    double speed_in_rps = 0;
    double revs = 0;
    int direction = 0;
    bool isOn = false;
    bool isAtSpeed = false;
    bool isBrakeOn = false;
    bool isOverrideEnabled = true;
    int orient_state = 0;
    int orient_fault = 0;
};
template <>
inline constexpr auto DECLARED<SpindleStatus> = declare(
    "SpindleStatus", 1399, "a spindle",
    field<&SpindleStatus::isPresent>(
        "is_present", "false: the machine has no such spindle, nothing else here means anything"),
    field<&SpindleStatus::speed_cmd_rpm>("speed_cmd_rpm", "commanded speed, negative: counterclockwise",
                                         unit::RPM),
    field<&SpindleStatus::override_factor>("override_factor", "of the speed", unit::FACTOR),
    field<&SpindleStatus::speed_in_rps>("speed_in_rps", "by feedback", "revolutions/s"),
    field<&SpindleStatus::revs>("revs", "by feedback", unit::REVOLUTIONS),
    field<&SpindleStatus::direction>("direction", "1 clockwise, 0, -1 counterclockwise"),
    field<&SpindleStatus::isOn>("is_on", "commanded to turn"),
    field<&SpindleStatus::isAtSpeed>("at_speed", "by its pin"),
    field<&SpindleStatus::isBrakeOn>("brake_on", "brake engaged"),
    field<&SpindleStatus::isOverrideEnabled>("override_enabled", "overrides work (M51)"),
    field<&SpindleStatus::orient_state>("orient_state", "0 none, 1 in progress, 2 complete, 3 faulted"),
    field<&SpindleStatus::orient_fault>("orient_fault", "as its pin says"));

}  // namespace mw::messages
