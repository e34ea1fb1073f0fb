// SPDX-License-Identifier: GPL-2.0-or-later
// Every setting of the motion controller, declared once (requirement C7): number, name, INI key, unit, range.
// Adding one is one line here; SetParameter, the INI reading and the reference page follow from it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace mw::motion {

enum class ParameterScope : std::uint8_t { MACHINE, JOINT, AXIS, SPINDLE };
enum class ParameterUnit : std::uint8_t {
    NONE,
    LENGTH,
    SPEED,
    ACCELERATION,
    JERK,
    SECONDS,
    RPM,
    FLAG,
    COUNT
};

inline constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();
/// A jerk limit of this much and more is none [unit/s^3].
inline constexpr double NO_JERK_LIMIT = 1e9;

// X(name, scope, INI key, unit, lowest, highest, default)
// LENGTH, SPEED... are in the joint's or axis's own unit (machine units or degrees).
#define MW_MOTION_PARAMETERS(X)                                                                              \
    X(TRAJ_MAX_VELOCITY, MACHINE, "MAX_LINEAR_VELOCITY", SPEED, 0, UNBOUNDED, UNBOUNDED)                     \
    X(TRAJ_MAX_ACCELERATION, MACHINE, "MAX_LINEAR_ACCELERATION", ACCELERATION, 0, UNBOUNDED, UNBOUNDED)      \
    X(TRAJ_MAX_JERK, MACHINE, "MAX_LINEAR_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT)                          \
    X(TRAJ_PLANNER_TYPE, MACHINE, "PLANNER_TYPE", COUNT, 0, 1, 0)                                            \
    X(TRAJ_CORNER_SCALE, MACHINE, "SCURVE_PEAK_SCALE", NONE, 0.1, 1, 1)                                      \
    X(TRAJ_ADDED_TOLERANCES, MACHINE, "ADDED_TOLERANCES", FLAG, 0, 1, 0)                                     \
    X(TRAJ_NO_FORCE_HOMING, MACHINE, "NO_FORCE_HOMING", FLAG, 0, 1, 0)                                       \
    X(MAX_FEED_SCALE, MACHINE, "MAX_FEED_OVERRIDE", NONE, 0, 1000, 1)                                        \
    X(JOINT_MIN_LIMIT, JOINT, "MIN_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, -1e99)                             \
    X(JOINT_MAX_LIMIT, JOINT, "MAX_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, 1e99)                              \
    X(JOINT_MAX_VELOCITY, JOINT, "MAX_VELOCITY", SPEED, 0, UNBOUNDED, 1)                                     \
    X(JOINT_MAX_ACCELERATION, JOINT, "MAX_ACCELERATION", ACCELERATION, 0, UNBOUNDED, 1)                      \
    X(JOINT_MAX_JERK, JOINT, "MAX_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT)                                  \
    X(JOINT_FERROR, JOINT, "FERROR", LENGTH, 0, UNBOUNDED, 1)                                                \
    X(JOINT_MIN_FERROR, JOINT, "MIN_FERROR", LENGTH, 0, UNBOUNDED, 1)                                        \
    X(JOINT_BACKLASH, JOINT, "BACKLASH", LENGTH, 0, UNBOUNDED, 0)                                            \
    X(JOINT_IS_ANGULAR, JOINT, "TYPE", FLAG, 0, 1, 0)                                                        \
    X(JOINT_HOME, JOINT, "HOME", LENGTH, -UNBOUNDED, UNBOUNDED, 0)                                           \
    X(JOINT_HOME_OFFSET, JOINT, "HOME_OFFSET", LENGTH, -UNBOUNDED, UNBOUNDED, 0)                             \
    X(JOINT_HOME_SEARCH_VEL, JOINT, "HOME_SEARCH_VEL", SPEED, -UNBOUNDED, UNBOUNDED, 0)                      \
    X(JOINT_HOME_LATCH_VEL, JOINT, "HOME_LATCH_VEL", SPEED, -UNBOUNDED, UNBOUNDED, 0)                        \
    X(JOINT_HOME_FINAL_VEL, JOINT, "HOME_FINAL_VEL", SPEED, -1, UNBOUNDED, -1)                               \
    X(JOINT_HOME_IGNORE_LIMITS, JOINT, "HOME_IGNORE_LIMITS", FLAG, 0, 1, 0)                                  \
    X(JOINT_HOME_USE_INDEX, JOINT, "HOME_USE_INDEX", FLAG, 0, 1, 0)                                          \
    X(JOINT_HOME_INDEX_NO_ENCODER_RESET, JOINT, "HOME_INDEX_NO_ENCODER_RESET", FLAG, 0, 1, 0)                \
    X(JOINT_HOME_IS_SHARED, JOINT, "HOME_IS_SHARED", FLAG, 0, 1, 0)                                          \
    X(JOINT_HOME_ABSOLUTE_ENCODER, JOINT, "HOME_ABSOLUTE_ENCODER", COUNT, 0, 2, 0)                           \
    X(JOINT_HOME_SEQUENCE, JOINT, "HOME_SEQUENCE", COUNT, -100, 1000, 1000)                                  \
    X(JOINT_VOLATILE_HOME, JOINT, "VOLATILE_HOME", FLAG, 0, 1, 0)                                            \
    X(AXIS_MIN_LIMIT, AXIS, "MIN_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, -1e99)                               \
    X(AXIS_MAX_LIMIT, AXIS, "MAX_LIMIT", LENGTH, -UNBOUNDED, UNBOUNDED, 1e99)                                \
    X(AXIS_MAX_VELOCITY, AXIS, "MAX_VELOCITY", SPEED, 0, UNBOUNDED, UNBOUNDED)                               \
    X(AXIS_MAX_ACCELERATION, AXIS, "MAX_ACCELERATION", ACCELERATION, 0, UNBOUNDED, UNBOUNDED)                \
    X(AXIS_MAX_JERK, AXIS, "MAX_JERK", JERK, 0, UNBOUNDED, NO_JERK_LIMIT)                                    \
    X(SPINDLE_MAX_FORWARD, SPINDLE, "MAX_FORWARD_VELOCITY", RPM, 0, UNBOUNDED, UNBOUNDED)                    \
    X(SPINDLE_MIN_FORWARD, SPINDLE, "MIN_FORWARD_VELOCITY", RPM, 0, UNBOUNDED, 0)                            \
    X(SPINDLE_MAX_REVERSE, SPINDLE, "MAX_REVERSE_VELOCITY", RPM, 0, UNBOUNDED, UNBOUNDED)                    \
    X(SPINDLE_MIN_REVERSE, SPINDLE, "MIN_REVERSE_VELOCITY", RPM, 0, UNBOUNDED, 0)

enum class Parameter : std::uint16_t {
#define MW_X(name, scope, key, unit, low, high, preset) name,
    MW_MOTION_PARAMETERS(MW_X)
#undef MW_X
        COUNT
};

struct ParameterInfo {
    Parameter parameter;
    std::string_view name;
    ParameterScope scope;
    std::string_view ini_key;
    ParameterUnit unit;
    double lowest, highest, preset;
};

inline constexpr std::array PARAMETERS = {
#define MW_X(name, scope, key, unit, low, high, preset)                                                      \
    ParameterInfo{Parameter::name, #name, ParameterScope::scope, key, ParameterUnit::unit, low, high, preset},
    MW_MOTION_PARAMETERS(MW_X)
#undef MW_X
};

}  // namespace mw::motion
