// SPDX-License-Identifier: GPL-2.0-or-later
// Inputs and outputs of the controller in a servo cycle. The HAL adapter and tests use them.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/status.hh"
#include "motion/servo/coord/heading.hh"

namespace mw::motion {

/// A hand wheel: counts are converted to distance.
struct WheelInput {
    std::int32_t counts = 0;
    double scale = 0;           ///< [unit per count]
    double accel_fraction = 1;  ///< part of the acceleration limit; outside (0, 1]: 1
    bool isEnabled = false;
    bool isVelocityMode = false;
};

/// Counts that are converted to an axis offset.
struct OffsetInput {
    std::int32_t counts = 0;
    double scale = 0;  ///< [unit per count]
    bool isEnabled = false, isClearing = false;
};

struct JointInputs {
    double motor_pos_fb = 0;
    bool isHomeSwitchClosed = false, isPosLimitClosed = false, isNegLimitClosed = false;
    bool isAmpFaulted = false;
    bool isIndexEnabled = false;
    bool isUnlocked = false;  ///< of a locking indexer
    double posthome_cmd = 0;  ///< of an extra joint
    WheelInput wheel;
};

struct SpindleInputs {
    bool isAtSpeed = true, isInhibited = false, isOriented = false, isAmpFaulted = false;
    bool isIndexEnabled = false;
    double revs = 0, speed_in_rps = 0;
    std::int32_t orient_fault = 0;
};

struct Inputs {
    std::int64_t time_ns = 0;
    std::uint32_t lost_positions =
        0;                   ///< number of events after which a driver's positions do not match the machine
    bool isEnableOn = true;  ///< motion.enable
    bool isProbeClosed = false;
    bool isFeedHeld = false, isFeedInhibited = false;
    bool isHomingInhibited = false, isJogInhibited = false;
    bool isJogStopped = false, isJogStoppedNow = false;
    double adaptive_feed = 1;
    double kinematics_type = 0;     ///< motion.switchkins-type
    std::uint64_t misc_errors = 0;  ///< bit per input
    std::uint64_t digital_in = 0;
    std::array<double, MAX_ANALOG_IO> analog_in{};
    std::array<JointInputs, MAX_JOINTS> joint{};
    std::array<WheelInput, MAX_AXES> axis_wheel{};
    std::array<OffsetInput, MAX_AXES> axis_offset{};
    std::array<SpindleInputs, MAX_SPINDLES> spindle{};
};

/// Pin values of a joint that seldom change; compared before they are written.
struct SeldomJointOutputs {
    double backlash_raw = 0, backlash_filtered = 0, backlash_velocity = 0;
    double motor_offset = 0;
    double free_velocity_limit = 0;
    bool isAmpEnabled = false;
    bool isIndexEnabled = false, isUnlockWanted = false;
    bool isFreePlanning = false, isKeyboardJogging = false, isWheelJogging = false;
    int home_state = 0;
};

/// Pin values that are not in `Status`.
struct JointOutputs : SeldomJointOutputs {
    double motor_pos_cmd = 0;
    double coarse_pos = 0, acc_cmd = 0;
    double free_pos_cmd = 0, ferror_limit = 0;
};

/// As SeldomJointOutputs.
struct SeldomAxisOutputs {
    double teleop_velocity = 0, teleop_velocity_limit = 0;
    double offset = 0, offset_request = 0;
    bool isTeleopPlanning = false, isKeyboardJogging = false, isWheelJogging = false;
};

struct AxisOutputs : SeldomAxisOutputs {
    double position = 0, teleop_position = 0;
};

struct SpindleOutputs {
    double speed_rpm = 0;  ///< signed; after scale and limits
    bool isOn = false, isForward = false, isReverse = false, isBrakeOn = false;
    bool isOrienting = false, isLocked = false;
    double orient_angle = 0;
    int orient_mode = 0;
    bool isIndexEnabled = false;
};

inline constexpr std::uint32_t ALL_AXES = (1U << MAX_AXES) - 1U;

/// Parts of the status that seldom change.
inline constexpr PartMask SELDOM_PARTS = part_range(status_part::AXES, 1) |
                                         part_range(status_part::ANALOG_IN, 1) |
                                         part_range(status_part::ANALOG_OUT, 1);

struct Outputs {
    Status status;
    PartMask touched = SELDOM_PARTS;  ///< the parts of SELDOM_PARTS that may differ from the last publication
    std::uint32_t axes =
        ALL_AXES;  ///< bit per axis that the machine may have; pins of other axes are not read
    std::array<JointOutputs, MAX_JOINTS> joint{};
    std::array<AxisOutputs, MAX_AXES> axis{};
    std::array<SpindleOutputs, MAX_SPINDLES> spindle{};
    Heading heading;
    bool isJogging = false;
    bool isCoordError = false, isOnSoftLimit = false;
    double mm_per_unit = 1;
    bool isHomingQuiet = true;           ///< homing outputs have their inactive values
    bool areJogsQuiet = false;           ///< jog outputs have their inactive values
    bool areOffsetsQuiet = false;        ///< no axis has an external offset, and the outputs are 0
    std::uint32_t settings_version = 0;  ///< Settings::version() of `status` and mm_per_unit
    bool isOffsetActive = false, isOffsetLimited = false;
};

}  // namespace mw::motion
